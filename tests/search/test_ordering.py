"""The order of laying, chosen by rehearsals."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.search.goal import LAST_RUNS, FoundWall, falls_of
from drystone.search.ordering import reordered
from drystone.search.yard import Yard
from tests.planner.scenes import ROUNDED, ROUNDED_SITE, bricks, finish, greedy


@pytest.fixture(scope="module")
def laid():
    """A wall that falls in some rehearsals, and with which stones that begins."""
    careless = greedy({"search": {"budget": 2}, "settle": {"trials": 0}})
    planner = finish(Planner(ROUNDED, ROUNDED_SITE, seed=1, settings=careless))
    yard = Yard.of(planner)
    falls = falls_of(planner.build.wall.groups, yard, LAST_RUNS)
    often = [stone for stone, _ in falls.first.most_common()]
    return FoundWall.of(planner).judged(yard), yard, often


def above(one, other):
    """Say whether a stone is above another where they share some width, column by column."""
    low = max(one.bounds[0], other.bounds[0])
    high = min(one.bounds[2], other.bounds[2])
    # Which of two is above that hardly share any width is nobody's concern.
    if high - low < 0.2 * min(one.bounds[2] - one.bounds[0], other.bounds[2] - other.bounds[0]):
        return False
    ups = []
    for x in np.linspace(low, high, 41)[1:-1]:
        line = shapely.LineString([(x, -1e4), (x, 1e4)])
        first, second = one.intersection(line).bounds, other.intersection(line).bounds
        ups.append(first[1] + first[3] - second[1] - second[3])
    return float(np.mean(ups)) > 0.0


def test_another_order_of_the_same_wall_falls_less(laid):
    found, yard, often = laid
    careless = replace(found, figures=replace(found.figures, fallen=1.0))
    better = reordered(careless, yard, often)
    before, after = found.build.wall.groups, better.build.wall.groups
    ids = [group.placement.stone_id for group in before]
    assert [group.placement.stone_id for group in after] != ids
    places = {group.placement.stone_id: group.placement.exact for group in before}
    for group in after:
        assert np.array_equal(
            group.placement.exact.corners, places[group.placement.stone_id].corners
        )
    assert len(after) == len(before)
    assert all(action.stands for action in better.build.actions)
    figures = better.figures
    assert falls_of(after, yard, LAST_RUNS) == better.falls
    assert figures.fallen == better.falls.share
    # It is given up as soon as more falls than is asked for.
    assert falls_of(after, yard, LAST_RUNS, 0.5 * figures.fallen) is None
    assert replace(figures, fallen=1.0) == careless.figures
    known = found.figures.fallen
    weight = yard.settings.goal.fallen
    assert better.merit == pytest.approx(found.merit + weight * (known - figures.fallen))
    # What lies under a stone is laid before it.
    shapes = [shapely.Polygon(group.placement.exact.corners) for group in after]
    assert not any(above(one, other) for k, other in enumerate(shapes) for one in shapes[:k])


def test_no_order_is_better_than_one_in_which_nothing_falls(laid):
    found, yard, often = laid
    assert (
        reordered(replace(found, figures=replace(found.figures, fallen=0.0)), yard, often) is None
    )
    nothing = FoundWall.of(Planner(bricks(), Site(60, 20), settings=yard.settings))
    assert reordered(nothing, yard, []) is None
