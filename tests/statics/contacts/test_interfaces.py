import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.statics.contacts.interfaces import (
    CORNER_TOLERANCE_PX,
    closed_in,
    find_interfaces,
    find_interfaces_of,
)
from drystone.statics.model import GROUND
from tests.naive.statics import diagonal_touches, pixel_edges
from tests.strategies import repeatable


def between(labels, block, other):
    return [i for i in find_interfaces(labels) if (i.block, i.other) == (block, other)]


def told(interface):
    """What an interface says, to compare."""
    points = [tuple(point) for point in interface.points.tolist()]
    return interface.block, interface.other, points, interface.normal


def picture(*rows):
    return np.array([[int(c) for c in row.replace(".", "0")] for row in rows], np.uint32)


def test_contacts_lie_on_pixel_edges():
    labels = np.zeros((50, 60), np.uint32)
    labels[10:, 20:40] = 3
    (ground,) = find_interfaces(labels)
    assert told(ground) == (3, GROUND, [(20, 0), (40, 0)], (0.0, 1.0))
    assert ground.length == 20


def test_the_normal_points_into_the_larger_id_on_all_four_sides():
    labels = picture("...4...", ".35556.", "...2...")
    normals = {(i.block, i.other): i.normal for i in find_interfaces(labels) if i.other != GROUND}
    assert normals == {(5, 2): (0, 1), (5, 3): (1, 0), (5, 4): (0, -1), (6, 5): (1, 0)}


def test_an_l_shaped_run_is_split_at_its_corner():
    labels = np.ones((30, 40), np.uint32)
    labels[:20, 10:] = 2
    assert [told(i) for i in between(labels, 2, 1)] == [
        (2, 1, [(10, 30), (10, 10)], (1.0, 0.0)),
        (2, 1, [(10, 10), (40, 10)], (0.0, 1.0)),
    ]


@pytest.mark.parametrize("leg", [2, 3, 5])
def test_a_short_leg_is_an_interface_of_its_own(leg):
    labels = np.zeros((20, 40), np.uint32)
    labels[10:, :30] = 1
    labels[:10] = 2
    labels[: 10 + leg, 30:] = 2
    assert [told(i) for i in between(labels, 2, 1)] == [
        (2, 1, [(0, 10), (30, 10)], (0.0, 1.0)),
        (2, 1, [(30, 10), (30, 10 - leg)], (1.0, 0.0)),
    ]


@pytest.mark.parametrize("at_the_end", [True, False])
@pytest.mark.parametrize("downwards", [True, False])
@pytest.mark.parametrize("length", [4, 10, 30])
def test_a_hook_of_one_pixel_does_not_tilt_the_normal(length, downwards, at_the_end):
    labels = np.ones((20, length + 4), np.uint32)
    labels[:10, 2:-2] = 2
    labels[:10, :2], labels[:10, -2:] = 0, 0
    beyond = np.s_[-2:] if at_the_end else np.s_[:2]
    if downwards:  # the upper stone hangs over the end of the lower one
        labels[:11, beyond] = 2
        labels[11:, beyond] = 0
    else:  # the lower stone rises beside the end of the upper one
        labels[9, beyond] = 1
    (run,) = between(labels, 2, 1)
    assert run.normal == (0.0, 1.0)
    assert [tuple(p) for p in run.points] == [(2, 10), (length + 2, 10)]


@pytest.mark.parametrize(("rise", "tread"), [(1, 1), (1, 2), (1, 3), (2, 3), (1, 6)])
def test_a_regular_staircase_has_the_normal_of_its_slope(rise, tread):
    count = 36
    cols = np.arange(count)
    top = 4 + (cols * rise + (tread - 1) // 2) // tread
    rows = np.arange(50)[:, None]
    labels = np.where(rows >= 50 - top, 1, 2).astype(np.uint32)
    (run,) = between(labels, 2, 1)
    angle = math.degrees(math.atan2(-run.normal[0], run.normal[1]))
    assert angle == pytest.approx(math.degrees(math.atan2(rise, tread)), abs=0.5)


@given(
    angle_deg=st.floats(-180, 180),
    offset=st.floats(-1, 1),
    size=st.integers(10, 60),
)
@repeatable(200)
def test_a_tilted_joint_is_one_run_with_a_bounded_error_of_its_normal(angle_deg, offset, size):
    angle = math.radians(angle_deg)
    row, col = np.mgrid[:size, :size]
    x, y = col + 0.5 - size / 2, size / 2 - row - 0.5
    normal = (-math.sin(angle), math.cos(angle))
    labels = np.where(x * normal[0] + y * normal[1] > offset, 2, 1).astype(np.uint32)
    (run,) = between(labels, 2, 1)
    error = math.acos(min(1.0, run.normal[0] * normal[0] + run.normal[1] * normal[1]))
    # Half a pixel up at one end and down at the other, and some for runs of a few steps.
    assert error * run.length < 1.6
    away = run.points - size / 2
    assert np.abs(away @ normal - offset).max() <= CORNER_TOLERANCE_PX / 2 + 1e-9


def test_separate_patches_of_one_pair_stay_separate():
    labels = picture("2222222222", "22..22..22", "1111111111")
    assert [i.points[:, 0].tolist() for i in between(labels, 2, 1)] == [[0, 2], [4, 6], [8, 10]]


def test_a_stone_inside_another_has_four_sides():
    labels = np.ones((12, 12), np.uint32)
    labels[3:9, 3:9] = 2
    sides = between(labels, 2, 1)
    assert sorted(i.normal for i in sides) == [(-1, 0), (0, -1), (0, 1), (1, 0)]
    assert {i.length for i in sides} == {6}


def test_a_pixel_in_a_hole_keeps_all_its_edges():
    labels = np.ones((3, 3), np.uint32)
    labels[1, 1] = 2
    assert len(between(labels, 2, 1)) == 2


def test_stones_that_touch_at_a_corner_have_a_contact_at_a_point():
    labels = np.zeros((20, 20), np.uint32)
    labels[:10, :10], labels[10:, 10:] = 1, 2
    (contact,) = between(labels, 2, 1)
    # Stone 1 stands on stone 2; the normal points into the larger id.
    assert told(contact) == (2, 1, [(10, 10)], (0.0, -1.0))


def test_a_corner_on_a_slope_has_the_normal_of_the_slope():
    row, col = np.mgrid[:20, :20]
    labels = np.where(row > col, 1, 0).astype(np.uint32)  # falls to the right at 45 degrees
    labels[:10, 10:] = 2
    labels[9, 10:], labels[:10, 10] = 2, 2
    contacts = between(labels, 2, 1)
    assert [len(i.points) for i in contacts] == [1]
    assert contacts[0].normal == pytest.approx((0.5**0.5, 0.5**0.5))


def test_a_crossing_of_joints_is_no_contact_of_opposite_stones():
    labels = np.kron(np.array([[1, 2], [3, 4]]), np.ones((5, 5))).astype(np.uint32)
    assert between(labels, 4, 1) == []
    assert between(labels, 3, 2) == []


def test_ids_above_16_bit_survive():
    labels = np.array([[4_294_967_295], [70_000]], np.uint32)
    assert [(i.block, i.other) for i in find_interfaces(labels)] == [
        (70_000, 0),
        (4_294_967_295, 70_000),
    ]


def test_an_empty_image_has_no_interfaces():
    assert find_interfaces(np.zeros((4, 4), np.uint32)) == ()


pictures = arrays(
    np.uint32,
    st.tuples(st.integers(1, 12), st.integers(1, 12)),
    elements=st.integers(0, 5),
    fill=st.integers(0, 5),
)


@given(labels=pictures)
@repeatable()
def test_every_pair_that_touches_has_an_interface_and_no_other(labels):
    touching = set(pixel_edges(labels)) | {touch[:2] for touch in diagonal_touches(labels)}
    assert {(i.block, i.other) for i in find_interfaces(labels)} == touching


@given(labels=pictures)
@repeatable()
def test_normals_are_unit_vectors_and_order_is_fixed(labels):
    found = find_interfaces(labels)
    for interface in found:
        assert math.hypot(*interface.normal) == pytest.approx(1, abs=1e-12)
    assert [told(i) for i in found] == [told(i) for i in find_interfaces(labels.copy())]


def left_open(interfaces, labels, window):
    closed = closed_in(interfaces, labels, window)
    return (i for place, i in enumerate(interfaces) if place not in closed)


@given(labels=pictures, order=st.permutations(range(1, 6)), together=st.integers(1, 3))
@repeatable(150)
def test_block_after_block_gives_the_interfaces_of_the_whole(labels, order, together):
    """Blocks come in groups, as a stone and its wedges do, each with its own window."""
    built, found = np.zeros_like(labels), ()
    present = [block for block in order if (labels == block).any()]
    for first in range(0, len(present), together):
        group = present[first : first + together]
        new = np.isin(labels, group)
        built[new] = labels[new]
        rows, cols = np.flatnonzero(new.any(axis=1)), np.flatnonzero(new.any(axis=0))
        window = (slice(rows[0], rows[-1] + 1), slice(cols[0], cols[-1] + 1))
        found = (
            *left_open(found, built, window),
            *find_interfaces_of(built, group, window),
        )
    assert sorted(map(told, found)) == sorted(map(told, find_interfaces(labels)))


@pytest.mark.parametrize("order", [(1, 4, 2, 3), (1, 4, 3, 2), (2, 3, 4, 1), (2, 3, 1, 4)])
def test_a_contact_at_a_point_disappears_when_the_pixels_beside_it_fill(order):
    labels = np.kron([[1, 2], [3, 4]], np.ones((5, 5))).astype(np.uint32)
    windows = {1: np.s_[0:5, 0:5], 2: np.s_[0:5, 5:10], 3: np.s_[5:10, 0:5], 4: np.s_[5:10, 5:10]}
    built, found, points = np.zeros_like(labels), (), []
    for block in order:
        built[windows[block]] = block
        found = (
            *left_open(found, built, windows[block]),
            *find_interfaces_of(built, [block], windows[block]),
        )
        points.append(sum(len(i.points) == 1 for i in found))
    assert points == [0, 1, 0, 0]
