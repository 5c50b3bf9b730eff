"""Feasible positions, the best of them, ties and rules (§3.6, Fig. 8, DESIGN 4.4)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.placement.best import Spot, best_spots
from drystone.placement.feasible import can_be_lowered, feasible_positions
from drystone.placement.settings import PlacementSettings
from drystone.poses import PoseBook
from tests.naive import placement as naive
from tests.naive.rays import local_filling_ratio
from tests.strategies import landscapes, masks, posed_on_walls, repeatable


def block(height, width, stone_id=1):
    return PoseBook().pose(Stone(stone_id, np.ones((height, width), bool)), 0.0)


@repeatable(100)
@given(landscapes(16), masks(), st.integers(0, 3))
def test_positions_are_those_of_loops_and_some_can_be_reached_from_above(occupied, mask, clearance):
    landscape = Landscape(occupied, ())
    posed = PosedStone(Stone(1, mask), 0.0, 1.0, mask.copy(), (0.5, 0.5))
    lowered = naive.positions_from_above(occupied, mask, clearance)
    found = feasible_positions(landscape, posed, "above", clearance)
    assert (found.dtype, found.flags.c_contiguous) == (np.int64, True)
    assert [tuple(at) for at in found.tolist()] == lowered
    found = [tuple(at) for at in feasible_positions(landscape, posed).tolist()]
    assert found == naive.resting_positions(occupied, mask)
    for at in found:
        assert can_be_lowered(landscape, posed, *at, clearance) == (at in lowered)


def merit(rule, settings, wall, posed, at):
    occupied, mask, area_px = wall.occupied, posed.mask, posed.area_px
    if rule == "eq12":
        return naive.eq12(occupied, mask, posed.anchor[0], at, settings.beta)
    if rule == "lowest":
        return local_filling_ratio(occupied, mask, *at)
    height, width = occupied.shape
    return -(
        settings.height_weight * (height - at[0] - posed.height_px) / posed.height_px
        + settings.void_weight * naive.void_below(occupied, mask, at) / area_px
        + settings.gap_weight * min(1.0, naive.gap_beside(occupied, mask, at) / area_px)
        + settings.end_weight * at[1] / width
    )


@pytest.mark.parametrize("rule", ["eq12", "lowest", "snug"])
@given(scene=posed_on_walls(), clearance=st.none() | st.integers(0, 3), tries=st.integers(1, 9))
def test_rules_rank_all_places_of_all_poses(rule, scene, clearance, tries):
    """What snug counts below a stone is open from above only."""
    wall, posed, _, _ = scene
    if clearance is None and rule != "snug":
        reach, places_of = "any", naive.resting_positions
    else:
        reach, clearance = "above", clearance or 0
        places_of = lambda *on: naive.positions_from_above(*on, clearance)  # noqa: E731
    settings = PlacementSettings(rule=rule, reach=reach, clearance_px=clearance or 0, tries=tries)
    poses = [posed, PoseBook().pose(posed.stone, 90.0), block(2, 5), block(99, 1)]
    ranks = []
    for k, pose in enumerate(poses):
        for at in places_of(wall.occupied, pose.mask):
            worth, floor = -round(merit(rule, settings, wall, pose, at), 9), -at[0] - pose.height_px
            first = (floor, worth) if rule == "lowest" else (worth, floor)
            ranks.append((*first, at[1], k, at[0]))
    expected = [Spot(k, row, col) for *_, col, k, row in sorted(ranks)[:tries]]
    assert best_spots(Landscape.of(wall), poses, settings) == expected


def test_equal_merits_go_to_the_lower_place_then_to_the_building_side_then_to_the_first():
    wall = Wall.empty(Site(20, 9)).add(Placement(block(3, 4), 6, 8))
    settings = PlacementSettings(
        rule="snug", tries=99, height_weight=0, void_weight=0, gap_weight=0, end_weight=0
    )
    spots = best_spots(Landscape.of(wall), [block(2, 2, 2), block(2, 2, 3)], settings)
    assert spots[:3] == [Spot(0, 7, 0), Spot(1, 7, 0), Spot(0, 7, 1)]
    rows = [spot.row for spot in spots]
    assert rows == sorted(rows, reverse=True)
