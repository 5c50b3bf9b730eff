"""Wedges: under stones that would fall, anywhere under a stone, and stones let down onto one."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.crevice import crevice
from drystone.kernels.polygons import (
    GRID,
    area_and_centroid,
    mirrored_polygon,
    no_polygons,
    on_grid,
)
from drystone.kernels.settling import rest_margin
from drystone.settle.rest import SettlingScene, Turned
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import (
    CreviceSlabs,
    WedgeLimits,
    _near,
    all_spans,
    falling_side,
    gridded,
    met_below,
    parts,
    squeezed_out,
    wedge_under,
    wedged,
    wedges_below,
)
from tests.naive.crevice import gap_at
from tests.naive.wedge_shape import covered, objections
from tests.polygons import box, moved
from tests.settle.piles import WIDTH, piles
from tests.strategies import repeatable

LIMITS = WedgeLimits(least_thickness=0.5, greatest_height=6.0)
SIZES = {"least_thickness": 0.4, "greatest_height": 4.0, "greatest_area": 12.0, "mu": 0.5}
STRICT = WedgeLimits(**SIZES, room_px=20.0)
"""All of it matters in piles."""


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
    wide, narrow = (replace(LIMITS, least_thickness=least) for least in (0.45, 0.4))
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
    for mu, found in ((0.51, True), (0.49, False)):
        limits = WedgeLimits(least_thickness=1.0, greatest_height=8.0, mu=mu)
        assert (wedge_for(stone, scene, limits) is not None) == found


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
    # The plank lifts off when gravity leans to the left by more than (15 - 11) / 1.
    assert wedge_for(PLANK, SCENE, replace(LIMITS, rest=0.99)) is not None
    assert wedge_for(PLANK, SCENE, replace(LIMITS, rest=1.01)) is None


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


@repeatable(120)
@given(piles(), st.sampled_from([0.0, 0.1]))
def test_wedges_touch_hold_and_overlap_nothing(pile, margin):
    stone, around = pile
    limits = replace(STRICT, margin=margin)
    side = falling_side(stone, centroid(stone)[0], around, limits)
    wedge = wedge_for(stone, around, limits)
    if wedge is None:
        return
    others = [around.polygon(i) for i in range(len(around))]
    assert_fits(wedge, stone, others, 1e-6)
    beside = covered(wedge, [*others, stone])  # there, or there is room for a stone; rows are few
    ends = stone[:, 0].min(), WIDTH - stone[:, 0].max()
    assert all(
        share >= 0.48 or end >= STRICT.room_px - 1e-4
        for share, end in zip(beside, ends, strict=True)
    )
    # It brings the centre of mass inside the support.
    wanted = limits.margin * float(np.ptp(stone[:, 0]))
    outer = wedge[:, 0].max() if side > 0 else wedge[:, 0].min()
    assert side * (outer - centroid(stone)[0]) >= wanted - 1e-9
    mu, tolerance = limits.mu, limits.contact_px
    assert rest_margin(wedge, centroid(wedge), around, WIDTH, mu, tolerance) >= 0.0
    with_it = around.added([wedge])
    assert rest_margin(stone, centroid(stone), with_it, WIDTH, mu, tolerance) >= 0.0


def assert_fits(wedge, stone, others, slack):
    """A wedge is near to what is above and below it, overlaps nothing, and has a fit shape."""
    shape = shapely.Polygon(wedge)
    below = shapely.union_all([shapely.box(-99, -9, 199, 0), *map(shapely.Polygon, others)])
    assert shape.is_valid
    assert shapely.LinearRing(wedge).is_ccw
    for body in (shapely.Polygon(stone), below):
        assert STRICT.clearance_px / 2 <= shape.distance(body) <= 2 * STRICT.clearance_px
    assert max(objections(wedge, **SIZES).values()) <= slack


@repeatable(80)
@given(piles(), st.sampled_from([LIMITS, STRICT]))
def test_a_mirrored_scene_gives_the_mirrored_wedge(pile, limits):
    stone, around = pile
    one = wedge_for(stone, around, limits)
    other = wedge_for(mirrored_polygon(stone, WIDTH), around.mirrored(WIDTH), limits)
    assert (one is None) == (other is None)
    if one is not None and other is not None:
        assert mirrored_polygon(other, WIDTH) == pytest.approx(one, abs=1e-9)


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


def test_each_part_of_a_crevice_has_its_places_and_itself():
    """The stone is no obstacle to its own wedges."""
    limits = WedgeLimits(least_thickness=0.6, greatest_height=2.5)
    under = no_polygons().added([moved(POST, 2.0)])
    found = all_spans(CreviceSlabs.of(crevice(PLANK, under, limits.clearance_px)), limits)
    left = [span for span in found if span[1] < 13.0]
    right = [span for span in found if span[0] > 16.0]
    assert found == left + right
    assert (10.0, pytest.approx(12.99)) in left
    assert (pytest.approx(16.01), 20.0) in right
    # As wide as high where there is room, 1.25 times.
    widths = sorted(stop - start for start, stop in right)
    assert widths[0] == pytest.approx(1.25 * 1.99)
    assert max(widths) == pytest.approx(3.99)
    starts = sorted(start for start, _ in right)
    assert starts[0] == pytest.approx(16.01)
    assert starts[-1] == pytest.approx(20.0 - 1.25 * 1.99)
    assert len(set(found)) == len(found)
    wall = under.added([PLANK])
    wedges = list(wedges_below(wall, 1, limits))
    assert len(wedges) == len(found)
    assert {(float(w[:, 0].min()), float(w[:, 0].max())) for w in wedges} == {
        tuple(on_grid(np.array(span)).tolist()) for span in found
    }
    assert list(wedges_below(wall, 0, limits)) == []


def test_corners_that_the_grid_makes_one_are_one():
    tiny = 1e-7
    corners = np.array([[0, tiny], [0, 0], [2, 0], [2, tiny], [2, 2 * tiny], [2, 1], [0, 1]])
    assert gridded(corners).tolist() == [[0, 0], [2, 0], [2, 1], [0, 1]]


@given(piles())
def test_wedges_anywhere_fit_and_overlap_nothing(pile):
    stone, around = pile
    others = [around.polygon(i) for i in range(len(around))]
    for wedge in wedges_below(around.added([stone]), len(around), STRICT):
        assert_fits(wedge, stone, others, 1e-5)
        assert np.array_equal(on_grid(wedge), wedge)


FIRM = replace(LIMITS, rest=0.2, contact_px=0.05)


def lowered(side, start=(15.0, 6.0), limits=FIRM, others=(POST,)):
    """The plank let go as the side sees it, in a scene that it sees the same from either side."""
    around = no_polygons().added(others)
    around = around if side == "left" else around.mirrored(WIDTH)
    outline = PLANK - centroid(PLANK)
    scene = SettlingScene.of(around, WIDTH, side, 0.58)
    return wedged(Turned.of(outline, 0.0, side, 20.0**0.5), scene, start, SettleSettings(), limits)


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_free_side_gets_a_wedge_that_holds_the_stone(side):
    repose, wedge = lowered(side)
    settled = repose.settled
    assert area_and_centroid(wedge)[0] > 0.0
    assert (wedge * GRID == np.round(wedge * GRID)).all()
    assert (repose.angle_deg, repose.turned) == (0.0, False)
    corners, x = settled.corners, settled.x_px
    if side == "right":
        corners, wedge = (mirrored_polygon(one, WIDTH) for one in (corners, wedge))
        x = WIDTH - x
    assert (x, settled.y_px) == pytest.approx((15.0, 3.005), abs=1e-4)
    (left, low), (right, high) = wedge.min(axis=0), wedge.max(axis=0)
    assert left == pytest.approx(15.0, abs=1e-5)  # from the centre of mass on
    assert right - left == pytest.approx(1.25 * (high - low), abs=1e-4)
    assert (low, high) == pytest.approx((0.01, 2.0), abs=1e-4)
    here = corners, (x, settled.y_px)
    for wedges, firm in (([], False), ([wedge], True)):
        around = no_polygons().added([POST, *wedges])
        assert (rest_margin(*here, around, WIDTH, 0.58, 0.05) >= 0.2) == firm


@pytest.mark.parametrize("side", ["left", "right"])
def test_no_wedge_where_none_is_needed_or_none_fits_or_the_stone_slides_away(side):
    assert lowered(side, (12.5, 6.0)) is None  # it lies over its support
    low = replace(FIRM, greatest_height=1.9)
    assert lowered(side, limits=low) is None
    assert lowered(side, limits=replace(FIRM, rest=9.0)) is None
    roof = np.array([[5.0, 0.01], [25.0, 0.01], [15.0, 20.0]])
    assert lowered(side, (19.0, 25.0), others=(roof,)) is None
