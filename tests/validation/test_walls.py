"""Walls of Ferris and Tin-Loi (2001), by both flow rules, from files, and from pixels.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, International Journal of Mechanical Sciences 43 (2001)
209-224.  See drystone_lab.statics_cases for the factors.

With associated flow they are given to five digits; the tolerance is half a unit of the last one.
Without dilatancy they depend on the method, which finds one of many; the least that a nonlinear
solver found on the same complementarity problems are .63898, .5574, .35582, .26374 and .2086.

From pixels, 20 px per brick height, edges of blocks are rounded to the nearest pixel corner, so
that blocks of 4 x 1.75 are 46 or 45 pixels wide where 45.71 would be right; edges that lie above
each other stay so.
"""

import json
from dataclasses import replace

import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.flow.flow_search import NonassociativeSettings
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone_lab.pixels import BRICK_PX, from_outlines, from_pixels, rasterised
from drystone_lab.statics_cases import WALLS, closed_forms
from tests.statics.walls import alphas, irregular

QUICK = NonassociativeSettings(random_starts=0)

SIZES = ((33, 83), (55, 141), (46, 102), (55, 116), (61, 120), (146, 345))
"""Blocks and contacts of each wall of Ferris and Tin-Loi, as published."""

every_wall = pytest.mark.parametrize("number", range(1, 7))
but_the_last = pytest.mark.parametrize("number", range(1, 6))
both_ways = pytest.mark.parametrize("model_of", [from_pixels, from_outlines])


def assert_published(number, model, **tolerance):
    assert (len(model.blocks), len(model.interfaces)) == SIZES[number - 1]
    assert alphas(model) == pytest.approx((WALLS[number - 1].left,) * 2, **tolerance)


@every_wall
def test_from_the_courses(number):
    assert_published(number, WALLS[number - 1].model, abs=5e-6)


@every_wall
def test_from_the_published_files(number, data_dir):
    data = json.loads((data_dir / "ferris" / f"ferris_ex{number}.json").read_text("utf-8"))
    assert_published(number, model_from_json(data), abs=5e-6)
    assert sorted(map(tuple, data["blocks_xywh"])) == sorted(WALLS[number - 1].rectangles)


@both_ways
@but_the_last
def test_from_pixels(number, model_of):
    labels = rasterised(WALLS[number - 1].rectangles, BRICK_PX / 1.75)
    assert_published(number, model_of(labels, 0.65), rel=0.01)


@both_ways
@pytest.mark.parametrize("case", closed_forms(), ids=lambda case: f"{case.name}, mu {case.mu}")
def test_closed_forms_from_pixels(case, model_of):
    """Exact: all edges lie on pixel edges."""
    found = alphas(model_of(rasterised(case.rectangles, BRICK_PX), case.mu))
    assert found == pytest.approx((case.left, case.right), abs=1e-8)


@but_the_last
def test_without_dilatancy(number):
    wall = WALLS[number - 1]
    least, greatest = wall.nonassociative
    both = nonassociative_resistance(wall.model, settings=QUICK)
    for result in (both.left, both.right):
        assert result.success
        assert result.check.holds
        assert least <= result.alpha <= min(greatest, wall.left + 5e-6)


def test_descent_reaches_the_least_load_of_the_first_wall():
    without = replace(QUICK, patience=0)
    first = nonassociative_resistance(WALLS[0].model, settings=without).left
    assert first.alpha > 0.6395
    least = nonassociative_resistance(WALLS[0].model, settings=QUICK).left
    assert least.alpha == pytest.approx(0.63898, abs=5e-6)


def test_irregular_walls_with_an_answer():
    answered = asked = 0
    for seed in range(5):
        for mu in (0.58, 0.9):
            model = model_from_labels(irregular(seed, 18, 100, 70), mu).model
            associative = lateral_resistance(model)
            if not associative.stable:
                continue
            both = nonassociative_resistance(model, settings=QUICK)
            sides = (both.left, associative.left), (both.right, associative.right)
            for result, above in sides:
                asked += 1
                answered += result.status is not LimitStatus.FAILED
                assert result.status is LimitStatus.FAILED or result.check.holds
                assert result.alpha is None or result.alpha <= above.alpha
    assert asked >= 8
    assert answered >= 0.95 * asked
