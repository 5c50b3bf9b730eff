"""The indices, each against its slow twin and on walls small enough to count (Eq. 3 to 11)."""

import dataclasses
from statistics import fmean

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.indices import (
    Indices,
    geometrical_dice_score_at,
    interlocking_width_ratio,
    inward_slope,
    joints_below,
    left_neighbour,
    local_filling_ratio_at,
    neighbour_height_ratio,
)
from drystone.kernels.spots import dice_score
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.naive import indices as naive
from tests.naive import rays as naive_rays
from tests.strategies import posed_on_walls, repeatable


@repeatable(80)
@given(
    scene=posed_on_walls(),
    others=st.lists(st.integers(1, 20).map(float), max_size=3),
    end=st.integers(0, 6),
)
def test_every_index_is_that_of_its_slow_twin(scene, others, end):
    """LFR is that of rays, GDS of the painted box, NHR, IWR and IS of the label image."""
    wall, posed, row, col = scene
    landscape, occupied, labels = Landscape.of(wall), wall.occupied, wall.labels
    box = view_box(posed, row, col, landscape.height_px)
    stone = naive.painted(occupied.shape, posed.mask, row, col)
    filling = local_filling_ratio_at(landscape, posed, row, col)
    assert filling == pytest.approx(naive_rays.local_filling_ratio(occupied, posed.mask, row, col))
    score = geometrical_dice_score_at(landscape, posed, row)
    assert score == pytest.approx(naive.dice_score(occupied, stone))
    # The rule of placement counts with the same number, to the last bit.
    top = wall.site.height_px - wall.height_px
    inside = posed.mask[max(0, top - row) :].sum(dtype=np.int32)
    box_area = float(wall.site.width_px * wall.height_px)
    assert dice_score(np.array([inside], np.int32), posed.area_px, box_area).tolist() == [score]
    neighbour, expected = left_neighbour(landscape, box), naive.left_neighbour(labels, stone)
    if expected is not None:
        extent = naive.extent_of(labels == expected)
        expected = Box(extent.x0, extent.x1, extent.y0, extent.y1)
    assert neighbour == expected
    mean = fmean(others) if others else None
    assert neighbour_height_ratio(box, neighbour, mean) == pytest.approx(
        naive.neighbour_height_ratio(labels, stone, others)
    )
    assert interlocking_width_ratio(landscape, box, end) == pytest.approx(
        naive.interlocking(labels, stone, end)
    )
    assert inward_slope(landscape, posed, col) == pytest.approx(
        naive.inward_slope(stone, col + posed.anchor[0])
    )


def test_of_equals_the_higher_neighbour_and_the_first_joint_are_taken():
    occupied = Wall.empty(Site(60, 40)).occupied
    low, high = Box(0, 10, 4, 12), Box(4, 10, 6, 14)
    assert left_neighbour(Landscape(occupied, (low, high)), Box(10, 20, 6, 14)) == high
    one, other = Box(0, 10, 0, 10), Box(11, 20, 0, 10)
    landscape = Landscape(occupied, (one, other))
    assert joints_below(landscape, Box(15, 40, 10, 20), 0)[0] == one
    assert joints_below(landscape, Box(15, 40, 8, 11), 0) == (None, None)


def test_names_are_those_of_the_paper_and_boundary_stones_are_judged_by_is():
    values = {"SF": 0.9, "LFR": 0.8, "GDS": 0.7, "NHR": 0.1, "IWR": 0.5, "IS": -0.2, "LLC": 0.4}
    found = Indices(**values, boundary=False)
    assert list(found.as_dict().items()) == list(values.items())
    assert (found.third, dataclasses.replace(found, boundary=True).third) == (0.5, -0.2)


def test_llc_is_the_smaller_factor_over_mu_and_none_without_one():
    left = LimitResult(LimitStatus.OPTIMAL, "left", 0.29)
    right = LimitResult(LimitStatus.OPTIMAL, "right", 0.58)
    fallen = LimitResult(LimitStatus.UNSTABLE, "right")
    assert LateralResistance(left, right, 0.58).value == 0.29 / 0.58
    assert LateralResistance(left, fallen, 0.58).value is None
    assert LateralResistance(left, right, 0.0).value is None  # no ratio to no friction
