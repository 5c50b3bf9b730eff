"""Pictures for a projector, measured with NumPy on what Pillow reads."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from drystone.drawing.export import frames
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.errors import UsageError
from tests.drawing.export.drawn_walls import assembly, runs

SETTINGS = ExportSettings(projector_px=(800, 600), projector_px_per_m=500.0)
"""The wall is .9 m x .3 m: 450 px x 150 px."""

LINE_PX = 4


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A wall and its pictures."""
    wall, folder = assembly(), tmp_path_factory.mktemp("projector")
    return wall, [picture(path) for path in FORMATS["projector"].write(wall, folder, SETTINGS)]


def picture(path):
    with Image.open(path) as image:
        return np.asarray(image).astype(int)


def bright_box(image):
    """Return the box of the brightest px above the strip of words, y up from the lower edge."""
    rows, columns = np.nonzero(image[: 600 - 70] == 255)
    return columns.min(), 599 - rows.max(), columns.max(), 599 - rows.min()


def test_every_step_has_a_picture_of_the_projectors_size(scene) -> None:
    wall, images = scene
    assert next(iter(FORMATS["projector"].files(wall, SETTINGS))) == "projector/step_000.png"
    assert len(images) == len(wall.parts) + 1
    for image in images:
        assert image.shape == (600, 800)
        assert (image == 0).mean() > 0.9


def test_the_stone_to_be_placed_is_drawn_one_to_one(scene) -> None:
    wall, images = scene
    left, bottom = (800 - 450) / 2, 84
    for part, image in zip(wall.parts, images[1:], strict=True):
        low, high = part.corners.min(axis=0) * 500, part.corners.max(axis=0) * 500
        expected = (left + low[0], bottom + low[1], left + high[0], bottom + high[1])
        assert bright_box(image) == pytest.approx(expected, abs=LINE_PX / 2 + 1)


def test_what_stands_is_dim_and_what_is_to_come_dark(scene) -> None:
    wall, images = scene
    stone = wall.parts[2]
    # Its lower edge lies on the ground, which is drawn always; its right edge does not.
    x, y = (stone.corners[1] + stone.corners[2]) / 2 * 500
    row, column = round(600 - 84 - y), round(175 + x)
    around = [int(image[row, column - 2 : column + 3].max()) for image in images]
    assert around[:3] == [0, 0, 0]
    assert around[3] == 255
    assert around[5:] == [frames.DIM] * 3


def test_the_bar_is_as_long_as_it_says(scene) -> None:
    strip = scene[1][1][600 - 30 :, 400:]
    longest = max(int(run) for row in strip for run in runs(row > 0))
    assert longest == pytest.approx(0.1 * 500, abs=2)


def test_the_wall_begins_where_it_is_told_to(tmp_path) -> None:
    settings = replace(SETTINGS, projector_offset_px=(20, 200))
    wall = assembly()
    image = picture(FORMATS["projector"].write(wall, tmp_path, settings)[1])
    part = wall.parts[0]
    x0, y0, *_ = bright_box(image)
    assert (x0, y0) == pytest.approx((20 + part.corners[:, 0].min() * 500, 200), abs=3)


@pytest.mark.parametrize("settings", [
    replace(SETTINGS, projector_px_per_m=900.0),
    replace(SETTINGS, projector_offset_px=(400, 84)),
])  # fmt: skip
def test_a_wall_that_is_not_in_the_picture_is_refused_with_the_cure(tmp_path, settings) -> None:
    with pytest.raises(UsageError) as caught:
        FORMATS["projector"].write(assembly(), tmp_path, settings)
    assert caught.value.code == "E187"
    assert list(tmp_path.iterdir()) == []


def test_the_cure_is_one(tmp_path) -> None:
    settings = replace(SETTINGS, projector_px_per_m=2000.0)
    with pytest.raises(UsageError) as caught:
        FORMATS["projector"].write(assembly(), tmp_path, settings)
    found = float(caught.value.cure.split("@")[1].split()[0])
    FORMATS["projector"].write(assembly(), tmp_path, replace(settings, projector_px_per_m=found))
    with pytest.raises(UsageError):
        FORMATS["projector"].write(
            assembly(), tmp_path, replace(settings, projector_px_per_m=found + 1)
        )
