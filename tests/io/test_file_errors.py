"""Messages stay short whatever is in a file, and names of files are whatever a system takes."""

import os
import sys

import numpy as np
import pytest
from PIL import Image

from drystone.errors import DrystoneError
from drystone.io.files import listed, short
from drystone.io.photo_file import read_photo
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones
from tests.io.pictures import codes, save_mask, two_stones

LONG = "x" * 100_000


def test_a_list_has_an_end():
    assert listed("abc") == "a, b, c"
    assert listed("abcd", "; ", 2) == "a; b; and 2 more"
    assert len(listed([LONG] * 9)) < 5000
    assert short("wall") == "wall"
    assert len(short(LONG)) < 200


def specks(step):
    """Stones, and hundreds of specks that have an id each."""
    labels = np.zeros((200, 200), np.uint32)
    labels[2:90, 2:90], labels[2:90, 100:190] = 1, 2
    few = labels[100::4, 2::step]
    few[:] = 3 + np.arange(few.size).reshape(few.shape)
    return labels


@pytest.mark.parametrize("pieces", ["auto", "split", "keep-largest"])
def test_notices_on_thousands_of_bits_are_short(pieces):
    holes = np.zeros((200, 200), np.uint32)
    for number, (row, col) in enumerate(np.ndindex(10, 10), start=1):
        box = holes[20 * row : 20 * row + 16, 20 * col : 20 * col + 16]
        box[:] = number
        box[1:15:2, 1:15:2] = 0
    bits = specks(4)
    bits[bits > 2] = 2
    settings = ReadSettings(pieces="keep-largest" if pieces == "auto" else pieces)
    found = [read_stones(specks(4)), read_stones(holes), read_stones(bits, settings=settings)]
    said = [notice for stones in found for notice in stones.notices]
    assert {"W111", "W112", "W113"} & {notice.code for notice in said} >= {"W112", "W113"}
    assert max(len(str(notice)) for notice in said) < 6000


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("stones.json", f'{{"schema": "drystone-photo/1", "px_per_m": "{LONG}"}}'.encode()),
        ("a.json", f'{{"{LONG}": 1, "b{LONG}": 2}}'.encode()),
        ("a.json", f'{{"type": "FeatureCollection", "features": [], "unit": "{LONG}"}}'.encode()),
        ("a.json", f'{{"images": [{{"id": 1, "file_name": "{LONG}"}}], "annotations": '
                   f'[{{"image_id": 1}}, {{"image_id": 2}}]}}'.encode()),
        ("a.obj", f"v 0 0 0\nv 9 0 0\nv 9 0 9\no {LONG}\nf 1 2 {LONG}\n".encode()),
    ],
)  # fmt: skip
def test_what_a_file_says_is_repeated_in_short(tmp_path, name, data):
    (tmp_path / "stones.png").write_bytes(b"labels")
    (tmp_path / name).write_bytes(data)
    with pytest.raises(DrystoneError) as told:
        read_stones(tmp_path / ("stones.png" if name == "stones.json" else name))
    assert 20 < len(str(told.value)) < 1000


def strange(folder, name):
    """A path in the folder whose name is no UTF-8."""
    if sys.platform in {"win32", "darwin"}:
        pytest.skip("names of files are Unicode there")
    return folder / os.fsdecode(name)


def test_names_that_are_no_utf8_can_be_written_down(tmp_path):
    folder = strange(tmp_path, b"\xdcbung")
    folder.mkdir()
    strange(folder, b"\xdcbersicht.txt").write_text("by hand")
    save_mask(strange(folder, b"voll-\xfc.png"), np.ones((30, 30)))
    save_mask(strange(folder, b"leer-\xfc.png"), np.zeros((30, 30)))
    save_mask(folder / "1.png", np.pad(np.ones((9, 9)), 3))
    stones = read_stones(folder)
    assert codes(stones)[0] == "W117"
    assert "W118" in codes(stones)
    said = [str(notice) for notice in stones.notices]
    assert "?bersicht.txt" in said[0]
    assert any("leer-?.png" in one for one in said[1:])
    for text in (*said, stones.source.path, *stones.source.files):
        text.encode("utf-8")


def test_a_single_file_of_such_a_name(tmp_path):
    path = strange(tmp_path, b"m\xfcr.png")
    Image.fromarray(two_stones().astype(np.uint16)).save(path)
    assert read_stones(path).source.path == "m?r.png"
    photo = strange(tmp_path, b"m\xfcr.jpg")
    exif = Image.Exif()
    exif[0x0112] = 3
    Image.fromarray(np.zeros((9, 9, 3), np.uint8)).save(photo, exif=exif)
    read = read_photo(photo)
    assert read.name == "m?r.jpg"
    assert "m?r.jpg was turned" in str(read.notices[0])


def test_digits_of_other_scripts_are_ordered_as_letters(tmp_path):
    for name in ("1٣2.png", "1a2.png", "10.png", "2²3.png"):
        save_mask(tmp_path / name, np.pad(np.ones((9, 9)), 3))
    assert read_stones(tmp_path).source.files == ("1a2.png", "1٣2.png", "2²3.png", "10.png")
