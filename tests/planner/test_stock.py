"""What is known of the stone set as a whole."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.sums import unfillable
from drystone.model.site import Site
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest
from drystone.planner.workshop import Workshop
from tests.naive import planner as naive
from tests.planner.scenes import blocks
from tests.strategies import repeatable

lengths = st.lists(st.lists(st.integers(1, 12), min_size=1, max_size=2).map(tuple), max_size=5)


@repeatable(150)
@given(lengths, st.integers(0, 40))
def test_unfillable_tries_all_combinations(stones: list[tuple[int, ...]], limit: int) -> None:
    assert unfillable(stones, limit).tolist() == naive.unfillable(stones, limit)


def test_a_length_is_used_once_and_in_one_orientation() -> None:
    assert unfillable([(3, 5)], 8).tolist() == [0, 1, 2, 0, 1, 0, 1, 2, 3]


def test_stock() -> None:
    stones = blocks({7: (20, 10), 300: (8, 4), 12: (12, 6)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    stock = workshop.stock
    assert (stock.narrowest_px, stock.largest_id) == (8.0, 300)
    assert stock.mean_height_px == pytest.approx(20 / 3)
    assert stock.mean_area_px == pytest.approx((200 + 32 + 72) / 3)


def test_rest_lays_stones_flat_on_each_other_and_any_way_beside() -> None:
    stones = blocks({1: (20, 10), 2: (8, 4)})
    workshop = Workshop.prepare(stones, Site(40, 20), PlannerSettings())
    rest = Rest.of(workshop.initial.values(), workshop.site)
    # Flat: 4, 10, 14.  Beside each other: 4 or 8, 10 or 20, and sums of one of each.
    heights, widths = {0, 4, 10, 14}, {0, 4, 8, 10, 20, 14, 18, 24, 28}
    assert np.flatnonzero(rest.height_px == 0).tolist() == sorted(heights)
    assert np.flatnonzero(rest.width_px == 0).tolist() == sorted(widths)
    assert rest.height_px.shape == (21,)
    assert rest.width_px.shape == (41,)
