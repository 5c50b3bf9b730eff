"""What stands beside the label image of a photograph gives it a scale."""

import numpy as np
import pytest
from PIL import Image

from drystone.errors import InputError
from drystone.io.photo_beside import PhotoSidecar, write_sidecar
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.pictures import areas, two_stones


def segmented(folder, width=60, height=40, px_per_m=250.0):
    Image.fromarray(two_stones(7, 300, np.uint16)).save(folder / "stones.png")
    Image.new("RGB", (60, 40)).save(folder / "photo.jpg")
    Image.new("RGB", (60, 40)).save(folder / "preview.png")
    write_sidecar(PhotoSidecar(width, height, px_per_m, "photo.jpg"), folder)
    return folder


@pytest.mark.parametrize("name", [".", "stones.png"])
def test_scale_of_a_photograph(tmp_path, name):
    stones = read_stones(segmented(tmp_path) / name)
    assert areas(stones) == {7: 375, 300: 600}
    assert stones.source.px_per_m == 250.0
    assert stones.source.path == "stones.png"
    assert stones.source.files == ()


def test_a_resolution_does_not_change_a_picture(tmp_path):
    settings = ReadSettings(px_per_m=99.0)
    stones = read_stones(segmented(tmp_path), settings=settings)
    assert stones.source.px_per_m == 250.0
    assert stones.source.reading == ()


def test_another_picture_than_the_one_that_was_measured(tmp_path):
    segmented(tmp_path, width=600, height=400)
    with pytest.raises(InputError, match=r"E117 .*60 x 40 px.*600 x 400.*drystone segment"):
        read_stones(tmp_path)


def test_other_names_and_other_files_have_no_scale(tmp_path):
    segmented(tmp_path)
    (tmp_path / "stones.png").rename(tmp_path / "other.png")
    assert read_stones(tmp_path / "other.png").source.px_per_m is None
