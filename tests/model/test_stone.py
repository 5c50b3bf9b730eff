"""A stone as found: area, centroid, hull, outline, eccentricity (DESIGN 4.1)."""

import numpy as np
import pytest
import shapely
from hypothesis import given

from drystone.errors import InputError, PlanError
from drystone.model.stone import Source, Stone, StoneSet
from tests.naive import raster as naive
from tests.strategies import masks, repeatable


@repeatable()
@given(mask=masks())
def test_what_is_measured_is_that_of_the_pixel_squares(mask):
    stone = Stone(3, mask, left_px=10, bottom_px=20)
    polygon = naive.polygon_of(mask)
    assert stone.area_px == polygon.area
    assert stone.local_centroid == pytest.approx((polygon.centroid.x, polygon.centroid.y))
    assert stone.centroid == pytest.approx((10 + polygon.centroid.x, 20 + polygon.centroid.y))
    hull = shapely.Polygon(stone.hull + stone.local_centroid)
    assert hull.symmetric_difference(polygon.convex_hull).area < 1e-9
    assert stone.eccentricity == pytest.approx(naive.second_moment_eccentricity(mask), abs=0.02)


def test_a_stone_has_a_positive_id_and_pixels_of_its_own():
    pixels = np.ones((9, 9), bool)
    stone = Stone(70_000, pixels)
    pixels[0, 0] = False
    assert (stone.area_px, stone.eccentricity) == (81, 0.0)
    with pytest.raises(ValueError, match="read-only"):
        stone.mask[0, 0] = False
    for wrong in (0, -1, 2**32, 2**40):
        with pytest.raises(InputError, match=f"E183 stone {wrong}: the id .* 1 to 4294967295"):
            Stone(wrong, np.ones((1, 1), bool))
    with pytest.raises(TypeError):
        Stone(1.5, np.ones((1, 1), bool))
    # No id of NumPy wraps where others are numbered after it.
    assert Stone(np.uint8(255), np.ones((1, 1), bool)).id + 1 == 256
    pair = np.array([[1, 0, 1]])
    for mask, said in (
        *((np.zeros(shape, bool), "at least one pixel") for shape in ((2, 2), (0, 3), (4,))),
        *((np.rot90([[0, 1], [0, 1]], turn), "cropped") for turn in range(4)),
        (pair, "one connected piece"),
        (np.pad(np.pad([[1]], 1), 1, constant_values=1), "one connected piece"),
    ):
        with pytest.raises(InputError, match=f"E183 stone 1: the mask must be .*{said}"):
            Stone(1, mask)
    for mask in (np.ones((2, 2)), np.full((2, 2), np.nan), np.full((2, 2), "1")):
        with pytest.raises(TypeError, match="mask must be an array of bool, not of "):
            Stone(1, mask)
    # What is masked is no stone, whatever stands there.  Corners join, as in pictures.
    assert Stone(1, np.ma.masked_equal(np.tri(3, dtype=int) + 1, 1)).area_px == 6
    assert Stone(1, np.eye(2, dtype=np.uint8)).area_px == 2
    assert Stone(1, np.ones((30, 60), bool)).eccentricity == pytest.approx((1 - 0.25) ** 0.5)


def test_a_drawn_outline_is_simple_counter_clockwise_and_of_the_mask():
    mask, box = np.ones((20, 40), bool), np.array([[0, 0], [40, 0], [40, 20], [0, 20]])
    stone = Stone(1, mask, drawn=box)
    box[:] = 0  # it has its own
    assert (stone.drawn.max(axis=0).tolist(), stone.drawn.flags.writeable) == ([40.0, 20.0], False)
    box = stone.drawn
    needle = np.insert(box, 2, [[40, 9.9], [400, 10], [40, 10.1]], axis=0)
    for other in (box + 0.9, box * 0.98, [*box, box[0]], needle):
        assert Stone(1, mask, drawn=other).outline.shape[1] == 2
    for wrong in (
        box[::-1], box[[0, 2, 1, 3]], box + 100, box - 2, box * 0.5, box * 2, box[:3],
        np.insert(box, 2, [[40, 12], [39, 10], [41, 10]], axis=0),  # a small loop
        box[:2], box[:0], box[0], box + np.nan, box + np.inf, np.pad(box, ((0, 0), (0, 1))),
    ):  # fmt: skip
        with pytest.raises(InputError, match="E183 stone 1: the drawn outline must be simple"):
            Stone(1, mask, drawn=wrong)
    with pytest.raises(TypeError, match="drawn must be an array of float, not of complex"):
        Stone(1, mask, drawn=box * 1j)


def test_a_set_is_ordered_and_knows_its_stones_and_their_names():
    pixel = np.ones((1, 1), bool)
    stones = StoneSet((Stone(300, pixel), Stone(7, pixel)), Source("a.png"))
    assert [stone.id for stone in stones] == [7, 300]
    assert stones.by_id(300).id == 300
    assert (len(stones), stones.total_area_px) == (2, 2)
    with pytest.raises(PlanError, match=r"E201 a\.png: there is no stone 8 .*Give the stones"):
        stones.by_id(8)
    with pytest.raises(ValueError, match="same id"):
        StoneSet((Stone(7, pixel), Stone(7, pixel)))
    # Names that are no UTF-8 can be written.
    name = b"st\xf6nes.png".decode("utf-8", "surrogateescape")
    source = Source(name, files=(name, "b.png"))
    assert (source.path, source.files) == ("st?nes.png", ("st?nes.png", "b.png"))
    assert Stone(1, np.ones((2, 2), bool), name=name).name == "st?nes.png"
