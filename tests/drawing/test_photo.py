"""Pieces of a photograph."""

import numpy as np
import pytest
from PIL import Image

from drystone.drawing.photo import CROP_PX, StonePhoto, read_photo
from tests.drawing.export.drawn_walls import assembly


def coordinates(width, height):
    """Return a picture whose red is its column and whose green is its row from the top."""
    red, green = np.meshgrid(np.linspace(0, 255, width), np.linspace(0, 255, height))
    return Image.fromarray(np.dstack([red, green, 0 * red]).astype(np.uint8))


@pytest.mark.parametrize("zoom", [0.5, 1, 4, 20])
def test_a_piece_shows_its_box_at_any_resolution(zoom) -> None:
    photo = StonePhoto(coordinates(round(200 * zoom), round(100 * zoom)), 200.0, 100.0)
    piece = photo.crop((50.0, 20.0, 110.0, 60.0)).astype(float)
    height, width, _ = piece.shape
    assert max(height, width) <= CROP_PX
    assert width / height == pytest.approx(1.5, abs=0.05)
    # Source px of the middles of the first and last px of the piece.
    step = 60.0 / width
    left, right = 50 + step / 2, 110 - step / 2
    top, bottom = 40 + step / 2, 80 - step / 2
    assert piece[height // 2, 0, 0] / 255 * 200 == pytest.approx(left, abs=1.8)
    assert piece[height // 2, -1, 0] / 255 * 200 == pytest.approx(right, abs=1.8)
    assert piece[0, width // 2, 1] / 255 * 100 == pytest.approx(top, abs=1.8)
    assert piece[-1, width // 2, 1] / 255 * 100 == pytest.approx(bottom, abs=1.8)


def test_beyond_the_photograph_it_is_white() -> None:
    photo = StonePhoto(Image.new("RGB", (100, 100), "black"), 100.0, 100.0)
    piece = photo.crop((-20.0, 40.0, 20.0, 60.0))
    assert (piece[:, :18] == 255).all()
    assert (piece[:, 22:] == 0).all()


def test_there_may_be_none() -> None:
    assert read_photo(assembly()) is None
