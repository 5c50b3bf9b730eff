"""Models of outlines: traced in pictures, or of settled stones with gaps and set-back contacts."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from shapely.geometry.polygon import orient
from skimage import measure

from drystone.contacts.outlines import model_of_traced, outlines_of_labels
from drystone.contacts.settled import PlacedPolygons, model_of_outlines, model_with_outlines
from drystone.io.read_stones import read_stones
from drystone.kernels.polygons import area_and_centroid, no_polygons, turn
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Block, Interface, RigidBlockModel
from drystone_lab.pixels import exact_model, picture_of, tilted_wall
from tests.polygons import box_of, moved
from tests.statics.walls import alphas, irregular, told
from tests.strategies import repeatable


def test_areas_of_published_stones_are_those_of_their_pixels(data_dir):
    stones = read_stones(data_dir / "almeida" / "PR.png")
    labels = np.zeros((stones.source.height_px, stones.source.width_px), np.uint32)
    for stone in stones:
        height, width = stone.mask.shape
        rows = labels[labels.shape[0] - stone.bottom_px - height :][:height]
        rows[:, stone.left_px : stone.left_px + width][stone.mask] = stone.id
    outlines = outlines_of_labels(labels)
    assert set(outlines) == {stone.id for stone in stones}
    for stone in stones:
        assert area_and_centroid(outlines[stone.id])[0] == pytest.approx(stone.area_px, rel=1e-3)


def test_a_tilted_joint_is_one_edge_with_its_slope():
    row, col = np.mgrid[:60, :80]
    slope = np.tan(np.radians(7))
    outlines = outlines_of_labels(np.where(59.5 - row > 20.3 + slope * col, 2, 1))
    first, second = ({*pairwise(map(tuple, outlines[i].tolist()))} for i in (1, 2))
    (((x0, y0), (x1, y1)),) = first & {(b, a) for a, b in second}
    assert np.degrees(np.arctan((y1 - y0) / (x1 - x0))) == pytest.approx(7, abs=0.2)
    assert y0 + (40 - x0) * (y1 - y0) / (x1 - x0) == pytest.approx(20.3 + slope * 39.5, abs=0.1)


def test_a_stone_on_the_ground_has_a_flat_bed_to_its_toes():
    row, col = np.mgrid[:30, :60]
    y, x = 29.5 - row, col + 0.5
    labels = np.where((x > 5.2 + 0.3 * y) & (x < 54.7 - 0.2 * y), 1, 0)
    (bed,) = model_of_traced(outlines_of_labels(labels)).interfaces
    assert bed.points[:, 1] == pytest.approx([0, 0], abs=1e-3)
    assert bed.points[:, 0] == pytest.approx([5.2, 54.7], abs=0.3)


SMALL = [(irregular(seed, 40, 36, 24), n, 1.0) for seed, n in enumerate((299, 272, 341))]
LARGE = [(irregular(seed, 12, 90, 70), 72, 1e-6) for seed in range(2)]


@pytest.mark.parametrize(("labels", "corners", "gaps"), [*SMALL, *LARGE])
def test_neighbours_share_their_joints_though_small_stones_keep_pixel_edges(labels, corners, gaps):
    """No more of them than before: the corners of all are counted."""
    outlines = outlines_of_labels(labels)
    shapes = [shapely.Polygon(outline) for outline in outlines.values()]
    whole = shapely.union_all(shapes)
    assert shapely.area(shapes).sum() == pytest.approx(whole.area, abs=1e-6)
    assert shapely.Polygon(whole.exterior).area == pytest.approx(whole.area, abs=gaps)
    assert whole.area == pytest.approx(labels.size, abs=4)
    assert sum(map(len, outlines.values())) == corners


@pytest.mark.parametrize("shape", [(1, 1), (2, 2), (1, 9), (2, 20), (3, 5), (20, 4)])
def test_small_rectangles_are_exact_also_with_holes(shape):
    height, width = shape
    labels = np.pad(np.full(shape, 5), ((1, 1), (1, 2)))
    labels[2:-2, 2:-3] = 0
    (outline,) = outlines_of_labels(labels).values()
    assert shapely.Polygon(outline).equals(shapely.box(1, 1, 1 + width, 1 + height))


SIDES = st.integers(1, 8)


@given(arrays(np.uint32, st.tuples(SIDES, SIDES), elements=st.integers(0, 4)))
@repeatable(60)
def test_every_id_has_a_closed_outline_of_about_its_area(labels):
    outlines = outlines_of_labels(labels)
    assert set(outlines) == set(np.unique(labels[labels > 0]).tolist())
    for block, outline in outlines.items():
        assert outline[0].tolist() == outline[-1].tolist()
        assert np.abs(np.diff(outline, axis=0)).max(axis=1).min() > 0
        pieces = measure.label(labels == block, connectivity=1)
        largest = np.bincount(pieces.ravel())[1:].max()
        assert area_and_centroid(outline)[0] > largest / 2
    assert len(model_of_traced(outlines).blocks) == len(outlines)


def test_the_model_of_a_picture_has_the_load_multipliers_of_the_wall():
    wall = tilted_wall(np.random.default_rng(5), courses=3)
    model = model_of_traced(outlines_of_labels(picture_of(wall, 160, (0.3, 0.6))))
    exact = exact_model(wall)
    assert len(model.interfaces) == len(exact.interfaces)
    assert alphas(model) == pytest.approx(alphas(exact), abs=0.02)


def test_gaps_up_to_the_tolerance_are_contacts():
    square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    for gap, contacts in ((0.09, 1), (-0.09, 1), (0.11, 0)):
        model = model_of_traced({1: square, 2: square + np.array([1, 4 + gap])})
        among = [i for i in model.interfaces if i.other != GROUND]
        assert len(among) == contacts
    assert [(i.block, i.length) for i in model.interfaces] == [(1, 4.0)]
    assert model.blocks[0].centroid == (2, 2)


# Settled stones.

MU = 0.58


def model_of(*polygons, setback=0.0):
    return model_of_outlines(list(enumerate(polygons, start=1)), MU, 0.1, setback)


def settled_wall(seed, loose, lean):
    """A wall 200 high of polygons with gaps of about .01, moved and turned a little."""
    rng = np.random.default_rng(seed)
    placed = []
    for polygon in tilted_wall(rng, courses=3):
        whole = shapely.Polygon(polygon * 200.0)
        smaller = orient(whole.buffer(-0.005, join_style="mitre", mitre_limit=20.0))
        corners = shapely.get_coordinates(smaller)[:-1]
        centroid = np.array(area_and_centroid(corners)[1:])
        turned = turn(corners - centroid, np.degrees(rng.uniform(-lean, lean))) + centroid
        placed.append(turned + np.array([0.0, loose]) + rng.uniform(-loose, loose, 2))
    return placed


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.099])
def test_a_block_tilts_about_its_toe_whatever_the_gap(gap):
    """min(mu, b / h)."""
    assert alphas(model_of(box_of(0, gap, 20, 40))) == pytest.approx((0.5, 0.5), abs=1e-8)
    assert alphas(model_of(box_of(0, gap, 40, 20))) == pytest.approx((MU, MU), abs=1e-8)


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
    exact = alphas(exact_model(tilted_wall(np.random.default_rng(seed), courses=3)))
    for loose, lean in ((0.0, 0.0), (0.02, 1e-4)):
        placed = settled_wall(seed, loose, lean)
        assert alphas(model_of(*placed)) == pytest.approx(exact, abs=1e-3)
        closed = {i: np.vstack([c, c[:1]]) for i, c in enumerate(placed, start=1)}
        assert alphas(model_of_traced(closed, MU)) == pytest.approx(exact, abs=1e-3)


def test_blocks_and_interfaces_do_not_depend_on_how_they_are_added():
    placed = settled_wall(2, 0.01, 1e-5)
    ids = list(range(len(placed), 0, -1))
    listed = list(zip(ids, placed, strict=True))
    whole = model_of_outlines(listed, MU, 0.1, 0.0)
    grown = RigidBlockModel((), (), MU)
    for place in range(0, len(placed), 2):  # a stone and its wedge at a time
        around = PlacedPolygons(tuple(ids[:place]), no_polygons().added(placed[:place]))
        grown = model_with_outlines(grown, listed[place : place + 2], around, 0.1, 0.0)
    assert grown.blocks == whole.blocks
    assert told(grown.interfaces) == told(whole.interfaces)
    # Normals point into the later one, whatever its id.
    assert all(i.other == GROUND or i.block < i.other for i in whole.interfaces)


# Contacts that stay away from the ends of faces (DESIGN 4.8): laps, corners, and a slow twin.


def set_back(polygons, setback=0.01):
    return model_of(*polygons, setback=setback)


def strength(polygons):
    """F_LR; 0 where the wall falls by itself."""
    found = lateral_resistance(set_back(polygons))
    assert not found.failed
    return found.value or 0.0


def bricks(width, height, count, courses, gap, lap):
    """Bricks whose courses are moved to and fro by half a lap; `gap` is that of all joints."""
    asides = [(0.5 if course % 2 else -0.5) * lap for course in range(courses)]
    return [
        box_of(column * (width + gap) + aside, gap + course * (height + gap), width, height)
        for course, aside in enumerate(asides)
        for column in range(count)
    ]


FAMILIES = [(40.0, 20.0, 6, 5), (30.0, 30.0, 3, 4), (60.0, 20.0, 2, 9)]


@pytest.mark.parametrize(("family", "small"), list(zip(FAMILIES, (0.01, 0.05, 0.02), strict=True)))
def test_gaps_and_laps_that_go_to_zero_change_nothing(family, small):
    """A corner over a corner at the crossing of four joints carries no more than an open joint."""
    whole = strength(bricks(*family, 0.0, 0.0))
    for gap, lap in ((small, 0.0), (0.0, small), (small, small), (small, 2 * small)):
        assert strength(bricks(*family, gap, lap)) == pytest.approx(whole, rel=0.01)


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
    assert {face.block for face in set_back(wall).interfaces} == {1}
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
            by = max(0.1, setback * min(area, area_and_centroid(outline)[0]) ** 0.5)
            by = by if setback else 0.0
            for axis, normal in ((0, (0.0, 1.0)), (1, (1.0, 0.0))):
                low = max(corners[:, axis].min(), outline[:, axis].min())
                high = min(corners[:, axis].max(), outline[:, axis].max())
                for sign in (1.0, -1.0):  # which side of the box: its lower or left one first
                    mine = (sign * corners[:, 1 - axis]).min()
                    theirs = (sign * outline[:, 1 - axis]).max()
                    if abs(mine - theirs) > 0.1 or high - low <= 2 * by:
                        continue
                    points = np.full((2, 2), sign * mine)
                    points[:, axis] = low + by, high - by
                    toward = sign * normal[0], sign * normal[1]
                    interfaces.append(Interface(number, other, points, toward))
    return RigidBlockModel(tuple(blocks), tuple(interfaces), MU)


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.005, 0.01, 0.04]))
@repeatable(20)
def test_walls_of_boxes_are_those_of_the_slow_twin(seed, setback):
    rng = np.random.default_rng(seed)
    wall, bottom = [], 0.01
    for _ in range(int(rng.integers(2, 5))):
        left, height = rng.choice([0.0, 1.0, 6.0]), rng.uniform(8.0, 20.0)
        while left < 90.0:
            width = rng.uniform(12.0, 40.0)
            wall.append(box_of(left, bottom, width, height))
            left += width + rng.choice([0.01, 0.05, 0.5])
        bottom += height + 0.01
    found, twin = lateral_resistance(set_back(wall, setback)), naive_model(wall, setback)
    slow = lateral_resistance(twin)
    for one, other in ((found.left, slow.left), (found.right, slow.right)):
        assert one.status == other.status
        assert one.alpha is None or one.alpha == pytest.approx(other.alpha, abs=2e-3)
