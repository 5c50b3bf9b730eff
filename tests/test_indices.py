"""The indices, each against its slow twin and on walls small enough to count (Eq. 3 to 11)."""

import dataclasses
import itertools
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
    is_boundary,
    joints_below,
    left_neighbour,
    local_filling_ratio_at,
    neighbour_height_ratio,
    shape_factor,
)
from drystone.kernels.spots import dice_score
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.naive import indices as naive
from tests.naive import rays as naive_rays
from tests.strategies import posed_on_walls, repeatable


def test_an_upright_rectangle_has_one_and_a_turned_square_one_half():
    square = Stone(1, np.ones((10, 10), bool))
    assert shape_factor(PoseBook(0.3).pose(square, 90.0)) == pytest.approx(1.0)
    assert shape_factor(PoseBook(0.3).pose(square, 45.0)) == pytest.approx(0.5)


@repeatable()
@given(scene=posed_on_walls())
def test_lfr_is_that_of_rays(scene):
    wall, posed, row, col = scene
    got = local_filling_ratio_at(Landscape.of(wall), posed, row, col)
    assert got == pytest.approx(naive_rays.local_filling_ratio(wall.occupied, posed.mask, row, col))


@repeatable()
@given(scene=posed_on_walls())
def test_gds_is_that_of_the_painted_box(scene):
    wall, posed, row, col = scene
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    landscape = Landscape.of(wall)
    got = geometrical_dice_score_at(landscape, posed, row)
    assert got == pytest.approx(naive.dice_score(wall.occupied, stone))
    # The rule of placement counts with the same number, to the last bit.
    top = wall.site.height_px - wall.height_px
    inside = posed.mask[max(0, top - row) :].sum(dtype=np.int32)
    box_area = float(wall.site.width_px * wall.height_px)
    assert dice_score(np.array([inside], np.int32), posed.area_px, box_area).tolist() == [got]


@repeatable(80)
@given(scene=posed_on_walls(), others=st.lists(st.integers(1, 20).map(float), max_size=3))
def test_nhr_is_that_of_the_label_image(scene, others):
    wall, posed, row, col = scene
    landscape = Landscape.of(wall)
    box = view_box(posed, row, col, landscape.height_px)
    neighbour = left_neighbour(landscape, box)
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    expected = naive.left_neighbour(wall.labels, stone)
    if expected is None:
        assert neighbour is None
    else:
        extent = naive.extent_of(wall.labels == expected)
        assert neighbour == Box(extent.x0, extent.x1, extent.y0, extent.y1)
    assert neighbour_height_ratio(
        box, neighbour, fmean(others) if others else None
    ) == pytest.approx(naive.neighbour_height_ratio(wall.labels, stone, others))


@repeatable(80)
@given(scene=posed_on_walls(), end=st.integers(0, 6))
def test_iwr_is_that_of_the_label_image(scene, end):
    wall, posed, row, col = scene
    landscape = Landscape.of(wall)
    box = view_box(posed, row, col, landscape.height_px)
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    assert interlocking_width_ratio(landscape, box, end) == pytest.approx(
        naive.interlocking(wall.labels, stone, end)
    )


def test_of_equals_the_higher_neighbour_and_the_first_joint_are_taken():
    occupied = Wall.empty(Site(60, 40)).occupied
    low, high = Box(0, 10, 4, 12), Box(4, 10, 6, 14)
    assert left_neighbour(Landscape(occupied, (low, high)), Box(10, 20, 6, 14)) == high
    one, other = Box(0, 10, 0, 10), Box(11, 20, 0, 10)
    landscape = Landscape(occupied, (one, other))
    assert joints_below(landscape, Box(15, 40, 10, 20), 0)[0] == one
    assert joints_below(landscape, Box(15, 40, 8, 11), 0) == (None, None)


@pytest.mark.parametrize(
    ("edges", "box", "share"),
    [
        ((0, 20, 40, 60), (10, 30), 0.5),  # running bond
        ((0, 20, 40, 60), (20, 40), 0.0),  # stack bond
        ((40, 60), (36, 56), 0.8),  # the end of the wall at 60 is no joint
        ((0, 20), (4, 24), 0.8),  # nor is that at 0
    ],
)
def test_bonds(edges, box, share):
    course = tuple(Box(a, b, 0, 10) for a, b in itertools.pairwise(edges))
    landscape = Landscape(Wall.empty(Site(60, 30)).occupied, course)
    assert interlocking_width_ratio(landscape, Box(*box, 10, 20), 5) == pytest.approx(share)


EMPTY = Landscape.of(Wall.empty(Site(40, 20)))


@repeatable(80)
@given(scene=posed_on_walls())
def test_is_is_that_of_the_wall_image(scene):
    wall, posed, row, col = scene
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    assert inward_slope(Landscape.of(wall), posed, col) == pytest.approx(
        naive.inward_slope(stone, col + posed.anchor[0])
    )


@pytest.mark.parametrize(
    ("tops", "x_c", "col", "slope"),
    [
        # Highest points: column 0 (outermost of two), and column 2, one px lower.
        ((3, 3, 2, 1), 1.7, 0, 0.5),
        ((3, 3, 2, 1), 1.7, 36, -0.5),
        ((1, 2, 3, 3), 2.3, 36, 0.5),
        ((9, 1), 0.75, 0, 1.0),  # clipped
        ((3, 3, 3), 1.5, 0, 0.0),  # level
        ((3,), 0.5, 0, 0.0),
        ((1, 2, 3, 2, 1), 2.5, 0, 0.0),  # a peak exactly at the centroid slopes to neither side
    ],
)
def test_slopes(tops, x_c, col, slope):
    """Falling inwards is positive at both ends."""
    mask = np.arange(max(tops))[::-1, None] < np.array(tops)
    posed = PosedStone(Stone(1, mask), 0.0, 1.0, mask, (x_c, 1.0))
    assert inward_slope(EMPTY, posed, col) == pytest.approx(slope)


@pytest.mark.parametrize(
    ("left", "right", "expected"), [(0, 5, True), (4, 9, True), (5, 9, False), (31, 36, True)]
)
def test_boundary_stones_are_nearer_to_an_end_than_the_narrowest_is_wide(left, right, expected):
    assert is_boundary(EMPTY, Box(left, right, 0, 3), narrowest_px=5) is expected


def test_names_are_those_of_the_paper_and_boundary_stones_are_judged_by_is():
    found = Indices(SF=0.9, LFR=0.8, GDS=0.7, NHR=0.1, IWR=0.5, IS=-0.2, LLC=0.4, boundary=False)
    assert list(found.as_dict()) == ["SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC"]
    assert list(found.as_dict().values()) == [0.9, 0.8, 0.7, 0.1, 0.5, -0.2, 0.4]
    assert (found.third, dataclasses.replace(found, boundary=True).third) == (0.5, -0.2)


def test_llc_is_the_smaller_factor_over_mu_and_none_without_one():
    left = LimitResult(LimitStatus.OPTIMAL, "left", 0.29)
    right = LimitResult(LimitStatus.OPTIMAL, "right", 0.58)
    fallen = LimitResult(LimitStatus.UNSTABLE, "right")
    assert LateralResistance(left, right, 0.58).value == 0.29 / 0.58
    assert LateralResistance(left, fallen, 0.58).value is None
    assert LateralResistance(left, right, 0.0).value is None  # no ratio to no friction
