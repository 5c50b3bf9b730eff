"""Names of files are anything that the system takes."""

import os
import sys

import numpy as np
import pytest
from PIL import Image

from drystone.io.photo_file import read_photo
from drystone.io.read_stones import read_stones
from tests.io.pictures import codes, two_stones

UNREADABLE = pytest.mark.skipif(
    sys.platform in {"win32", "darwin"}, reason="names of files are Unicode there"
)


def strange(folder, name):
    """A path in the folder whose name is no UTF-8."""
    return folder / os.fsdecode(name)


def save_mask(path, mask):
    Image.fromarray(np.asarray(mask, np.uint8) * np.uint8(255)).save(path)


@UNREADABLE
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


@UNREADABLE
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
