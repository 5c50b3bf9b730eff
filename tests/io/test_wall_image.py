import numpy as np
import pytest
import tifffile
from PIL import Image

from drystone.errors import DrystoneError, PlanError
from drystone.io.wall_image import read_wall_image, write_wall_image


def wall(*ids):
    """A course of touching stones under empty rows, one of them in two pieces."""
    labels = np.zeros((12, 10 * len(ids)), np.uint32)
    for index, value in enumerate(ids):
        labels[4:, 10 * index : 10 * index + 10] = value
    labels[2, 0] = ids[-1]
    return labels


HOLED = wall(3, 300)
HOLED[8, 4], HOLED[0, 9] = 0, 77
"""A hole, and a speck."""


@pytest.mark.parametrize(
    ("labels", "name"),
    [
        (wall(1, 2), "wall.png"),
        (wall(300, 65535), "wall.png"),
        (wall(70000, 2), "wall.tif"),
        (wall(2**32 - 1, 2**24 + 1), "wall.tif"),
        (HOLED, "wall.png"),
        (np.full((40, 20), 7, np.uint32), "wall.png"),
    ],
)
def test_nothing_is_dropped_split_or_filled(tmp_path, labels, name):
    path = write_wall_image(labels, tmp_path)
    assert path == tmp_path / name
    found = read_wall_image(path)
    assert found.dtype == np.uint32
    np.testing.assert_array_equal(found, labels)
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_folder_that_is_not_there_is_named(tmp_path):
    with pytest.raises(PlanError, match="E206"):
        write_wall_image(wall(1, 2), tmp_path / "none")


def test_other_background_becomes_zero(tmp_path):
    labels = wall(3, 300)
    labels[labels == 0] = 999
    path = write_wall_image(labels, tmp_path)
    np.testing.assert_array_equal(read_wall_image(path, background=999), wall(3, 300))
    labels[5, 5] = 0
    with pytest.raises(DrystoneError, match="E108"):
        read_wall_image(write_wall_image(labels, tmp_path), background=999)


def test_files_that_are_no_walls_are_refused_with_a_code(tmp_path):
    rng = np.random.default_rng(1)
    photo = rng.integers(0, 255, (60, 80, 3)).astype(np.uint8)
    Image.fromarray(photo).save(tmp_path / "photo.png")
    assert write_wall_image(np.zeros((9, 9), np.uint32), tmp_path) == tmp_path / "wall.png"
    framed = np.pad(wall(3, 9), 6, constant_values=255)
    framed[framed == 0] = 255
    Image.fromarray(framed.astype(np.uint8)).save(tmp_path / "white.png")
    np.save(tmp_path / "halves.npy", wall(1, 2) / 2)
    tifffile.imwrite(tmp_path / "pages.tif", np.stack([wall(1, 2)] * 3), photometric="minisblack")
    for name, code in {
        "none.png": "E100", "photo.png": "E102", "wall.png": "E104", "white.png": "E105",
        "halves.npy": "E108", "pages.tif": "E109", ".": "E100",
    }.items():  # fmt: skip
        with pytest.raises(DrystoneError, match=code):
            read_wall_image(tmp_path / name)
    with pytest.raises(DrystoneError, match="E110"):
        read_wall_image(tmp_path / "photo.png", max_image_mpx=0.001)
