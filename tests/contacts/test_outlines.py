from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from skimage import measure

from drystone.contacts.outlines import model_of_traced, outlines_of_labels
from drystone.io.read_stones import read_stones
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from drystone_lab.pixels import tilted_wall
from tests.statics.walls import irregular
from tests.strategies import repeatable


def area(outline):
    x, y = outline.T
    return (x[:-1] @ y[1:] - x[1:] @ y[:-1]) / 2


def edges_of(outline):
    return {(tuple(a), tuple(b)) for a, b in pairwise(outline.tolist())}


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
        assert area(outlines[stone.id]) == pytest.approx(stone.area_px, rel=1e-3)


def test_a_tilted_joint_is_one_edge_with_its_slope():
    row, col = np.mgrid[:60, :80]
    slope = np.tan(np.radians(7))
    labels = np.where(59.5 - row > 20.3 + slope * col, 2, 1)
    outlines = outlines_of_labels(labels)
    shared = edges_of(outlines[1]) & {(b, a) for a, b in edges_of(outlines[2])}
    (((x0, y0), (x1, y1)),) = shared
    assert np.degrees(np.arctan((y1 - y0) / (x1 - x0))) == pytest.approx(7, abs=0.2)
    assert y0 + (40 - x0) * (y1 - y0) / (x1 - x0) == pytest.approx(20.3 + slope * 39.5, abs=0.1)


def test_a_stone_on_the_ground_has_a_flat_bed_to_its_toes():
    row, col = np.mgrid[:30, :60]
    y, x = 29.5 - row, col + 0.5
    labels = np.where((x > 5.2 + 0.3 * y) & (x < 54.7 - 0.2 * y), 1, 0)
    (bed,) = (i for i in model_of_traced(outlines_of_labels(labels)).interfaces)
    assert bed.points[:, 1] == pytest.approx([0, 0], abs=1e-3)
    assert bed.points[:, 0] == pytest.approx([5.2, 54.7], abs=0.3)


@pytest.mark.parametrize("seed", range(2))
def test_neighbours_share_their_joints(seed):
    labels = irregular(seed, 12, 90, 70)
    outlines = outlines_of_labels(labels)
    inside = [e for o in outlines.values() for e in edges_of(o)]
    backwards = {(b, a) for a, b in inside}
    # What has no neighbour lies on the border of the picture; there are no gaps or overlaps.
    for (x0, y0), (x1, y1) in set(inside) - backwards:
        assert max(x0, x1) < 1.5 or min(x0, x1) > 88.5 or max(y0, y1) < 1.5 or min(y0, y1) > 68.5
    assert sum(area(o) for o in outlines.values()) == pytest.approx(labels.size, abs=4)
    shapes = [shapely.Polygon(o) for o in outlines.values()]
    assert shapely.union_all(shapes).area == pytest.approx(sum(s.area for s in shapes), abs=1e-6)


@pytest.mark.parametrize("shape", [(1, 1), (2, 2), (1, 9), (2, 20), (3, 5), (20, 4)])
def test_small_rectangles_are_exact(shape):
    height, width = shape
    labels = np.zeros((height + 2, width + 3), int)
    labels[1:-1, 1:-2] = 5
    (outline,) = outlines_of_labels(labels).values()
    assert shapely.Polygon(outline).equals(shapely.box(1, 1, 1 + width, 1 + height))


def test_holes_are_filled():
    labels = np.ones((20, 20), int)
    labels[5:10, 5:10] = 0
    assert area(outlines_of_labels(labels)[1]) == 400


@given(
    labels=arrays(
        np.uint32,
        st.tuples(st.integers(1, 8), st.integers(1, 8)),
        elements=st.integers(0, 4),
        fill=st.integers(0, 4),
    )
)
@repeatable(60)
def test_every_id_has_a_closed_outline_of_about_its_area(labels):
    outlines = outlines_of_labels(labels)
    assert set(outlines) == set(np.unique(labels[labels > 0]).tolist())
    for block, outline in outlines.items():
        assert outline[0].tolist() == outline[-1].tolist()
        assert np.abs(np.diff(outline, axis=0)).max(axis=1).min() > 0
        pieces = measure.label(labels == block, connectivity=1)
        largest = np.bincount(pieces.ravel())[1:].max()
        assert area(outline) > largest / 2
    model = model_of_traced(outlines)
    assert len(model.blocks) == len(outlines)


def test_the_model_of_a_picture_has_the_load_multipliers_of_the_wall():
    wall = tilted_wall(np.random.default_rng(5), courses=3)
    model = model_of_traced(outlines_of_labels(wall.picture(160, (0.3, 0.6))))
    exact = wall.model()
    assert len(model.interfaces) == len(exact.interfaces)
    found, true = lateral_resistance(model), lateral_resistance(exact)
    ends = true.left.alpha, true.right.alpha
    assert (found.left.alpha, found.right.alpha) == pytest.approx(ends, abs=0.02)


@pytest.mark.parametrize("seed", range(2))
def test_coarse_pictures_of_walls_stand_on_the_ground(seed):
    wall = tilted_wall(np.random.default_rng(seed), courses=3 + seed % 3)
    model = model_of_traced(outlines_of_labels(wall.picture(40, (0.3, 0.6))))
    assert lateral_resistance(model).stable


def test_gaps_up_to_the_tolerance_are_contacts():
    square = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4], [0, 0]])
    for gap, contacts in ((0.09, 1), (-0.09, 1), (0.11, 0)):
        model = model_of_traced({1: square, 2: square + np.array([1, 4 + gap])})
        among = [i for i in model.interfaces if i.other != GROUND]
        assert len(among) == contacts
    assert [(i.block, i.length) for i in model.interfaces] == [(1, 4.0)]
    assert model.blocks[0].centroid == (2, 2)
