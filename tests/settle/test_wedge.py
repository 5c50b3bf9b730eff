"""Wedges under stones that would fall: drawn by hand, and on random piles."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.crevice import crevice
from drystone.kernels.polygons import (
    Points,
    Polygons,
    area_and_centroid,
    mirrored_polygon,
    no_polygons,
)
from drystone.kernels.settling import rest_margin
from drystone.settle.wedge import (
    WedgeLimits,
    _holds,
    _near,
    falling_side,
    in_order,
    met_below,
    wedge_under,
)
from drystone.settle.wedge_spans import Slabs, parts
from tests.naive.crevice import gap_at
from tests.settle.piles import WIDTH, moved, piles
from tests.strategies import repeatable

LIMITS = WedgeLimits(smallest_px=0.5, largest_px=6.0)


def box(left: float, low: float, right: float, high: float) -> Points:
    return np.array([[left, low], [right, low], [right, high], [left, high]], float)


def centroid(polygon: Points) -> tuple[float, float]:
    return area_and_centroid(polygon)[1:]


def wedge_for(
    stone: Points, around: Polygons, limits: WedgeLimits = LIMITS, falls: int | None = None
) -> Points | None:
    return wedge_under(stone, centroid(stone), around, WIDTH, limits, falls)


POST = box(11.0, 0.01, 14.0, 2.0)
PLANK = box(10.0, 2.01, 20.0, 4.0)
"""On the post; its centre of mass is at x = 15, one to the right of the post."""
SCENE = no_polygons().added([POST])


def test_the_gap_beside_a_post_is_filled_from_the_centre_of_mass_on() -> None:
    wedge = wedge_for(PLANK, SCENE)
    assert wedge is not None
    # 1.25 times as wide as high.
    right = 15.0 + 1.25 * 1.99
    expected = [[15.0, 0.01], [right, 0.01], [right, 2.0], [15.0, 2.0]]
    assert wedge == pytest.approx(np.array(expected))


def test_a_stone_that_falls_to_the_left_gets_its_wedge_there() -> None:
    plank = box(5.0, 2.01, 15.0, 4.0)
    wedge = wedge_for(plank, SCENE)
    assert wedge is not None
    left = 10.0 - 1.25 * 1.99
    expected = [[10.0, 2.0], [left, 2.0], [left, 0.01], [10.0, 0.01]]
    assert wedge == pytest.approx(np.array(expected))


def test_the_margin_moves_the_wedge_outwards() -> None:
    wedge = wedge_for(PLANK, SCENE, WedgeLimits(smallest_px=0.5, largest_px=6.0, margin=0.2))
    assert wedge is not None
    assert wedge[:, 0].min() == pytest.approx(17.0)


def test_at_the_end_of_the_stone_the_wedge_grows_inwards() -> None:
    limits = WedgeLimits(smallest_px=0.5, largest_px=6.0, margin=0.4)
    wedge = wedge_for(PLANK, SCENE, limits)
    assert wedge is not None
    assert wedge[:, 0].tolist() == pytest.approx([20 - 1.25 * 1.99, 20, 20, 20 - 1.25 * 1.99])


def test_at_the_end_of_the_stone_it_is_still_as_wide_as_the_smallest() -> None:
    """Floor and lid rise side by side, so that a wider wedge is higher than it may be."""
    stone = np.array([[10, 5.01], [24, 9.21], [24, 12], [10, 12]])
    hill = np.array([[13.02, 0], [26, 0], [26, 6.81], [13.02, 2.916]])
    scene = [box(10, 0, 13, 5), hill]
    for shift in np.linspace(0.0, 9.0, 181):
        smallest = 2.9 + shift / 200.0
        limits = WedgeLimits(smallest_px=smallest, largest_px=4.0, margin=0.45)
        wedge = wedge_for(
            moved(stone, shift), no_polygons().added(moved(p, shift) for p in scene), limits, 1
        )
        assert wedge is not None
        assert np.ptp(wedge[:, 0]) == pytest.approx(smallest)
        assert wedge[:, 0].max() == pytest.approx(24.0 + shift)


def test_bends_do_not_end_a_wedge_but_steps_do() -> None:
    bent = np.array([[10, 2.01], [15.5, 2.01], [16, 2.03], [16.5, 2.01], [17, 2.03], [20, 2.01],
                     [20, 4], [10, 4]])  # fmt: skip
    wedge = wedge_for(bent, SCENE)
    assert wedge is not None
    assert np.ptp(wedge[:, 0]) >= np.ptp(wedge[:, 1])
    wedge = wedge_for(PLANK, SCENE.added([box(17, 0.01, 25, 0.8)]))
    assert wedge is not None
    assert wedge[:, 0].max() == pytest.approx(16.99)


def test_too_low_or_too_high_a_gap_takes_no_wedge() -> None:
    for smallest, largest in ((0.5, 1.98), (2.0, 6.0)):
        limits = WedgeLimits(smallest_px=smallest, largest_px=largest)
        assert wedge_for(PLANK, SCENE, limits) is None
    limits = WedgeLimits(smallest_px=1.98, largest_px=2.0)
    assert wedge_for(PLANK, SCENE, limits) is not None


def test_where_the_gap_is_too_narrow_there_is_no_wedge() -> None:
    """From the centre of mass to the end of the stone, and as far as the next wall inwards."""
    stone = box(10.0, 2.01, 15.2, 4.0)
    scene = no_polygons().added([box(10, 0, 12.4, 2)])
    assert wedge_for(stone, scene, WedgeLimits(smallest_px=2.0, largest_px=3.0)) is None
    scene = no_polygons().added([box(10, 0, 12.4, 2), box(14, 0, 15, 1.9)])
    assert wedge_for(stone, scene, WedgeLimits(smallest_px=1.7, largest_px=3.0)) is None
    assert wedge_for(stone, scene, WedgeLimits(smallest_px=1.5, largest_px=3.0)) is not None


@pytest.mark.parametrize("above", [False, True])
def test_no_face_is_steeper_than_friction_holds(above: bool) -> None:
    """The floor or the lid rises to the right, with a slope of .5."""
    ramp = np.array([[14.0, 0.0], [26.0, 0.0], [26.0, 6.0]])
    stone = box(10.0, 8.01, 24.0, 12.0)
    scene = no_polygons().added([box(10, 0, 13, 8), ramp])
    if above:
        stone = np.array([[10, 4.01], [13, 4.01], [23, 9.01], [23, 12], [10, 12]])
        scene = no_polygons().added([box(10, 0, 13, 4)])
    mild, slippery = (WedgeLimits(smallest_px=1.0, largest_px=8.0, mu=mu) for mu in (0.51, 0.49))
    assert wedge_for(stone, scene, mild, 1) is not None
    assert wedge_for(stone, scene, slippery, 1) is None


def test_the_slope_of_a_face_is_that_from_end_to_end() -> None:
    """It rests on the level part of the floor, but the load would push it down the other."""
    bank = np.array([[14.02, 0.0], [24.0, 0.0], [24.0, 3.0], [19.0, 3.0], [14.02, 0.5]])
    scene = no_polygons().added([box(9, 0, 14, 10), bank])
    mild, slippery = (WedgeLimits(smallest_px=6.0, largest_px=10.0, mu=mu) for mu in (0.45, 0.2))
    assert wedge_for(box(9.0, 10.01, 22.02, 13.0), scene, mild, 1) is not None
    assert wedge_for(box(9.0, 10.01, 22.02, 13.0), scene, slippery, 1) is None


def test_a_wide_place_further_out_is_better_than_a_narrow_one() -> None:
    """Right of the post a slot narrower than high, then a ledge, then more room."""
    limits = WedgeLimits(smallest_px=0.3, largest_px=6.0, margin=0.03)
    scene = SCENE.added([box(15.5, 0.01, 16.5, 1.9)])
    wedge = wedge_for(PLANK, scene, limits)
    assert wedge is not None
    assert wedge[:, 0].min() == pytest.approx(16.51)
    wedge = wedge_for(PLANK, scene.added([box(17.5, 0.01, 20, 1.9)]), limits)
    assert wedge is not None
    assert [wedge[:, 0].min(), wedge[:, 0].max()] == pytest.approx([14.01, 15.49])


def test_a_stone_that_rests_or_touches_nothing_needs_no_wedge() -> None:
    assert falling_side(box(10.0, 2.01, 17.0, 4.0), 13.5, SCENE, LIMITS) == 0
    assert wedge_for(box(10.0, 2.01, 17.0, 4.0), SCENE) is None
    assert falling_side(moved(PLANK, 0.0, 0.2), 15.0, SCENE, LIMITS) == 0
    assert wedge_for(moved(PLANK, 0.0, 0.2), SCENE) is None


def test_to_which_side_a_stone_falls() -> None:
    margin = WedgeLimits(smallest_px=0.5, largest_px=6.0, margin=0.1)
    assert [falling_side(PLANK, x, SCENE, LIMITS) for x in (10.9, 11.1, 13.9, 14.1)] == [
        -1,
        0,
        0,
        1,
    ]
    assert [falling_side(PLANK, x, SCENE, margin) for x in (11.9, 12.1, 12.9, 13.1)] == [
        -1,
        0,
        0,
        1,
    ]
    # Up to the contact tolerance, measured at a right angle to a face.
    assert falling_side(moved(PLANK, 0.0, 0.089), 15.0, SCENE, LIMITS) == 1
    assert falling_side(moved(PLANK, 0.0, 0.091), 15.0, SCENE, LIMITS) == 0
    roof = no_polygons().added([np.array([[10.0, 0.0], [20.0, 0.0], [15.0, 5.0]])])
    leaning = np.array([[12.0, 2.13], [13.0, 8.0], [11.0, 8.0]])
    assert falling_side(leaning, 11.9, roof, LIMITS) == -1
    assert falling_side(moved(leaning, 0.0, 0.02), 11.9, roof, LIMITS) == 0


def test_a_wedge_must_rest_and_hold_the_stone() -> None:
    stone = PLANK, centroid(PLANK)
    good, near_post = box(16, 0.01, 18, 2), box(14.02, 0.01, 14.5, 2)
    assert _holds(good, stone, SCENE, WIDTH, LIMITS)
    assert not _holds(near_post, stone, SCENE, WIDTH, LIMITS)
    # It hangs in the air; it stands on one corner.
    assert not _holds(box(16, 1, 18, 2), stone, SCENE, WIDTH, LIMITS)
    tipping = np.array([[16.0, 0.01], [18.0, 2.0], [15.9, 2.0]])
    assert not _holds(tipping, stone, SCENE, WIDTH, LIMITS)


def test_the_margin_that_the_stone_keeps_is_asked_for() -> None:
    """The plank lifts off when gravity leans to the left by more than (15 - 11) / 1."""
    strict = WedgeLimits(smallest_px=0.5, largest_px=6.0, rest=0.99)
    assert wedge_for(PLANK, SCENE, strict) is not None
    impossible = WedgeLimits(smallest_px=0.5, largest_px=6.0, rest=1.01)
    assert wedge_for(PLANK, SCENE, impossible) is None


@repeatable(250)
@given(piles(), st.sampled_from([0.0, 0.1]))
def test_wedges_touch_hold_and_overlap_nothing(
    pile: tuple[Points, Polygons], margin: float
) -> None:
    stone, around = pile
    limits = WedgeLimits(smallest_px=0.4, largest_px=5.0, margin=margin)
    side = falling_side(stone, centroid(stone)[0], around, limits)
    wedge = wedge_for(stone, around, limits)
    if wedge is None:
        return
    shape, held = shapely.Polygon(wedge), shapely.Polygon(stone)
    others = [shapely.Polygon(around.polygon(i)) for i in range(len(around))]
    below = shapely.union_all([shapely.box(-99, -9, 199, 0), *others])
    assert shape.is_valid
    assert shapely.LinearRing(wedge).is_ccw
    for body in (held, below):
        assert shape.intersection(body).area == 0.0
        assert limits.clearance_px / 2 <= shape.distance(body) <= 2 * limits.clearance_px
    left, low, right, high = shape.bounds
    assert right - left >= limits.smallest_px - 1e-9
    assert high - low <= limits.largest_px + 1e-9
    heights = [_height(shape, x) for x in np.linspace(left, right, 23)[1:-1]]
    assert min(heights) >= limits.smallest_px - 1e-9
    # It brings the centre of mass inside the support.
    wanted = limits.margin * float(np.ptp(stone[:, 0]))
    outer = right if side > 0 else left
    assert side * (outer - centroid(stone)[0]) >= wanted - 1e-9
    mu, tolerance = limits.mu, limits.contact_px
    assert rest_margin(wedge, centroid(wedge), around, WIDTH, mu, tolerance) >= 0.0
    with_it = around.added([wedge])
    assert rest_margin(stone, centroid(stone), with_it, WIDTH, mu, tolerance) >= 0.0


def _height(shape: shapely.Polygon, x: float) -> float:
    low, high = shapely.LineString([(x, -99.0), (x, 199.0)]).intersection(shape).bounds[1::2]
    return float(high - low)


@repeatable(150)
@given(piles(), st.sampled_from([-1, 1]))
def test_a_mirrored_scene_gives_the_mirrored_wedge(
    pile: tuple[Points, Polygons], falls: int
) -> None:
    stone, around = pile
    one = wedge_for(stone, around, falls=falls)
    other = wedge_for(mirrored_polygon(stone, WIDTH), around.mirrored(WIDTH), falls=-falls)
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert mirrored_polygon(other, WIDTH) == pytest.approx(one, abs=1e-9)


@repeatable(60)
@given(piles(), st.lists(st.floats(0.001, 0.999), min_size=8, max_size=8))
def test_parts_are_where_upright_lines_are_as_long_as_a_wedge(
    pile: tuple[Points, Polygons], shares: list[float]
) -> None:
    stone, around = pile
    left, right = float(stone[:, 0].min()), float(stone[:, 0].max())
    found = parts(Slabs.of(crevice(stone, around, 0.0)), LIMITS)
    corners = np.concatenate([stone, around.corners])[:, 0]
    for x in (left + share * (right - left) for share in shares):
        if np.abs(corners - x).min() > 1e-6:
            floor, lid = gap_at(stone, around, x)
            room = min(lid - floor - LIMITS.smallest_px, LIMITS.largest_px - (lid - floor))
            if abs(room) > 1e-6:
                assert (room > 0.0) == any(start <= x <= stop for start, stop in found)


def test_limits_are_checked() -> None:
    good = {"smallest_px": 1.0, "largest_px": 2.0}
    WedgeLimits(**good)
    bad = [
        {"smallest_px": 0.0}, {"largest_px": 0.9}, {"margin": -0.1}, {"margin": 0.5}, {"mu": 0.0},
        {"clearance_px": 0.0}, {"clearance_px": 0.06},
    ]  # fmt: skip
    for change in bad:
        with pytest.raises(ValueError, match="must"):
            WedgeLimits(**{**good, **change})


@repeatable()
@given(piles(), st.data())
def test_polygons_in_order_are_those_added_in_order(
    pile: tuple[Points, Polygons], data: st.DataObject
) -> None:
    stone, around = pile
    wall = around.added([stone])
    chosen = data.draw(st.lists(st.sampled_from(range(len(wall))), unique=True))
    found = in_order(wall, chosen)
    expected = no_polygons().added([wall.polygon(i) for i in chosen])
    for one, other in zip(
        (found.corners, found.first, found.boxes, found.edges),
        (expected.corners, expected.first, expected.boxes, expected.edges),
        strict=True,
    ):
        assert one.dtype == other.dtype
        assert one.tolist() == other.tolist()
        assert one.flags.c_contiguous


def test_a_stone_meets_what_is_beside_it_and_so_far_below_as_a_wedge_is_high() -> None:
    stone = box(10.0, 20.0, 20.0, 24.0)
    reach = LIMITS.contact_px + 4.0 * LIMITS.clearance_px
    deep = 20.0 - reach - LIMITS.largest_px
    around = [
        stone,
        box(10.0, deep - 2.0, 20.0, deep + 0.01),
        box(10.0, deep - 2.0, 20.0, deep - 0.01),
        box(20.01 - reach, 20.0, 20.0, 24.0),
        box(5.0, 20.0, 10.01 - reach, 24.0),
        box(5.0, 20.0, 9.99 - reach, 24.0),
        box(19.99 + reach, 20.0, 25.0, 24.0),
        box(20.01 + reach, 20.0, 25.0, 24.0),
        box(10.0, 23.99 + reach, 20.0, 30.0),
        box(10.0, 24.01 + reach, 20.0, 30.0),
    ]
    wall = no_polygons().added(around)
    met = met_below(stone, wall.boxes, LIMITS)
    assert np.flatnonzero(met).tolist() == [0, 1, 3, 4, 6, 8]
    near = _near(stone, wall, LIMITS, 0)
    assert near.boxes.tolist() == wall.boxes[[1, 3, 4, 6, 8]].tolist()
    assert len(_near(stone, wall, LIMITS)) == 6
