"""Gaps that are closed, and blocks that touch too little."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from drystone.contacts import gaps
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.naive.gaps import lies_between
from tests.naive.raster import polygon_of
from tests.statics.walls import alphas, brick_model
from tests.strategies import repeatable


def bond(courses, half_px, tall_px, joint_px):
    """Running bond of three bricks a course; joints are cut from bricks of the tight bond."""
    pitch = tall_px + joint_px
    labels = np.zeros((courses * pitch, 6 * half_px), np.uint32)
    number = 0
    for course in range(courses):
        edges = [0, 2, 4, 6] if course % 2 == 0 else [0, 1, 3, 5, 6]
        bottom = len(labels) - course * pitch
        for left, right in pairwise(edges):
            number += 1
            first = left * half_px + (joint_px // 2 if left else 0)
            last = right * half_px - (joint_px - joint_px // 2 if right < 6 else 0)
            labels[bottom - tall_px : bottom, first:last] = number
    return labels


def pairs(model):
    return {(i.block, i.other) for i in model.interfaces}


@pytest.mark.parametrize(("courses", "tall", "joint"), [(6, 37, 3), (8, 38, 2)])
def test_a_bond_with_open_joints_is_as_strong_as_the_tight_one(courses, tall, joint):
    labels = bond(courses, 20, tall, joint)
    tight = brick_model(courses, 3, (tall + joint) / 20, 0.58)
    closed = gaps.model_with_closed_gaps(labels, joint).model
    assert closed.blocks == model_from_labels(labels).model.blocks
    assert pairs(closed) == pairs(tight)
    assert len(closed.interfaces) == len(tight.interfaces)
    assert alphas(closed) == pytest.approx(alphas(tight), rel=0.02)
    assert lateral_resistance(gaps.model_with_closed_gaps(labels, joint - 1).model).value is None


def test_a_tilted_gap_is_as_wide_as_it_is_across():
    row, col = np.mgrid[:60, :60]

    def closed(slope, reach):
        away = (row - 30 - slope * (col - 30)) / np.hypot(1, slope)
        labels = np.where(away < -3, 1, np.where(away > 3, 2, 0))
        return labels, gaps.close_gaps(labels, reach)

    for reach, joined in ((4, False), (8, True)):
        assert ((2, 1) in pairs(model_from_labels(closed(0.5, reach)[1]).model)) == joined
    assert (closed(1.0, 6.5)[1] > 0).mean() > 0.98
    labels, grown = closed(1.0, 5)
    assert (grown == labels).mean() > 0.98


AIR = np.zeros((20, 30), np.uint32)
AIR[5:, :12], AIR[8:, 14:26] = 1, 2
BELOW = np.full((20, 30), 3)
BELOW[8:, :14], BELOW[8:, 14:17], BELOW[8:, 17:] = 1, 0, 2


@pytest.mark.parametrize(("labels", "first", "middle"), [(AIR, 12, 13), (BELOW, 14, 16)])
def test_nothing_grows_into_free_air_and_no_stone_into_the_head_joint_below_it(
    labels, first, middle
):
    expected = labels.copy()
    expected[8:, first:middle], expected[8:, middle] = 1, 2
    assert (gaps.close_gaps(labels, 6) == expected).all()


def test_a_stone_just_above_the_ground_stands_on_it():
    labels = np.zeros((12, 20), np.uint32)
    labels[:10, :8], labels[2:, 10:] = 1, 2
    assert (1, GROUND) not in pairs(gaps.model_with_closed_gaps(labels, 1).model)
    assert (1, GROUND) in pairs(gaps.model_with_closed_gaps(labels, 2).model)


scattered = arrays(
    np.uint32,
    st.tuples(st.integers(2, 12), st.integers(2, 12)),
    elements=st.sampled_from([0, 0, 0, 1, 2, 3, 4]),
    fill=st.just(0),
)


@given(labels=scattered, reach=st.integers(1, 6))
@repeatable(150)
def test_closing_keeps_stones_and_joins_only_those_within_reach(labels, reach):
    closed = gaps.close_gaps(labels, reach)
    assert (closed[labels > 0] == labels[labels > 0]).all()
    assert set(np.unique(closed)) <= set(np.unique(labels)) | {0}
    height = int(np.flatnonzero(labels.any(axis=1))[-1]) + 1 if labels.any() else 0
    stones = closed[:height] * (closed[:height] == labels[:height])
    for row, col in np.argwhere(closed != labels).tolist():
        others = closed[:height].copy()  # a hole may lie between gaps that are closed
        others[row, col] = 0
        hole = ndimage.binary_fill_holes(others > 0)[row, col]
        assert hole or lies_between(stones, row, col) or lies_between(others, row, col)
    for one, other in pairs(model_from_labels(closed).model):
        if other != GROUND:
            assert polygon_of(labels == one).distance(polygon_of(labels == other)) <= reach


def test_pushed_stones_touch_their_neighbours():
    labels = bond(2, 10, 12, 2)
    settled, moved = gaps.settle_gaps(labels, "left")
    assert (moved[2], moved[3]) == ((-2, 0), (-4, 0))
    assert (2, 1) in pairs(model_from_labels(settled).model)
    mirrored, ways = gaps.settle_gaps(labels[:, ::-1], "right")
    assert (mirrored == settled[:, ::-1]).all()
    assert ways == {block: (-aside, down) for block, (aside, down) in moved.items()}


@given(labels=scattered, push=st.sampled_from([None, "left", "right"]))
@repeatable(100)
def test_settling_moves_stones_as_rigid_bodies_until_they_rest(labels, push):
    settled, moved = gaps.settle_gaps(labels, push)
    height = int(np.flatnonzero(labels.any(axis=1))[-1]) + 1 if labels.any() else 0
    below = np.vstack([settled[:height], np.full((1, labels.shape[1]), 99)])
    for block in np.unique(labels[labels > 0]).tolist():
        aside, down = moved.get(block, (0, 0))
        assert down >= 0
        there = np.argwhere(settled == block).tolist()
        assert there == (np.argwhere(labels == block) + np.array([down, aside])).tolist()
        assert any(below[row + 1, col] not in (0, block) for row, col in there)


def test_no_toe_grows_beyond_its_stone():
    labels = np.zeros((23, 60), np.uint32)
    labels[:20, 10:20], labels[3:, 22:40] = 1, 2
    sides = {1: (10, 20), 2: (22, 40)}
    for interface in gaps.model_with_closed_gaps(labels, 4).model.interfaces:
        if interface.other == GROUND:
            left, right = sides[interface.block]
            assert interface.points[:, 0].min() >= left
            assert interface.points[:, 0].max() <= right


def answers(alphas):
    """Answer as at the widest known width that is not wider; None is a wall that falls."""

    def at(width):
        alpha = alphas[max(known for known in alphas if known <= width)]
        end = SimpleNamespace(alpha=alpha)
        return SimpleNamespace(stable=alpha is not None, left=end, right=end)

    return at


@pytest.mark.parametrize(
    ("alphas", "chosen", "first", "steady"),
    [
        ({0: 0.5}, 0, 0, True),  # stands as it is drawn
        ({0: None, 3: 0.4}, 3, 3, True),
        ({0: None, 9: 0.4}, 9, 9, True),  # between widths of the ladder
        ({0: None, 4: 0.1, 6: 0.3, 8: 0.4, 9: 0.41}, 8, 4, True),
        ({0: None, 2: 0.3, 3: None, 5: 0.3}, 5, 5, True),  # wider gaps may bear less, too
        ({0: None, **{width: 0.01 * 1.2**width for width in range(6, 60)}}, 6, 6, False),
        ({0: None}, 20, None, False),
    ],
)
def test_a_sweep_finds_from_where_a_wall_stands(alphas, chosen, first, steady):
    sweep = gaps.gap_sweep(answers(alphas), 40.0)
    assert (sweep.chosen_px, sweep.stands_from_px, sweep.steady) == (chosen, first, steady)
    assert [width for width, *_ in sweep.tried] == sorted({width for width, *_ in sweep.tried})
    known = {width: alpha for width, _, alpha in sweep.tried}
    if first:
        assert known[first - 1] is None
    if steady:
        low, high = sweep.within() or (0.0, 0.0)
        assert low == pytest.approx(known[chosen])
        assert high <= 1.1 * low


@pytest.mark.parametrize("usual", [20.0, 90.0, 180.0, 400.0])
def test_the_narrowest_steady_width_does_not_depend_on_the_resolution(usual):
    """Where more joints close, a wall bears more: what was steady before is right."""
    step = max(1, round(usual / 60))
    drawn = gaps.gap_sweep(answers({0: 0.33, 4 * step: 0.4, 5 * step: 0.5}), usual)
    assert (drawn.chosen_px, drawn.steady) == (0, True)
    assert drawn.within() == (0.33, 0.33)
    opened = gaps.gap_sweep(answers({0: None, step: 0.33, 6 * step: 0.4}), usual)
    assert (opened.chosen_px, opened.steady) == (step, True)


def test_widths_that_are_tried_grow_with_the_stones():
    sweep = gaps.gap_sweep(answers({0: None, 12: 0.4}), 180.0)
    assert (sweep.chosen_px, sweep.stands_from_px) == (12, 12)
    assert len(sweep.tried) < 14


def test_a_stone_that_floats_and_one_that_touches_at_a_corner():
    wall = np.zeros((34, 60), int)
    wall[20:34, 0:30], wall[20:34, 30:60] = 1, 2
    wall[10:20, 5:20] = 3  # on 1, by an interface: it rests
    wall[5:10, 20:24] = 4  # a corner of it touches a corner of 3; 1 is 10 px below
    wall[5:15, 40:50] = 5  # 5 px above 2
    found = gaps.scarce_contacts(model_from_labels(wall).model, wall)
    assert found == (gaps.Scarce(4, 1, 1, 10.0), gaps.Scarce(5, 0, 2, 5.0))
    data = {"blocks_xywh": [[0, 0, 4, 2], [0, 2.5, 4, 2], [6, 1, 2, 2]]}
    found = gaps.scarce_contacts(model_from_json(data), polygons_from_json(data))
    assert found == (gaps.Scarce(2, 0, 1, 0.5), gaps.Scarce(3, 0, 0, 1.0))


@given(arrays(np.int64, (9, 12), elements=st.integers(0, 4)))
def test_gaps_are_those_between_all_pixels(cells):
    """A slow twin: every pair of pixels."""
    if not (cells > 0).any():
        return
    wall = cells[: np.flatnonzero((cells > 0).any(axis=1))[-1] + 1]
    model = model_from_labels(wall).model
    touched = {pair for i in model.interfaces for pair in ((i.block, i.other), (i.other, i.block))}
    pixels = {i: np.argwhere(wall == i) for i in np.unique(wall).tolist()}
    pixels[GROUND] = np.array([(wall.shape[0], col) for col in range(wall.shape[1])])
    for one in gaps.scarce_contacts(model, cells):
        widths = {
            i: np.hypot(*(pixels[one.block][:, None] - other).transpose(2, 0, 1)).min() - 1.0
            for i, other in pixels.items()
            if i != one.block and (one.block, i) not in touched
        }
        assert one.gap == min(widths.values(), default=np.inf) == widths.get(one.nearest, np.inf)
