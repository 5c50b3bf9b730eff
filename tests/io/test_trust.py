"""Files of others: nothing foreign runs or hangs, failures have codes, and messages stay short."""

import json
import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from fuzz.pictures import held, pillow
from PIL import Image

import drystone
from drystone.errors import DrystoneError, InputError
from drystone.io.files import file_bytes, foreign, listed, short, silent_stderr
from drystone.io.images import decode
from drystone.io.json_text import DEEPEST, json_of
from drystone.io.photo_file import read_photo
from drystone.io.read_settings import ReadSettings
from drystone.io.read_stones import read_stones
from tests.io.hostile import FILES, SETTINGS
from tests.io.pictures import codes, save_mask, two_stones
from tests.io.test_formats import LIMIT


@pytest.mark.parametrize("name", list(FILES))
def test_files_that_are_read_or_refused(name, tmp_path, monkeypatch, capfd):
    ghostscript, called = tmp_path / "bin" / "gs", tmp_path / "called"
    ghostscript.parent.mkdir()
    ghostscript.write_text(f"#!/bin/sh\necho x > {called}\n")
    ghostscript.chmod(0o755)
    monkeypatch.setenv("PATH", str(ghostscript.parent), prepend=os.pathsep)
    make, error = FILES[name]
    path = tmp_path / name
    path.write_bytes(make())
    try:
        said = "" if read_stones(path, settings=SETTINGS.get(name)) else "no stones"
    except DrystoneError as caught:
        said = str(caught)
    assert re.match(error or "$", said), said
    assert len(said) < 700
    assert not called.exists()
    assert capfd.readouterr() == ("", "")


def test_a_pipe_is_not_waited_for_and_what_has_no_end_or_is_too_large_is_not_read(tmp_path):
    for name in ("pipe.png", "pipe.json", "pipe.svg"):
        os.mkfifo(tmp_path / name)
        with pytest.raises(InputError, match=r"E100 .*a pipe, and no regular file"):
            read_stones(tmp_path / name)
    with pytest.raises(InputError, match=r"E100 .*a device, and no regular file"):
        read_stones("/dev/zero")
    with (tmp_path / "large").open("wb") as file:
        file.truncate(3_000_000_000)  # no byte of it is on the disk
    with pytest.raises(InputError, match=r"E100 .*it has 3000 MB, and the limit is 2000 MB"):
        read_stones(tmp_path / "large")
    (tmp_path / "small").write_bytes(b"abc")
    assert file_bytes(tmp_path / "small", 3) == b"abc"


OWN, LONG = InputError("E110", "too large"), "x" * 100_000


def test_whatever_a_decoder_raises_has_a_code_unless_it_is_an_interrupt():
    for raised, text in (
        *((error, "E106 a: damaged") for error in (RecursionError(), ZeroDivisionError(LONG),
                                                   AttributeError("a"), SystemExit(), OSError())),
        (MemoryError(), "E110 a: there is not enough memory"),
        (OWN, "E110"),
        (KeyboardInterrupt(), None),
    ):  # fmt: skip
        kind = KeyboardInterrupt if isinstance(raised, KeyboardInterrupt) else InputError
        with (
            pytest.raises(kind, match=text) as caught,
            foreign(lambda why: InputError("E106", f"damaged ({why})", where="a")),
        ):
            raise raised
        assert len(str(caught.value)) < 300
        assert (caught.value is raised) == (raised is OWN or kind is KeyboardInterrupt)


def test_what_libraries_print_reaches_nobody(capfd):
    data = bytearray(pillow(two_stones(7, 9, np.uint8), "TIFF", compression="tiff_lzw"))
    data[8:60] = bytes(52)  # libtiff says so in C
    with pytest.raises(InputError, match="E10"):
        decode(bytes(data), LIMIT)
    with silent_stderr():
        os.write(2, b"noise")
    os.write(2, b"heard")
    assert capfd.readouterr() == ("", "heard")


def test_json_may_be_nested_as_deep_as_whoever_reads_it_may_recurse():
    assert json_of("[" * DEEPEST + "]" * DEEPEST) is not None
    with pytest.raises(ValueError, match="deeper than 100"):
        json_of("[" * (DEEPEST + 1) + "]" * (DEEPEST + 1))
    text = json.dumps(["[{" * DEEPEST + '\\"' + "[" * DEEPEST] * 2)
    assert json_of(text) == json.loads(text)  # brackets in strings do not count


def test_only_one_module_opens_pictures_and_none_follows_series():
    for path in Path(drystone.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        # The linter sees the names that it bans, and not what a file of tifffile is asked for.
        assert "Image.open(" not in text.replace("``Image.open``", ""), path
        assert "tifffile" not in text or ".series" not in text.replace("`.series`", ""), path


def test_a_list_has_an_end():
    assert listed("abc") == "a, b, c"
    assert listed("abcd", "; ", 2) == "a; b; and 2 more"
    assert len(listed([LONG] * 9)) < 5000
    assert short("wall") == "wall"
    assert len(short(LONG)) < 200


def test_notices_on_thousands_of_bits_are_short():
    specks, holes = np.zeros((2, 200, 200), np.uint32)
    specks[2:90, 2:90], specks[2:90, 100:190] = 1, 2
    few = specks[100::4, 2::4]
    few[:] = 3 + np.arange(few.size).reshape(few.shape)  # each with an id
    for number, (row, col) in enumerate(np.ndindex(10, 10), start=1):
        box = holes[20 * row : 20 * row + 16, 20 * col : 20 * col + 16]
        box[:] = number
        box[1:15:2, 1:15:2] = 0
    found = [read_stones(specks), read_stones(holes)]
    for pieces in ("split", "keep-largest"):
        found += [read_stones(np.minimum(specks, 2), settings=ReadSettings(pieces=pieces))]
    said = [notice for stones in found for notice in stones.notices]
    assert {"W112", "W113"} <= {notice.code for notice in said}
    assert max(len(str(notice)) for notice in said) < 6000


def test_what_a_file_says_is_repeated_in_short(tmp_path):
    for name, data in (
        ("stones.json", f'{{"schema": "drystone-photo/1", "px_per_m": "{LONG}"}}'.encode()),
        ("a.json", f'{{"{LONG}": 1, "b{LONG}": 2}}'.encode()),
        ("a.json", f'{{"type": "FeatureCollection", "features": [], "unit": "{LONG}"}}'.encode()),
        ("a.json", f'{{"images": [{{"id": 1, "file_name": "{LONG}"}}], "annotations": '
                   f'[{{"image_id": 1}}, {{"image_id": 2}}]}}'.encode()),
        ("a.obj", f"v 0 0 0\nv 9 0 0\nv 9 0 9\no {LONG}\nf 1 2 {LONG}\n".encode()),
    ):  # fmt: skip
        (tmp_path / "stones.png").write_bytes(b"labels")
        (tmp_path / name).write_bytes(data)
        with pytest.raises(DrystoneError) as told:
            read_stones(tmp_path / ("stones.png" if name == "stones.json" else name))
        assert 20 < len(str(told.value)) < 1000


@pytest.mark.skipif(sys.platform in {"win32", "darwin"}, reason="file names are Unicode there")
def test_names_that_are_no_utf8_can_be_written_down(tmp_path):
    def strange(folder, name):
        return folder / os.fsdecode(name)

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
    path = strange(tmp_path, b"m\xfcr.png")
    Image.fromarray(two_stones().astype(np.uint16)).save(path)
    assert read_stones(path).source.path == "m?r.png"
    photo = strange(tmp_path, b"m\xfcr.jpg")
    Image.fromarray(np.zeros((9, 9, 3), np.uint8)).save(photo, exif=held(3))
    read = read_photo(photo)
    assert read.name == "m?r.jpg"
    assert "m?r.jpg was turned" in str(read.notices[0])


def test_digits_of_other_scripts_are_ordered_as_letters(tmp_path):
    for name in ("1٣2.png", "1a2.png", "10.png", "2²3.png"):
        save_mask(tmp_path / name, np.pad(np.ones((9, 9)), 3))
    assert read_stones(tmp_path).source.files == ("1a2.png", "1٣2.png", "2²3.png", "10.png")
