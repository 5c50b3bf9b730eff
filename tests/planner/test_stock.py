"""What is known of the stone set as a whole."""

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock, sides_of
from drystone.planner.workshop import Workshop
from tests.planner.scenes import blocks


def test_stock():
    stones = blocks({7: (20, 10), 300: (8, 4), 12: (12, 6)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    stock = workshop.stock
    assert (stock.narrowest_px, stock.largest_id) == (8.0, 300)
    assert stock.mean_height_px == pytest.approx(20 / 3)
    assert stock.mean_area_px == pytest.approx((200 + 32 + 72) / 3)
    assert stock.sides == {(10, 20): 1, (4, 8): 1, (6, 12): 1}
    # One pose at a time is enough.
    assert Stock.of(map(workshop.initial, (7, 12, 300))) == stock


def test_rest_lays_stones_flat_on_each_other_and_any_way_beside():
    stones = blocks({1: (20, 10), 2: (8, 4)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    rest = Rest.of(workshop.sides, workshop.site)
    # Flat: 4, 10, 14.  Beside each other: 4 or 8, 10 or 20, and sums of one of each.
    heights, widths = {0, 4, 10, 14}, {0, 4, 8, 10, 20, 14, 18, 24, 28}
    assert np.flatnonzero(rest.height_px == 0).tolist() == sorted(heights)
    assert np.flatnonzero(rest.width_px == 0).tolist() == sorted(widths)
    assert rest.height_px.shape == (21,)
    assert rest.width_px.shape == (41,)


def test_sides_that_are_left():
    stones = blocks({1: (20, 10), 2: (8, 4), 3: (10, 20), 4: (8, 4)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    poses = {i: workshop.initial(i) for i in (1, 2, 3, 4)}
    sides = workshop.sides
    assert sides == {(10, 20): 2, (4, 8): 2}
    left = sides - sides_of([poses[1], poses[2]])
    assert left == {(10, 20): 1, (4, 8): 1}
    assert sides == {(10, 20): 2, (4, 8): 2}
    assert left - sides_of([poses[4]]) == {(10, 20): 1}
    rest = Rest.of(sides_of([poses[3], poses[4]]), workshop.site)
    assert rest.width_px.tolist() == Rest.of(left, workshop.site).width_px.tolist()
    assert rest.height_px.tolist() == Rest.of(left, workshop.site).height_px.tolist()


def test_stones_of_one_height_and_different_widths_lie_on_each_other():
    stones = blocks({1: (20, 6), 2: (14, 6), 3: (6, 9)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    rest = Rest.of(workshop.sides, workshop.site)
    assert np.flatnonzero(rest.height_px == 0).tolist() == [0, 6, 12, 18]
