"""Support, rotation first, wedging second (§3.7, Figs. 9 and 20, DESIGN 4.6)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import (
    Support,
    WedgeStock,
    make_stable,
    rotate_to_rest,
    stabilise,
    support_polyline,
)
from tests.naive import support as naive
from tests.stabilise.scenes import BOOK, bar_on_the_ledge, ledge, stairs
from tests.stabilise.test_wedge import check_wedge, holds
from tests.strategies import posed_on_walls, repeatable

STOCK = WedgeStock(next_id=100, mean_height_px=12.0)
METHODS = ("both", "rotation", "wedge", "none")


def stabilised_bar(method, **limits):
    book, occupied = PoseBook(), ledge()
    settings = StabiliseSettings(method=method, **limits)
    return stabilise(occupied, bar_on_the_ledge(occupied, book), "left", book, STOCK, settings)


def test_methods_select_rotation_wedging_both_or_neither():
    assert stabilised_bar("none") is None
    rotated = stabilised_bar("rotation")
    assert rotated.placement.posed.angle_deg < 0
    assert rotated.placement.rotation_moves >= 1
    assert rotated.wedges == ()
    wedged = stabilised_bar("wedge")
    assert (wedged.placement.posed.angle_deg, wedged.placement.rotation_moves) == (0.0, 0)
    assert [wedge.id for wedge in wedged.wedges] == [100]
    both = stabilised_bar("both")
    assert both.placement.posed.angle_deg == rotated.placement.posed.angle_deg


def test_wedging_comes_when_rotation_fails_and_starts_from_the_trial_pose():
    assert stabilised_bar("rotation", max_turn_deg=5.0) is None
    both = stabilised_bar("both", max_turn_deg=5.0)
    assert both.placement.posed.angle_deg == 0.0
    assert len(both.wedges) == 1


def test_a_stone_balanced_on_a_point_is_wedged_on_both_sides_or_refused():
    """With a margin, a support too narrow for it must be widened to both sides."""
    book = PoseBook()
    occupied = np.zeros((24, 50), bool)
    occupied[20:, 16:18] = True
    posed, row, _ = bar_on_the_ledge(occupied, book, col=16, length=30)
    trial = posed, row, 2
    settings = StabiliseSettings(method="wedge", margin=0.1)
    result = stabilise(occupied, trial, "left", book, STOCK, settings)
    assert [wedge.id for wedge in result.wedges] == [100, 101]
    assert holds(occupied, trial, result.wedges, 0.1)


@repeatable(80)
@given(
    scene=posed_on_walls(), method=st.sampled_from(METHODS), margin=st.sampled_from([0.0, 0.1, 0.2])
)
def test_whatever_comes_out_is_a_stable_rigid_copy_inside_the_site(scene, method, margin):
    wall, posed, row, col = scene
    book = PoseBook()
    settings = StabiliseSettings(method=method, margin=margin)
    stock = WedgeStock(100, 8.0)
    result = stabilise(wall.occupied, (posed, row, col), "right", book, stock, settings)
    stable = naive.rests_stably(
        wall.occupied, posed.mask, row, col, col + posed.anchor[0], margin * posed.width_px
    )
    if result is None:
        assert not stable
        return
    placed = result.placement
    pose = placed.posed, placed.row, placed.col
    wall.add(placed, result.wedges)  # refuses what overlaps or leaves the site
    assert np.array_equal(
        placed.posed.mask, PoseBook().pose(posed.stone, placed.posed.angle_deg).mask
    )
    assert placed.side == "right"
    assert abs(placed.posed.angle_deg) <= settings.max_turn_deg
    assert holds(wall.occupied, pose, result.wedges, margin)
    for k, wedge in enumerate(result.wedges):
        assert wedge.id == 100 + k
        check_wedge(wall.occupied, pose, wedge, 4.0, settings)
    if stable:
        assert (placed.row, placed.col, result.wedges) == (row, col, ())
    if method in ("none", "rotation"):
        assert result.wedges == ()
    if method in ("none", "wedge"):
        assert placed.posed.angle_deg == posed.angle_deg
    if result.wedges:
        assert placed.rotation_moves == 0


@pytest.mark.parametrize(("depth", "held"), [(29, True), (30, True), (31, False), (40, False)])
def test_a_gap_higher_than_a_wedge_may_be_is_not_taken_for_the_ground(depth, held):
    occupied = ledge(height=depth, site=(60, 50))
    trial = bar_on_the_ledge(occupied, PoseBook())
    stock = WedgeStock(next_id=100, mean_height_px=60.0)
    settings = StabiliseSettings(method="wedge")
    result = stabilise(occupied, trial, "left", PoseBook(), stock, settings)
    assert (result is not None) is held
    outcome = make_stable(occupied, trial, "left", PoseBook(), stock, settings)
    assert outcome.depth == trial[1] + 6 + 30 + 1


@repeatable(60)
@given(on_wall=posed_on_walls(), margin=st.sampled_from([0.0, 0.5, 1.5]))
def test_support_is_that_of_every_pixel_on_its_own(on_wall, margin):
    wall, posed, row, col = on_wall
    support = support_polyline(wall.occupied, posed, row, col)
    ends = naive.support_ends(wall.occupied, posed.mask, row, col)
    assert ((support.left_x, support.left_row), (support.right_x, support.right_row)) == ends
    x_c = col + posed.anchor[0]
    stable = naive.rests_stably(wall.occupied, posed.mask, row, col, x_c, margin)
    assert (support.falls(x_c, margin) == 0) == stable


@pytest.mark.parametrize(
    ("x_c", "margin", "falls"),
    [
        (1.9, 0.0, -1), (2.0, 0.0, 0), (6.0, 0.0, 0), (6.1, 0.0, 1),
        (2.9, 1.0, -1), (3.0, 1.0, 0), (5.1, 1.0, 1), (3.9, 3.0, -1), (4.1, 3.0, 1),
    ],
)  # fmt: skip
def test_it_falls_to_the_nearer_end(x_c, margin, falls):
    assert Support(2, 6, 9, 9).falls(x_c, margin) == falls


def test_a_stable_stone_is_left_alone():
    occupied = ledge()
    trial = bar_on_the_ledge(occupied, PoseBook(), col=0, length=20)
    result = rotate_to_rest(occupied, trial, PoseBook(), StabiliseSettings())
    assert result.pivots == 0
    assert result.pose == trial
    assert result.depth == trial[1] + 6 + 1  # the rows of the bar, and the one below


@repeatable(60)
@given(
    scene=stairs(),
    settings=st.sampled_from(
        [
            StabiliseSettings(),
            StabiliseSettings(margin=0.1, max_turn_deg=70.0, step_deg=2.0),
            StabiliseSettings(max_turn_deg=40.0, max_pivots=2, new_pivot_px=0, max_shift_px=5),
            StabiliseSettings(new_pivot_px=60),
            StabiliseSettings(max_turn_deg=5.0),
        ]
    ),
)
def test_it_turns_as_a_walk_from_angle_to_angle_does(scene, settings):
    occupied, trial = scene
    result = rotate_to_rest(occupied, trial, BOOK, settings)
    expected = naive.rotated(occupied, trial, BOOK, settings)
    assert (result.pose and (result.pose, result.pivots)) == expected


def test_a_stone_in_the_air_does_not_rest():
    posed = PoseBook().pose(Stone(7, np.ones((6, 30), bool)), 0.0)
    result = rotate_to_rest(ledge(), (posed, 3, 10), PoseBook(), StabiliseSettings())
    assert result.pose is None
