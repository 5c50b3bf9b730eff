"""Messages stay short, whatever is in a file."""

import numpy as np
import pytest

from drystone.errors import DrystoneError
from drystone.io.file_errors import listed, short
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones

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
