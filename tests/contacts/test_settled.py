"""Models of settled stones: closed forms, walls with gaps, and contacts that are set back."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry.polygon import orient

from drystone.contacts.given import model_from_json
from drystone.contacts.outlines import model_of_traced
from drystone.contacts.settled import PlacedPolygons, model_of_outlines, model_with_outlines
from drystone.kernels.polygons import area_and_centroid
from drystone.kernels.raster import turn
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Block, Interface, RigidBlockModel
from drystone_lab.pixels import tilted_wall
from tests.polygons import box_of, moved
from tests.strategies import repeatable

MU = 0.58


def model_of(*polygons, mu=MU, tolerance=0.1, setback=0.0):
    placed = PlacedPolygons.of(enumerate(polygons, start=1))
    return model_of_outlines(placed, mu, tolerance, setback)


def alphas(model):
    found = lateral_resistance(model)
    return found.left.alpha, found.right.alpha


def settled_wall(seed, loose, lean):
    """A wall 200 high of polygons with gaps of about .01, moved and turned a little."""
    rng = np.random.default_rng(seed)
    placed = []
    for polygon in tilted_wall(rng, courses=3).polygons:
        smaller = shapely.Polygon(polygon * 200.0).buffer(
            -0.005, join_style="mitre", mitre_limit=20.0
        )
        corners = shapely.get_coordinates(orient(smaller))[:-1]
        _, x, y = area_and_centroid(corners)
        turned = turn(corners - np.array([x, y]), np.degrees(rng.uniform(-lean, lean)))
        placed.append(turned + np.array([x, y + loose]) + rng.uniform(-loose, loose, 2))
    return placed


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.099])
def test_a_block_tilts_about_its_toe_whatever_the_gap(gap):
    """min(mu, b / h)."""
    assert alphas(model_of(box_of(0, gap, 20, 40))) == pytest.approx((0.5, 0.5), abs=1e-8)
    assert alphas(model_of(box_of(0, gap, 40, 20))) == pytest.approx((MU, MU), abs=1e-8)


WALLS = {
    "a quarter over": [[0, 0, 40, 20], [10, 20, 40, 20]],
    "running bond": [[0, 0, 40, 20], [40, 0, 40, 20], [20, 20, 40, 20], [60, 20, 20, 20]],
    "four joints meet": [[0, 0, 40, 20], [40, 0, 40, 20], [0, 20, 40, 20], [40, 20, 40, 20]],
    "lintel on two posts": [[0, 0, 20, 60], [80, 0, 20, 60], [0, 60, 100, 10]],
}


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.parametrize("mu", [0.3, 0.58, 0.9])
def test_walls_of_boxes_are_as_strong_as_without_gaps(name, mu):
    boxes = WALLS[name]
    exact = alphas(model_from_json({"blocks_xywh": boxes, "mu": mu}))
    # Every box keeps .01 from the left, and what is below.
    level = {y: k + 1 for k, y in enumerate(sorted({y for _, y, _, _ in boxes}))}
    placed = [box_of(x + 0.01 * (x // 20), y + 0.01 * level[y], w, h) for x, y, w, h in boxes]
    assert alphas(model_of(*placed, mu=mu)) == pytest.approx(exact, abs=2e-3)


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.09])
def test_a_corbel_inside_and_outside_of_its_limit(gap):
    base = box_of(0, 0.01, 40, 20)
    for left, stands in ((19.99, True), (20.01, False)):
        wall = model_of(base, box_of(left, 20.01 + gap, 40, 5))
        assert lateral_resistance(wall).stable == stands


def test_a_square_in_a_notch_slides_out_over_a_face():
    """The faces lean by 45 degrees: alpha = tan(45 degrees + friction angle)."""
    notch = np.array([[-40.0, 0.0], [40.0, 0.0], [40.0, 80.0], [0.0, 40.0], [-40.0, 80.0]])
    square = moved(turn(box_of(0, 0, 20, 20), 45.0), 0.0, 40.0142)
    model = model_of(notch, square)
    fixed = replace(model, blocks=(replace(model.blocks[0], fixed=True), model.blocks[1]))
    expected = (1 + MU) / (1 - MU)
    assert alphas(fixed) == pytest.approx((expected, expected), abs=1e-5)


@pytest.mark.parametrize("seed", range(2))
def test_settled_walls_are_as_strong_as_those_without_gaps(seed):
    exact = alphas(tilted_wall(np.random.default_rng(seed), courses=3).model())
    for loose, lean in ((0.0, 0.0), (0.02, 1e-4)):
        placed = settled_wall(seed, loose, lean)
        assert alphas(model_of(*placed)) == pytest.approx(exact, abs=1e-3)
        closed = {i: np.vstack([c, c[:1]]) for i, c in enumerate(placed, start=1)}
        others = model_of_traced(closed, MU)
        assert alphas(model_of(*placed)) == pytest.approx(alphas(others), abs=1e-3)


def test_blocks_and_interfaces_do_not_depend_on_how_they_are_added():
    placed = settled_wall(2, 0.01, 1e-5)
    whole = model_of(*placed)
    ids = list(range(1, len(placed) + 1))
    grown = RigidBlockModel((), (), MU)
    for place in range(0, len(placed), 2):  # a stone and its wedge at a time
        around = PlacedPolygons.of(list(zip(ids, placed, strict=True))[:place])
        blocks = list(zip(ids, placed, strict=True))[place : place + 2]
        grown = model_with_outlines(grown, blocks, around, 0.1, 0.0)
    assert grown.blocks == whole.blocks
    assert told(grown) == told(whole)
    assert all(i.block > i.other for i in whole.interfaces)


def told(model):
    return [(i.block, i.other, i.points.tolist(), i.normal) for i in model.interfaces]


def test_ids_need_not_ascend():
    placed = PlacedPolygons.of([(7, box_of(0, 0.01, 4, 2)), (3, box_of(2, 2.02, 4, 2))])
    model = model_of_outlines(placed)
    assert [(i.block, i.other) for i in model.interfaces] == [(7, 0), (3, 7)]
    assert model.interfaces[1].normal == (0.0, 1.0)


# Contacts that stay away from the ends of faces (DESIGN 4.8): laps, corners, and a slow twin.

TOLERANCE, CLEARANCE = 0.1, 0.01


def set_back(polygons, setback=0.01):
    return model_of(*polygons, setback=setback)


def strength(polygons, setback=0.01):
    """F_LR; 0 where the wall falls by itself."""
    found = lateral_resistance(set_back(polygons, setback))
    assert not found.failed
    return found.value or 0.0


def bricks(width, height, count, courses, gap, lap):
    """Bricks whose courses are moved to and fro by half a lap; `gap` is that of all joints."""
    return [
        box_of(
            column * (width + gap) + (0.5 if course % 2 else -0.5) * lap,
            gap + course * (height + gap),
            width,
            height,
        )
        for course in range(courses)
        for column in range(count)
    ]


FAMILIES = [(40.0, 20.0, 6, 5), (30.0, 30.0, 3, 4), (60.0, 20.0, 2, 9)]


@pytest.mark.parametrize(("family", "small"), [*zip(FAMILIES, (0.01, 0.05, 0.02), strict=True)])
def test_gaps_and_laps_that_go_to_zero_change_nothing(family, small):
    """A corner over a corner at the crossing of four joints carries no more than an open joint."""
    whole = strength(bricks(*family, 0.0, 0.0))
    for gap, lap in ((small, 0.0), (0.0, small), (small, small), (small, 2 * small)):
        assert strength(bricks(*family, gap, lap)) == pytest.approx(whole, rel=0.01)


@pytest.mark.parametrize("family", FAMILIES)
def test_columns_that_stand_apart_topple_one_by_one(family):
    """Set back by e on both sides, a column of width w and height H falls at (w - 2 e) / H."""
    width, height, _, courses = family
    back = max(TOLERANCE, 0.01 * np.sqrt(width * height))
    apart = [moved(brick, 0.5 * (brick[0, 0] // width)) for brick in bricks(*family, 0.0, 0.0)]
    expected = min(1.0, (width - 2.0 * back) / (courses * height) / MU)
    assert strength(apart) == pytest.approx(expected, rel=1e-6)


@given(st.floats(-5.0, 5.0), st.floats(0.0, 0.05), st.sampled_from([0.005, 0.01, 0.03]))
@repeatable(40)
def test_a_corner_that_stands_on_a_face_stays_however_it_leans(angle_deg, gap, setback):
    """From the whole face to its corner nothing vanishes as a brick leans."""
    base, brick = box_of(0, 0, 100, 20), turn(box_of(-15, 0, 30, 60), angle_deg)
    standing = moved(brick, 50.0, 20.0 + gap - brick[:, 1].min())
    assert any(face.other == 1 for face in set_back([base, standing], setback).interfaces)


@pytest.mark.parametrize("aside", [19.5, 19.9, 20.0, 20.05, 20.2])
def test_a_brick_on_the_last_of_an_edge_has_nothing_below(aside):
    wall = [box_of(0, 0.01, 40, 20), box_of(40 - aside / 100, 20.02, 40, 5)]
    faces = [face for face in set_back(wall).interfaces if face.block == 2]
    assert faces == []
    assert len(set_back(wall, 0.0).interfaces) > 1


def test_a_face_ends_where_the_outline_turns_away():
    """A brick with its corners cut off at 45 degrees bears on what is left of its bottom."""
    back = 0.01 * 799**0.5
    cut = np.array([[1.0, 20.02], [39, 20.02], [40, 21], [40, 40], [0, 40], [0, 21]])
    wall = set_back([box_of(-20, 0.01, 80, 20), cut])
    (face,) = (face for face in wall.interfaces if face.other == 1)
    assert sorted(face.points[:, 0]) == pytest.approx([1 + back, 39 - back], abs=2e-3)


def test_a_tip_in_an_inner_corner_has_stone_enough_behind_it():
    corner = np.array([[-20.0, 0], [60, 0], [60, 20], [0, 20], [0, 60], [-20, 60]])
    spike = np.array([[0.05, 20.02], [10.0, 50.0], [0.05, 50.0]])
    found = set_back([moved(corner, 0.0, 0.01), spike], 0.05).interfaces
    assert (0.0, 1.0) in [face.normal for face in found if face.block == 2]


def test_rounded_stones_keep_contacts_of_corner_on_corner():
    """An outline that turns by little at every corner has no end of a face there."""
    turns = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)
    disc = 20.0 * np.column_stack([np.cos(turns), np.sin(turns)])
    wall = [moved(disc, 0.0, up) for up in (20.01, 60.02)]
    assert [(face.block, face.other) for face in set_back(wall).interfaces] == [(1, GROUND), (2, 1)]


def naive_model(boxes, setback):
    """Slow twin for upright boxes: common intervals of their sides, cut at both ends."""
    blocks, interfaces = [], []
    ground = box_of(-1e4, -1e4, 2e4, 1e4)
    for number, corners in enumerate(boxes, start=1):
        area, x, y = area_and_centroid(corners)
        blocks.append(Block(number, area, (x, y)))
        for other, outline in enumerate([ground, *boxes[: number - 1]]):
            by = max(TOLERANCE, setback * min(area, area_and_centroid(outline)[0]) ** 0.5)
            for axis, normal in ((0, (0.0, 1.0)), (1, (1.0, 0.0))):
                low = max(corners[:, axis].min(), outline[:, axis].min())
                high = min(corners[:, axis].max(), outline[:, axis].max())
                for sign in (1.0, -1.0):  # which side of the box: its lower or left one first
                    mine = (sign * corners[:, 1 - axis]).min()
                    theirs = (sign * outline[:, 1 - axis]).max()
                    if abs(mine - theirs) > TOLERANCE or high - low <= 2 * by:
                        continue
                    points = np.full((2, 2), sign * mine)
                    points[:, axis] = low + by, high - by
                    toward = sign * normal[0], sign * normal[1]
                    interfaces.append(Interface(number, other, points, toward))
    return RigidBlockModel(tuple(blocks), tuple(interfaces), MU)


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.005, 0.01, 0.04]))
@repeatable(15)
def test_walls_of_boxes_are_those_of_the_slow_twin(seed, setback):
    rng = np.random.default_rng(seed)
    wall, bottom = [], CLEARANCE
    for _ in range(int(rng.integers(2, 5))):
        left, height = rng.choice([0.0, 1.0, 6.0]), rng.uniform(8.0, 20.0)
        while left < 90.0:
            width = rng.uniform(12.0, 40.0)
            wall.append(box_of(left, bottom, width, height))
            left += width + rng.choice([CLEARANCE, 0.05, 0.5])
        bottom += height + CLEARANCE
    found, twin = lateral_resistance(set_back(wall, setback)), naive_model(wall, setback)
    slow = lateral_resistance(twin)
    for one, other in ((found.left, slow.left), (found.right, slow.right)):
        assert one.status == other.status
        assert one.alpha is None or one.alpha == pytest.approx(other.alpha, abs=2e-3)


@given(st.integers(0, 2**32 - 1))
@repeatable(6)
def test_more_set_back_never_makes_a_wall_stronger(seed):
    rng = np.random.default_rng(seed)
    wall = [
        moved(turn(corners, rng.uniform(-0.02, 0.02)), *rng.uniform(-0.02, 0.02, 2))
        for corners in bricks(30.0, 15.0, 3, 4, 0.03, rng.uniform(0.0, 15.0))
    ]
    found = [strength(wall, setback) for setback in (0.0, 0.005, 0.01, 0.03, 0.1)]
    assert all(later <= earlier + 1e-6 for earlier, later in pairwise(found))
