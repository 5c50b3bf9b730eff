"""IWR (Eq. 9, DESIGN 4.5)."""

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.indices.interlocking import interlocking_width_ratio
from drystone.model.landscape import Box, Landscape, view_box
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.wall import Wall
from tests.naive import indices as naive
from tests.strategies import posed_on_walls, repeatable


@repeatable(80)
@given(scene=posed_on_walls(), end=st.integers(0, 6))
def test_iwr_is_that_of_the_label_image(scene: tuple[Wall, PosedStone, int, int], end: int) -> None:
    wall, posed, row, col = scene
    landscape = Landscape.of(wall)
    box = view_box(posed, row, col, landscape.height_px)
    stone = naive.painted(wall.occupied.shape, posed.mask, row, col)
    assert interlocking_width_ratio(landscape, box, end) == pytest.approx(
        naive.interlocking(wall.labels, stone, end)
    )


def course(*edges: int) -> Landscape:
    boxes = tuple(Box(a, b, 0, 10) for a, b in itertools.pairwise(edges))
    return Landscape(Wall.empty(Site(60, 30)).occupied, boxes)


def test_running_bond_has_one_half_and_a_stack_bond_nothing() -> None:
    landscape = course(0, 20, 40, 60)
    assert interlocking_width_ratio(landscape, Box(10, 30, 10, 20), 5) == 0.5
    assert interlocking_width_ratio(landscape, Box(20, 40, 10, 20), 5) == 0.0


def test_the_ends_of_the_wall_are_no_joints() -> None:
    # Below is one stone up to the wall's right end; its left end at 40 is the only joint.
    assert interlocking_width_ratio(course(40, 60), Box(36, 56, 10, 20), 5) == pytest.approx(0.8)
    # Below is one stone from the wall's left end on.
    assert interlocking_width_ratio(course(0, 20), Box(4, 24, 10, 20), 5) == pytest.approx(0.8)


def test_only_one_joint_stands_alone() -> None:
    assert interlocking_width_ratio(course(0, 30), Box(24, 44, 10, 20), 5) == 0.2


def test_on_the_ground_and_over_nothing_lower_there_is_no_joint() -> None:
    assert interlocking_width_ratio(course(0, 20, 40), Box(40, 50, 0, 10), 5) == 0.5
    assert interlocking_width_ratio(course(0, 20), Box(30, 40, 1, 6), 5) == 0.5
