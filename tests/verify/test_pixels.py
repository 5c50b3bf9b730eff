"""Outlines in plans are those of the pixels, whatever made them; holes change nothing."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model import stone as stone_module
from drystone.model.outline import stone_outline
from drystone.model.stone import Stone
from drystone.search.plan_wall import plan_wall
from drystone.settle.rest import placed_outline
from drystone.verify.check import check_plan
from drystone.verify.pieces import check_outline, rim_px
from tests.naive import outline as naive
from tests.planner.scenes import greedy, stones_of_masks
from tests.strategies import blobs, holed, masks, repeatable
from tests.verify.exact_examples import exact_example
from tests.verify.examples import SLAB
from tests.verify.tampering import codes, step_of

STEP = step_of(exact_example().plan, SLAB)


def problems(mask, outline, angle_deg=0.0):
    """What is said of an outline of some pixels, about their centroid, at some place."""
    at = np.array([31.5, 12.25])
    step = replace(STEP, angle_deg=angle_deg)
    corners = placed_outline(outline, angle_deg, *at.tolist())
    return [p.message for p in check_outline(step, Stone(SLAB, mask), at, corners, 0.35)]


@repeatable(60)
@given(mask=masks(max_px=9))
def test_the_rim_is_around_the_pixels(mask):
    slow = {(point.x, point.y) for point in naive.rim(mask)}
    found = [tuple(point) for point in rim_px(naive.filled(mask)).tolist()]
    assert len(found) == len(set(found))
    assert set(found) == slow


@repeatable(60)
@given(mask=holed(), angle_deg=st.floats(-180, 180))
def test_outlines_of_stones_are_those_of_their_pixels(mask, angle_deg):
    assert problems(mask, Stone(1, mask).outline, angle_deg) == []


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


@pytest.mark.parametrize("shift", [(0.9, 0.0), (-0.9, 0.0), (0.0, 0.9), (0.0, -0.9)])
def test_an_outline_beside_its_pixels_or_of_another_shape_is_named(shift):
    brick, slim = np.ones((12, 20), bool), np.ones((10, 24), bool)
    (said,) = problems(brick, Stone(1, brick).outline + shift)
    assert "is 0.9 source px from the rim that was read; 0.5 are allowed" in said
    assert problems(brick, Stone(1, brick).outline + 0.5 * np.array(shift)) == []
    assert len(problems(slim, Stone(1, brick).outline)) == 1  # of the same area


@pytest.mark.parametrize(("factor", "named"), [(1.0, False), (0.97, True), (1.03, True)])
def test_check_does_not_take_the_word_of_whoever_reads_outlines(monkeypatch, factor, named):
    monkeypatch.setattr(stone_module, "stone_outline", lambda *of: factor * stone_outline(*of))
    made = exact_example.__wrapped__()  # anew, not the one that is kept
    report = check_plan(made.plan, made.stones)
    assert ("E240" in codes(report)) is named


def ring(outer, inner):
    y, x = np.mgrid[: 2 * int(outer) + 1, : 2 * int(outer) + 1] - outer
    return (np.hypot(x, y) <= outer) & (np.hypot(x, y) >= inner)


def planned(stones, width, height):
    careless = greedy({"settle": {"trials": 0}})  # discs roll
    return plan_wall(stones, width, height, seed=1, settings=careless, scale=1.0)


def test_frames_are_laid_as_if_they_were_filled():
    frame = np.ones((40, 40), bool)
    frame[10:30, 10:30] = False
    kept = planned(stones_of_masks(dict.fromkeys(range(1, 5), frame)), 160, 40)
    whole = planned(stones_of_masks({i: np.ones((40, 40), bool) for i in range(1, 5)}), 160, 40)
    assert len(kept.plan.steps) == 4
    np.testing.assert_array_equal(
        kept.wall.exact.polygons.corners, whole.wall.exact.polygons.corners
    )
    mine, filled = kept.metrics, whole.metrics
    assert mine.F_SF == pytest.approx(0.75 * filled.F_SF)
    assert (mine.alpha_left, mine.F_LR) == (filled.alpha_left, filled.F_LR)


def test_rings_among_discs_and_bricks_do_not_overlap():
    shapes = [ring(22, 9)] * 5 + [ring(6.9, 0)] * 5 + [np.ones((20, 35), bool)] * 5
    stones = stones_of_masks(dict(enumerate(shapes, 1)))
    result = planned(stones, 180, 90)
    placed = {step.stone for step in result.plan.stone_steps}
    assert len(placed) >= 9
    assert placed & {1, 2, 3, 4, 5}
    report = check_plan(result.plan, stones, wall_labels=result.wall.labels)
    assert report.problems == ()
    assert report.overlap_depth < 0.05
    assert report.area_error < 0.05
