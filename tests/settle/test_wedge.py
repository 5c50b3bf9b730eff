"""Wedges under stones that would fall: drawn by hand, and on random piles."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.crevice import crevice
from drystone.kernels.polygons import (
    area_and_centroid,
    mirrored_polygon,
    no_polygons,
)
from drystone.kernels.settling import rest_margin
from drystone.settle.wedge import (
    CreviceSlabs,
    WedgeLimits,
    _near,
    falling_side,
    met_below,
    parts,
    squeezed_out,
    wedge_under,
)
from tests.naive.crevice import gap_at
from tests.naive.wedge_shape import covered, objections
from tests.polygons import box, moved
from tests.settle.piles import WIDTH, piles
from tests.strategies import repeatable

LIMITS = WedgeLimits(least_thickness=0.5, greatest_height=6.0)
SIZES = 0.4, 4.0, 12.0, 0.5
STRICT = WedgeLimits(
    least_thickness=SIZES[0], greatest_height=SIZES[1], greatest_area=SIZES[2], mu=SIZES[3],
    room_px=20.0,
)  # fmt: skip
"""Least thickness, greatest height, greatest area, friction; all of them matter in piles."""


def centroid(polygon):
    return area_and_centroid(polygon)[1:]


def wedge_for(stone, around, limits=LIMITS):
    return wedge_under(stone, centroid(stone), around, WIDTH, limits)


POST = box(11.0, 0.01, 14.0, 2.0)
PLANK = box(10.0, 2.01, 20.0, 4.0)
"""On the post; its centre of mass is at x = 15, one to the right of the post."""
SCENE = no_polygons().added([POST])


@pytest.mark.parametrize(("margin", "left"), [(0.0, 15.0), (0.2, 17.0), (0.4, 20.0 - 1.25 * 1.99)])
def test_the_gap_beside_a_post_is_filled_from_the_centre_of_mass_and_the_margin_on(margin, left):
    """1.25 times as wide as high; at the end of the stone it grows inwards."""
    wedge = wedge_for(PLANK, SCENE, replace(LIMITS, margin=margin))
    right = left + 1.25 * 1.99
    expected = [[left, 0.01], [right, 0.01], [right, 2.0], [left, 2.0]]
    assert wedge == pytest.approx(np.array(expected))


def test_at_the_end_of_the_stone_it_is_still_as_wide_as_the_narrowest():
    """Floor and lid rise side by side; rounding takes nothing off the end."""
    stone = np.array([[10, 5.01], [24, 9.21], [24, 12], [10, 12]])
    hill = np.array([[13.02, 0], [26, 0], [26, 8.61], [13.02, 4.716]])
    scene = [box(10, 0, 13, 5), hill]
    for shift in np.linspace(0.0, 9.0, 181):
        least = 1.0 + shift / 100.0
        limits = WedgeLimits(least_thickness=least, greatest_height=4.0, margin=0.45)
        wedge = wedge_for(
            moved(stone, shift), no_polygons().added(moved(p, shift) for p in scene), limits
        )
        assert np.ptp(wedge[:, 0]) == pytest.approx(3.0 * least)
        assert wedge[:, 0].max() == pytest.approx(24.0 + shift)


def test_bends_do_not_end_a_wedge_but_steps_do():
    bent = np.array([[10, 2.01], [15.5, 2.01], [16, 2.03], [16.5, 2.01], [17, 2.03], [20, 2.01],
                     [20, 4], [10, 4]])  # fmt: skip
    wedge = wedge_for(bent, SCENE)
    assert np.ptp(wedge[:, 0]) >= np.ptp(wedge[:, 1])
    wedge = wedge_for(PLANK, SCENE.added([box(17, 0.01, 25, 0.8)]))
    assert wedge[:, 0].max() == pytest.approx(16.99)


def test_where_the_gap_is_too_narrow_there_is_no_wedge():
    """From the centre of mass to the end of the stone, and as far as the next wall inwards."""
    stone = box(10.0, 2.01, 15.2, 4.0)
    scene = no_polygons().added([box(10, 0, 12.4, 2), box(12.4, 0, 16, 1.5)])
    wide, narrow = (
        WedgeLimits(least_thickness=least, greatest_height=3.0) for least in (0.45, 0.4)
    )
    assert wedge_for(stone, scene, wide) is not None
    # A slot of 1.27 px is left: three times as wide as the second is thick at least.
    scene = scene.added([box(13.7, 1.5, 15, 1.9)])
    assert wedge_for(stone, scene, wide) is None
    assert wedge_for(stone, scene, narrow) is not None


@pytest.mark.parametrize("above", [False, True])
def test_no_face_is_steeper_than_friction_holds(above):
    """The floor or the lid rises to the right, with a slope of .5."""
    ramp = np.array([[14.0, 0.0], [26.0, 0.0], [26.0, 6.0]])
    stone = box(10.0, 8.01, 24.0, 12.0)
    scene = no_polygons().added([box(10, 0, 13, 8), ramp])
    if above:
        stone = np.array([[10, 4.01], [13, 4.01], [23, 9.01], [23, 12], [10, 12]])
        scene = no_polygons().added([box(10, 0, 13, 4)])
    mild, slippery = (
        WedgeLimits(least_thickness=1.0, greatest_height=8.0, mu=mu) for mu in (0.51, 0.49)
    )
    assert wedge_for(stone, scene, mild) is not None
    assert wedge_for(stone, scene, slippery) is None


def test_a_wedge_at_the_end_of_the_wall_has_something_beside_it():
    """Or there is room for a stone between the one on it and the end of the wall."""

    def found(right, *beside):
        stone, *others = (moved(one, right - 20.0) for one in (PLANK, POST, *beside))
        around = no_polygons().added(others)
        return wedge_for(stone, around, replace(LIMITS, room_px=8.0)) is not None

    assert found(WIDTH - 8.0)
    assert not found(WIDTH - 7.9)
    # A block beside the wedge, half as high, below or behind the end of the plank.
    assert found(WIDTH - 2.0, box(18.5, 0.01, 20.5, 1.01))
    assert found(WIDTH - 2.0, box(20.5, 0.01, 21.5, 1.01))
    assert not found(WIDTH - 2.0, box(20.5, 0.01, 21.5, 0.99))


def test_what_is_under_the_stone_itself_covers_its_wedge():
    hook = np.array([[10, 2.01], [18.5, 2.01], [18.5, 1.0], [20, 1.0], [20, 4], [10, 4]])
    limits = replace(LIMITS, room_px=WIDTH)
    wedge = box(15.0, 0.01, 17.5, 2.0)
    beside = SCENE.added([wedge])
    assert squeezed_out(wedge, PLANK, beside, WIDTH, limits)
    assert not squeezed_out(wedge, hook, beside, WIDTH, limits)


def test_a_stone_that_rests_or_touches_nothing_has_no_wedge():
    assert wedge_for(box(10.0, 2.01, 17.0, 4.0), SCENE) is None
    assert wedge_for(moved(PLANK, 0.0, 0.2), SCENE) is None
    # A gap that is too low or too high takes none.
    for smallest, largest, found in ((0.5, 1.98, False), (2.0, 6.0, False), (1.98, 2.0, True)):
        limits = WedgeLimits(least_thickness=smallest, greatest_height=largest)
        assert (wedge_for(PLANK, SCENE, limits) is not None) == found


def test_to_which_side_a_stone_falls():
    for margin, centres in ((0.0, (10.9, 11.1, 13.9, 14.1)), (0.1, (11.9, 12.1, 12.9, 13.1))):
        limits = replace(LIMITS, margin=margin)
        assert [falling_side(PLANK, x, SCENE, limits) for x in centres] == [-1, 0, 0, 1]
    # Up to the contact tolerance, measured at a right angle to a face.
    assert falling_side(moved(PLANK, 0.0, 0.089), 15.0, SCENE, LIMITS) == 1
    assert falling_side(moved(PLANK, 0.0, 0.091), 15.0, SCENE, LIMITS) == 0
    roof = no_polygons().added([np.array([[10.0, 0.0], [20.0, 0.0], [15.0, 5.0]])])
    leaning = np.array([[12.0, 2.13], [13.0, 8.0], [11.0, 8.0]])
    assert falling_side(leaning, 11.9, roof, LIMITS) == -1
    assert falling_side(moved(leaning, 0.0, 0.02), 11.9, roof, LIMITS) == 0


def test_the_margin_that_the_stone_keeps_is_asked_for():
    """The plank lifts off when gravity leans to the left by more than (15 - 11) / 1."""
    assert wedge_for(PLANK, SCENE, replace(LIMITS, rest=0.99)) is not None
    assert wedge_for(PLANK, SCENE, replace(LIMITS, rest=1.01)) is None


@repeatable(120)
@given(piles(), st.sampled_from([0.0, 0.1]))
def test_wedges_touch_hold_and_overlap_nothing(pile, margin):
    stone, around = pile
    limits = replace(STRICT, margin=margin)
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
    assert max(objections(wedge, *SIZES).values()) <= 1e-6
    assert stays_in(wedge, stone, others, limits.room_px)
    # It brings the centre of mass inside the support.
    wanted = limits.margin * float(np.ptp(stone[:, 0]))
    outer = wedge[:, 0].max() if side > 0 else wedge[:, 0].min()
    assert side * (outer - centroid(stone)[0]) >= wanted - 1e-9
    mu, tolerance = limits.mu, limits.contact_px
    assert rest_margin(wedge, centroid(wedge), around, WIDTH, mu, tolerance) >= 0.0
    with_it = around.added([wedge])
    assert rest_margin(stone, centroid(stone), with_it, WIDTH, mu, tolerance) >= 0.0


def stays_in(wedge, stone, others, room):
    """Whether something is beside a wedge on each side, or room for a stone; rows may be few."""
    shapes = [np.array(other.exterior.coords[:-1]) for other in (*others, shapely.Polygon(stone))]
    left, right = covered(wedge, shapes)
    return (left >= 0.48 or stone[:, 0].min() >= room - 1e-4) and (
        right >= 0.48 or stone[:, 0].max() <= WIDTH - room + 1e-4
    )


@repeatable(80)
@given(piles(), st.sampled_from([LIMITS, STRICT]))
def test_a_mirrored_scene_gives_the_mirrored_wedge(pile, limits):
    stone, around = pile
    one = wedge_for(stone, around, limits)
    other = wedge_for(mirrored_polygon(stone, WIDTH), around.mirrored(WIDTH), limits)
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert mirrored_polygon(other, WIDTH) == pytest.approx(one, abs=1e-9)


@repeatable(60)
@given(piles(), st.lists(st.floats(0.001, 0.999), min_size=8, max_size=8))
def test_parts_are_where_upright_lines_are_as_long_as_a_wedge(pile, shares):
    stone, around = pile
    left, right = float(stone[:, 0].min()), float(stone[:, 0].max())
    found = parts(CreviceSlabs.of(crevice(stone, around, 0.0)), LIMITS)
    corners = np.concatenate([stone, around.corners])[:, 0]
    for x in (left + share * (right - left) for share in shares):
        if np.abs(corners - x).min() > 1e-6:
            floor, lid = gap_at(stone, around, x)
            room = min(lid - floor - LIMITS.least_thickness, LIMITS.greatest_height - (lid - floor))
            if abs(room) > 1e-6:
                assert (room > 0.0) == any(start <= x <= stop for start, stop in found)


def test_a_stone_meets_what_is_beside_it_and_so_far_below_as_a_wedge_is_high():
    stone = box(10.0, 20.0, 20.0, 24.0)
    reach = LIMITS.contact_px + 4.0 * LIMITS.clearance_px
    deep = 20.0 - reach - LIMITS.greatest_height
    around = [stone]
    for more in (0.01, -0.01):  # that they reach into what is met
        around.append(box(10.0, deep - 2.0, 20.0, deep + more))
        around.append(box(5.0, 20.0, 10.0 - reach + more, 24.0))
        around.append(box(20.0 + reach - more, 20.0, 25.0, 24.0))
        around.append(box(10.0, 24.0 + reach - more, 20.0, 30.0))
    wall = no_polygons().added(around)
    met = met_below(stone, wall.boxes, LIMITS)
    assert np.flatnonzero(met).tolist() == [0, 1, 2, 3, 4]
    assert _near(stone, wall, LIMITS, 0).boxes.tolist() == wall.boxes[1:5].tolist()
    assert len(_near(stone, wall, LIMITS)) == 5
