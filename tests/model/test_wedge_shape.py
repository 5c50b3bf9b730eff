"""What a wedge must be that a mason would cut: measured, and against slow twins."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.polygons import no_polygons
from drystone.model.wedge_shape import WedgeRule, WedgeSettings, WedgeShape, open_sides
from tests.naive.wedge_shape import covered, measures
from tests.polygons import box, simple_polygons
from tests.settle.piles import moved
from tests.strategies import repeatable

RULE = WedgeRule(least_thickness=2.0, greatest_height=10.0, greatest_area=90.0)


def quad(left, right, width=10.0):
    """Low and high at the left end, and at the right end."""
    return np.array([[0.0, left[0]], [width, right[0]], [width, right[1]], [0.0, left[1]]])


def roof(top):
    return np.array([[0, 0], [10, 0], [10, 3], [5, top], [0, 3]], float)


def faults(corners, rule=RULE):
    return list(rule.faults(WedgeShape.of(corners)))


@pytest.mark.parametrize(("corners", "fault"), [
    (quad((0, 2), (0, 2.1)), ""),
    (quad((0, 1.9), (0, 5)), "1.9 thick, at least 2"),
    (quad((0, 2), (0, 2), 6.0), ""),
    (quad((0, 2), (0, 2), 5.9), "5.9 wide, at least 6"),
    (quad((0, 6), (0, 6), 6.0), ""),
    (quad((0, 6.3), (0, 6.3), 6.0), "1.05 times as high as wide, at most 1"),
    (quad((0, 10), (0, 4), 12.0), ""),
    (quad((0, 10.1), (0, 4), 12.0), "10.1 high, at most 10"),
    (quad((0, 2), (0, 2.2), 10.4), ""),
    (quad((0, 2), (0, 2), 10.4), "5.2 times as wide as thick, at most 5"),
    (quad((0, 8), (0, 8), 11.2), ""),
    (quad((0, 8), (0, 8), 11.3), "90.4 in area, at most 90"),
    (quad((0, 2), (5.7, 7.7)), ""),
    (quad((0, 2), (5.9, 7.9)), "; ".join(["30.5° steep above, at most 30.1°"] * 2)),
    (quad((0, 2), (0, 7.7)), ""),
    (quad((1, 3), (0, 8)), "32.3° between its faces, at most 30.1°"),
    (roof(4.0), ""),
    (roof(4.2), "0.12 of its width bent, at most 0.1"),
])  # fmt: skip
def test_each_limit_is_named_when_it_is_missed(corners, fault):
    for mirrored in (corners, (corners * [-1.0, 1.0])[::-1], (corners * [1.0, -1.0])[::-1]):
        named = "; ".join(faults(mirrored))
        assert named.replace("above", "below") == fault.replace("above", "below")
        assert RULE.allows(WedgeShape.of(mirrored)) == (fault == "")


def test_limits_by_the_stones_the_scale_and_friction():
    sizes = WedgeSettings(thickness=0.05, thickness_mm=6.0, height=0.25, area=0.1)
    rule = WedgeRule.of(sizes, 0.6, 200.0)
    assert (rule.least_thickness, rule.greatest_height) == (10.0, 50.0)
    assert (rule.greatest_area, rule.mu) == (4000.0, 0.6)
    # 500 px are a metre; in metres; and stones so small that no wedge can be cut for them.
    assert WedgeRule.of(sizes, 0.6, 200.0, 500.0).least_thickness == pytest.approx(3.0)
    assert WedgeRule.of(sizes, 0.6, 0.4, 1.0).least_thickness == pytest.approx(0.006)
    slope = math.tan(math.radians(20.0))
    leaning = quad((0, 4), (10 * slope, 4 + 10 * slope))
    for mu, fine in ((0.37, True), (0.36, False)):
        by_friction = WedgeRule(least_thickness=2.0, greatest_height=10.0, mu=mu)
        assert (not faults(leaning, by_friction)) == fine
    tiny = WedgeRule.of(sizes, 0.6, 20.0, 1000.0)
    assert tiny.greatest_height == tiny.least_thickness == pytest.approx(6.0)


@repeatable(40)
@given(simple_polygons())
def test_measures_are_those_of_many_upright_lines(corners):
    found, twin = WedgeShape.of(corners), measures(corners)
    size = float(np.ptp(corners))
    for name in ("width", "height", "area"):
        assert getattr(found, name) == pytest.approx(twin[name], rel=1e-9)
    assert found.thickness == pytest.approx(twin["thickness"], abs=1e-5 * (1.0 + size))
    for name in ("bed", "top"):
        assert getattr(found, name) == pytest.approx(twin[name], abs=1e-4 * (1.0 + size))
    assert found.bend == pytest.approx(twin["bend"], abs=1e-4 * (1.0 + size))


def test_beside_a_wedge_is_what_fills_half_of_its_rows_up_to_the_end():
    wedge = quad((0, 4), (0, 4))

    def opened(*boxes):
        return open_sides(wedge, no_polygons().added([wedge, *(box(*sides) for sides in boxes)]))

    assert opened() == (True, True)
    assert opened((11, -5, 12, 2)) == (True, False)
    assert opened((11, -5, 12, 1.99)) == (True, True)
    assert opened((-9, 2, -8, 9)) == (False, True)
    # Two that meet in the same rows count once; below, above and before its end is not beside it.
    assert opened((11, -5, 12, 1.5), (20, 1, 22, 1.9)) == (True, True)
    assert opened((-20, -5, 20, 0), (-20, 4, 20, 9), (3, 1, 10, 3)) == (True, True)


@repeatable(40)
@given(st.lists(simple_polygons(max_size=25.0), min_size=1, max_size=4), st.data())
def test_open_sides_are_those_of_many_level_rays(polygons, data):
    shift = st.floats(-30.0, 30.0)
    others = [moved(p, data.draw(shift), data.draw(st.floats(-15.0, 15.0))) for p in polygons]
    wedge = quad((0, 4), (1, 6))
    found = open_sides(wedge, no_polygons().added(others))
    for side, share in zip(found, covered(wedge, others), strict=True):
        if abs(share - 0.5) > 0.02:
            assert side == (share < 0.5)
