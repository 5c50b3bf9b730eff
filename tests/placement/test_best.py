"""The best positions, ties and rules (§3.6, DESIGN 4.4)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.placement.best import Spot, best_spots
from drystone.placement.settings import PlacementSettings
from drystone.poses import PoseBook
from tests.naive import placement as naive
from tests.naive import rays
from tests.strategies import posed_on_walls, repeatable


def block(height, width, stone_id=1):
    return PoseBook().pose(Stone(stone_id, np.ones((height, width), bool)), 0.0)


@repeatable(40)
@given(scene=posed_on_walls(), tries=st.integers(1, 9))
def test_eq12_chooses_among_the_poses_too(scene, tries):
    wall, posed, _, _ = scene
    poses = [posed, PoseBook().pose(posed.stone, 90.0), block(2, 5)]
    value = {
        (k, *at): naive.eq12(wall.occupied, p.mask, p.anchor[0], at, 0.7)
        for k, p in enumerate(poses)
        for at in naive.resting_positions(wall.occupied, p.mask)
    }
    floors = [p.height_px for p in poses]
    ranked = sorted(value, key=lambda s: (-round(value[s], 9), -s[1] - floors[s[0]], s[2], s[0]))
    got = best_spots(Landscape.of(wall), poses, PlacementSettings(tries=tries))
    assert [(spot.pose, spot.row, spot.col) for spot in got] == ranked[:tries]


@repeatable(40)
@given(scene=posed_on_walls())
def test_snug_takes_the_least_weighted_cost(scene):
    wall, posed, _, _ = scene
    settings = PlacementSettings(rule="snug", reach="above", tries=5)
    height, width = wall.occupied.shape

    def cost(at):
        gap = naive.gap_beside(wall.occupied, posed.mask, at) / posed.area_px
        return (
            settings.height_weight * (height - at[0] - posed.height_px) / posed.height_px
            + settings.void_weight * naive.void_below(wall.occupied, posed.mask, at) / posed.area_px
            + settings.gap_weight * min(1.0, gap)
            + settings.end_weight * at[1] / width
        )

    places = naive.positions_from_above(wall.occupied, posed.mask)
    ranked = sorted(places, key=lambda at: (round(cost(at), 9), -at[0], at[1]))
    got = best_spots(Landscape.of(wall), [posed], settings)
    assert [(spot.row, spot.col) for spot in got] == ranked[:5]


@pytest.mark.parametrize("rule", ["eq12", "lowest", "snug"])
def test_every_rule_keeps_the_clearance(rule):
    """Of all places that a rule may take, none is without the room asked for on the way down."""
    narrow = 0

    @repeatable(35)
    @given(scene=posed_on_walls(), clearance=st.integers(0, 3))
    def check(scene, clearance):
        nonlocal narrow
        wall, posed, _, _ = scene
        settings = PlacementSettings(rule=rule, reach="above", clearance_px=clearance, tries=999)
        got = best_spots(Landscape.of(wall), [posed], settings)
        wide = naive.positions_from_above(wall.occupied, posed.mask, clearance)
        assert sorted((spot.row, spot.col) for spot in got) == wide
        narrow += wide != naive.positions_from_above(wall.occupied, posed.mask)

    check()
    assert narrow > 5  # places that have no room to their sides


@repeatable(40)
@given(scene=posed_on_walls())
def test_lowest_takes_the_lowest_then_the_tightest_then_the_left(scene):
    wall, posed, _, _ = scene
    places = naive.resting_positions(wall.occupied, posed.mask)
    filling = {p: rays.local_filling_ratio(wall.occupied, posed.mask, *p) for p in places}
    expected = min(places, key=lambda p: (-p[0], -round(filling[p], 9), p[1]))
    spot = best_spots(Landscape.of(wall), [posed], PlacementSettings(rule="lowest"))[0]
    assert (spot.row, spot.col) == expected


def test_equal_merits_go_to_the_lower_place_then_to_the_building_side_then_to_the_first():
    wall = Wall.empty(Site(20, 9)).add(Placement(block(3, 4), 6, 8))
    settings = PlacementSettings(
        rule="snug", tries=99, height_weight=0, void_weight=0, gap_weight=0, end_weight=0
    )
    one, other = block(2, 2, 2), block(2, 2, 3)
    spots = best_spots(Landscape.of(wall), [one, other], settings)
    assert spots[:3] == [Spot(0, 7, 0), Spot(1, 7, 0), Spot(0, 7, 1)]
    rows = [spot.row for spot in spots]
    assert rows == sorted(rows, reverse=True)


def test_a_lower_place_is_one_with_a_lower_underside_whatever_the_pose():
    settings = PlacementSettings(rule="lowest", tries=99)
    wall = Wall.empty(Site(10, 9)).add(Placement(block(2, 4), 7, 0))
    spots = best_spots(Landscape.of(wall), [block(2, 3, 2), block(6, 2, 2)], settings)
    undersides = [spot.row + (2, 6)[spot.pose] for spot in spots]
    assert undersides == sorted(undersides, reverse=True)


@pytest.mark.parametrize("rule", ["eq12", "lowest", "snug"])
def test_no_room_is_an_empty_list(rule):
    settings = PlacementSettings(rule=rule)
    assert (
        best_spots(Landscape.of(Wall.empty(Site(5, 5))), [block(6, 2), block(2, 6)], settings) == []
    )
