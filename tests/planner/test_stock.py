"""What is known of the stone set as a whole."""

import numpy as np
import pytest

from drystone.model.site import Site
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock, sides_of
from drystone.planner.workshop import Workshop
from tests.planner.scenes import blocks


def workshop_of(sizes):
    return Workshop.prepare(blocks(sizes), Site(40, 20), PlannerSettings())


def test_stock():
    workshop = workshop_of({7: (20, 10), 300: (8, 4), 12: (12, 6)})
    stock = workshop.stock
    assert (stock.narrowest_px, stock.largest_id) == (8.0, 300)
    assert stock.mean_height_px == pytest.approx(20 / 3)
    assert stock.mean_area_px == pytest.approx((200 + 32 + 72) / 3)
    assert stock.sides == {(10, 20): 1, (4, 8): 1, (6, 12): 1}
    # One pose at a time is enough.
    assert Stock.of(map(workshop.initial, (7, 12, 300))) == stock


@pytest.mark.parametrize(
    ("sizes", "heights", "widths"),
    [
        # Flat on each other; beside each other 4 or 8, 10 or 20, and sums of one of each.
        ({1: (20, 10), 2: (8, 4)}, [0, 4, 10, 14], [0, 4, 8, 10, 14, 18, 20, 24, 28]),
        # Also where they are of one height and of different widths.
        ({1: (20, 6), 2: (14, 6)}, [0, 6, 12], [0, 6, 12, 14, 20, 26, 34]),
    ],
)
def test_rest_lays_stones_flat_on_each_other_and_any_way_beside(sizes, heights, widths):
    workshop = workshop_of(sizes)
    rest = Rest.of(workshop.sides, workshop.site)
    assert (rest.height_px.shape, rest.width_px.shape) == ((21,), (41,))
    assert np.flatnonzero(rest.height_px == 0).tolist() == heights
    assert np.flatnonzero(rest.width_px == 0).tolist() == widths


def test_sides_that_are_left():
    workshop = workshop_of({1: (20, 10), 2: (8, 4), 3: (10, 20), 4: (8, 4)})
    poses, sides = {i: workshop.initial(i) for i in (1, 2, 3, 4)}, workshop.sides
    left = sides - sides_of([poses[1], poses[2]])
    assert left == {(10, 20): 1, (4, 8): 1} == sides_of([poses[3], poses[4]])
    assert sides == {(10, 20): 2, (4, 8): 2}
