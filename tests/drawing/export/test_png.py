"""wall-numbered.png."""

import numpy as np
import pytest
from PIL import Image

from drystone.drawing.canvas import draw
from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.wall import drawing_of_assembly
from tests.drawing.export.drawn_walls import assembly


def test_the_picture_has_the_shape_of_the_wall(tmp_path) -> None:
    wall = assembly(columns=6)
    (path,) = FORMATS["png"].write(wall, tmp_path, ExportSettings())
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    stone = np.abs(pixels - np.array([0xCF, 0xC8, 0xBB])).max(axis=2) == 0
    rows, columns = np.nonzero(stone)
    assert abs(np.ptp(columns) / np.ptp(rows) - 6.0) < 0.1


def test_every_step_is_written() -> None:
    wall = assembly(columns=5, rows=3)
    ax = draw(drawing_of_assembly(wall, "A wall"))
    assert sorted(int(text.get_text()) for text in ax.texts) == list(range(1, 17))
    assert ax.get_xlabel() == "m"
    assert draw(drawing_of_assembly(assembly(px_per_m=None))).get_xlabel() == "px"


def test_numbers_of_wedges_are_above_the_ground() -> None:
    ax = draw(drawing_of_assembly(assembly(columns=5, rows=3)))
    wedge = next(text for text in ax.texts if text.get_text() == "2")
    box = wedge.get_window_extent().transformed(ax.transData.inverted())
    assert box.y0 > 0.0


def test_a_long_title_makes_no_wide_picture(tmp_path) -> None:
    wall, sizes = assembly(columns=6), []
    for title in ("A wall", 300 * "W", "$x_1"):
        (path,) = FORMATS["png"].write(wall, tmp_path, ExportSettings(title=title))
        with Image.open(path) as image:
            sizes.append(image.size)
    assert sizes[1] == pytest.approx(sizes[0], rel=0.02)
