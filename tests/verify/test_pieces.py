"""Wedges are what a mason would cut, and outlines those of the pixels, whatever made them."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.settled import model_of_outlines
from drystone.kernels.polygons import no_polygons
from drystone.model import stone as stone_module
from drystone.model.outline import stone_outline
from drystone.model.outlines import Outlines
from drystone.model.plan import WedgeStep
from drystone.model.site import Site
from drystone.model.stone import OUTLINE_TOLERANCE_PX, Stone
from drystone.search.plan_wall import plan_wall
from drystone.settle.rest import settled_at
from drystone.settle.wedge import WedgeLimits
from drystone.verify.check import check_plan
from drystone.verify.pieces import (
    check_outline,
    check_settled_wedge,
    lies_under,
    rim_px,
    swept_upwards,
)
from tests.naive import outline as naive
from tests.planner.scenes import greedy, stones_of_masks
from tests.polygons import box, simple_polygons
from tests.strategies import blobs, holed, masks, repeatable
from tests.verify.exact_examples import exact_example
from tests.verify.examples import SLAB as SLAB_ID
from tests.verify.tampering import codes, step_of

STEP = WedgeStep(3, 9, 7, (), None, None)
LIMITS = WedgeLimits(least_thickness=1.0, greatest_height=6.0, greatest_area=30.0)
SLAB = box(0, 8.01, 15, 10)


def found(wedge, *more, **limits):
    """What is said of a wedge that may hold a slab between a pillar and a lower one."""
    blocks = {1: box(0, 0.01, 5, 8), 2: box(10, 0.01, 15, 5), 7: SLAB, 9: wedge}
    model = model_of_outlines([*blocks.items(), *more], 0.58, 0.1)
    wall, limits = no_polygons().added([*blocks.values()]), replace(LIMITS, **limits)
    problems = [*check_settled_wedge(STEP, wedge, model, SLAB, wall, 20.0, limits)]
    assert all(problem.step == 3 for problem in problems)
    return [f"{problem.code} {problem.message}" for problem in problems]


def test_wedge_must_touch_its_stone_from_below_and_stand_on_something():
    assert found(box(11, 5.01, 14, 8.0)) == []
    assert found(box(11, 5.01, 14, 7.85)) == ["E223 wedge 9 does not touch stone 7 from below."]
    # It stands on the stone that it should hold, and at its side.
    (holds, stands) = found(box(5, 10.01, 8, 12.5))
    assert "does not touch" in holds
    assert "stands on nothing" in stands
    assert "does not touch" in found(box(15.05, 0, 18, 9))[0]
    assert found(box(11, 5.2, 14, 8.0)) == ["E223 wedge 9 stands on nothing."]
    on_ground = found(box(5.5, 0.01, 9.5, 8.0), greatest_height=9, greatest_area=99)
    assert [line[:4] for line in on_ground] == ["E224"]
    # It may stand on another that comes after it.
    upper, lower = box(11, 6.52, 14, 8.0), (10, box(11, 5.01, 14, 6.51))
    assert found(upper, lower) == []
    assert found(upper) == ["E223 wedge 9 stands on nothing."]


def test_wedge_is_one_that_a_mason_would_cut():
    """The limits themselves are tested beside the rule."""
    (line,) = found(box(11, 5.01, 13.9, 8.0), greatest_height=2.98)
    assert line == (
        "E224 no mason would cut wedge 9 (source px): 2.9 wide, at least 3; "
        "2.99 high, at most 2.98; 1.031 times as high as wide, at most 1."
    )
    # Rounding to the grid is no fault.
    assert found(box(11, 5.01, 13.999995, 7.999995)) == []
    # At the end of the wall it has something beside it.
    assert found(box(11, 5.01, 14, 8.0), room_px=5.0) == []
    (line,) = found(box(11, 5.01, 14, 8.0), room_px=5.1)
    assert line.endswith("(source px): nothing beside it at the end of the wall.")


def placed(*blocks):
    return Outlines.empty(Site(60, 40)).added(list(enumerate(blocks, 1)), 1.0)


@repeatable(30)
@given(simple_polygons(), st.integers(0, 2**31))
def test_sweep_is_everything_above_the_lowest_points(corners, seed):
    """The slow twin: a point is passed when the ray downwards from it meets the polygon."""
    swept, polygon = swept_upwards(corners, 40.0), shapely.Polygon(corners)
    left, low, right, high = polygon.bounds
    rng = np.random.default_rng(seed)
    for x, y in rng.uniform([left - 1, low - 1], [right + 1, high + 3], (60, 2)).tolist():
        ray = shapely.LineString([(x, y), (x, low - 2)])
        near = shapely.distance(swept.boundary, shapely.Point(x, y)) < 1e-6
        assert near or swept.contains(shapely.Point(x, y)) == ray.intersects(polygon)


def test_block_is_buried_by_what_is_wide_enough_above_it():
    for earlier, expected in (
        (box(2, 12, 8, 16), True),
        (box(2, -9, 8, -0.01), False),  # it stands on it
        (box(-5, -9, 15, 0.04), False),  # as deep in its bed as it may be
        (box(-5, -9, 15, 0.08), True),
        (box(-9, 0, -0.01, 16), False),  # beside it, and higher
        (box(-9, 12, 0.9, 16), False),  # a sliver above it
        (box(-9, 12, 1.1, 16), True),
        (box(9.1, 12, 19, 16), False),
        (box(8.9, 12, 19, 16), True),
        (np.array([[4.0, 20.0], [9.0, 21.0], [3.0, 25.0]]), True),
    ):
        block = box(0, 0, 10, 10)
        assert lies_under(block, placed(earlier), 1.0) is expected
        # Others that are in nobody's way change nothing.
        assert lies_under(block, placed(box(0, -5, 10, -0.01), earlier), 1.0) is expected


def test_hook_over_what_is_there_can_be_lowered_and_under_it_cannot():
    arch = np.array([[0, 0], [2, 0], [2, 6], [8, 6], [8, 0], [10, 0], [10, 8], [0, 8]], float)
    assert not lies_under(arch, placed(box(3, 0, 7, 5.9)), 0.5)
    clamp = np.array([[0, 0], [10, 0], [10, 2], [2, 2], [2, 6], [10, 6], [10, 8], [0, 8]], float)
    assert lies_under(clamp, placed(box(3, 2.1, 20, 5.9)), 0.5)
    assert not lies_under(clamp, placed(), 0.5)


def problems(mask, outline, angle_deg=0.0):
    """What is said of an outline of some pixels, about their centroid, at some place."""
    at = np.array([31.5, 12.25])
    step = replace(step_of(exact_example().plan, SLAB_ID), angle_deg=angle_deg)
    corners = settled_at(outline, angle_deg, *at.tolist()).corners
    found = check_outline(step, Stone(SLAB_ID, mask), at, corners, OUTLINE_TOLERANCE_PX)
    return [problem.message for problem in found]


@repeatable(60)
@given(mask=masks(max_px=9), holey=holed(), angle_deg=st.floats(-180, 180))
def test_the_rim_is_around_the_pixels_and_outlines_of_stones_are_near_it(mask, holey, angle_deg):
    slow = {(point.x, point.y) for point in naive.rim(mask)}
    found = [tuple(point) for point in rim_px(naive.filled(mask)).tolist()]
    assert len(found) == len(slow)
    assert set(found) == slow
    assert problems(holey, Stone(1, holey).outline, angle_deg) == []


@repeatable(40)
@given(
    mask=st.one_of(holed(), blobs(min_px=10, max_px=40)),
    angle_deg=st.floats(-180, 180),
    factor=st.sampled_from([0.5, 0.866, 0.98, 0.999, 1.001, 1.2]),
)
def test_a_scaled_outline_is_named(mask, angle_deg, factor):
    """Also one that stays within the tolerance of every pixel."""
    (*_, said) = problems(mask, Stone(1, mask).outline * factor, angle_deg)
    assert f"has {factor**2:.6g} times the area that was read" in said


def test_an_outline_beside_its_pixels_or_of_another_shape_is_named():
    brick, slim = np.ones((12, 20), bool), np.ones((10, 24), bool)
    outline = Stone(1, brick).outline
    for shift in ((1.2, 0.0), (-1.2, 0.0), (0.0, 1.2), (0.0, -1.2)):
        (said,) = problems(brick, outline + shift)
        assert "is 1.2 source px from the rim that was read; 0.9 are allowed" in said
        assert problems(brick, outline + 0.5 * np.array(shift)) == []
    assert len(problems(slim, outline)) == 1  # of the same area


def test_check_does_not_take_the_word_of_whoever_reads_outlines(monkeypatch):
    for factor, named in ((1.0, False), (0.97, True), (1.03, True)):
        scaled = lambda *of, k=factor: k * stone_outline(*of)  # noqa: E731
        monkeypatch.setattr(stone_module, "stone_outline", scaled)
        made = exact_example.__wrapped__()  # anew, not the one that is kept
        assert ("E240" in codes(check_plan(made.plan, made.stones))) is named


def test_frames_are_laid_as_if_they_were_filled():
    solid, frame = np.ones((40, 40), bool), np.ones((40, 40), bool)
    frame[10:30, 10:30] = False
    kept, whole = (
        plan_wall(stones_of_masks(dict.fromkeys(range(1, 5), mask)), 160, 40, settings=greedy())
        for mask in (frame, solid)
    )
    assert len(kept.plan.steps) == 4
    corners = (result.wall.exact.polygons.corners for result in (kept, whole))
    np.testing.assert_array_equal(*corners)
    mine, filled = kept.metrics, whole.metrics
    assert mine.F_SF == pytest.approx(0.75 * filled.F_SF)
    assert (mine.alpha_left, mine.F_LR) == (filled.alpha_left, filled.F_LR)
