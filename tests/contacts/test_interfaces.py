import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.contacts.interfaces import PointContacts, find_interfaces, interfaces_in
from drystone.kernels.patches import painted_patch
from drystone.statics.model import GROUND
from tests.naive import contacts as naive
from tests.statics.walls import coursed, irregular
from tests.strategies import label_images, repeatable


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
    assert np.abs(away @ normal - offset).max() <= 0.5**0.5 + 1e-9


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


def test_ids_above_16_bit_survive():
    labels = np.array([[4_294_967_295], [70_000]], np.uint32)
    assert [(i.block, i.other) for i in find_interfaces(labels)] == [
        (70_000, 0),
        (4_294_967_295, 70_000),
    ]


pictures = arrays(
    np.uint32,
    st.tuples(st.integers(1, 12), st.integers(1, 12)),
    elements=st.integers(0, 5),
    fill=st.integers(0, 5),
)


def assert_equals_naive(labels):
    """Ids and points exactly; normals to rounding."""
    found, expected = find_interfaces(labels), naive.interfaces(labels)
    assert [told(i)[:3] for i in found] == [i[:3] for i in expected]
    for interface, twin in zip(found, expected, strict=True):
        assert interface.normal == pytest.approx(twin[3], abs=1e-12)


@given(labels=pictures | label_images())
@repeatable(200)
def test_interfaces_equal_their_naive_twin(labels):
    assert_equals_naive(labels)


@pytest.mark.parametrize("seed", range(4))
def test_interfaces_of_tilted_joints_equal_their_naive_twin(seed):
    assert_equals_naive(irregular(seed, 20, 90, 60))
    assert_equals_naive(coursed(seed, 4, 120, gap_px=seed))


def added(built, found, labels, group):
    """Interfaces after a group of blocks of `labels` was built, and whether they closed any in."""
    parts = []
    for block in group:
        rows, cols = np.nonzero(labels == block)
        top, left = int(rows.min()), int(cols.min())
        mask = labels[top : rows.max() + 1, left : cols.max() + 1] == block
        parts.append((block, top, left, mask))
    patch, _ = painted_patch(built, parts)
    closed = PointContacts.of(found).closed_in(patch)
    assert list(closed) == sorted(closed)
    kept = [interface for place, interface in enumerate(found) if place not in closed]
    built[np.isin(labels, group)] = labels[np.isin(labels, group)]
    return (*kept, *interfaces_in(patch))


@given(
    labels=pictures | label_images(),
    order=st.permutations(range(1, 6)),
    together=st.integers(1, 3),
)
@repeatable(150)
def test_block_after_block_gives_the_interfaces_of_the_whole(labels, order, together):
    """Blocks come in groups, as a stone and its wedges do."""
    built, found = np.zeros_like(labels), ()
    there = np.unique(labels[labels > 0]).tolist()
    present = [there[i - 1] for i in order if i <= len(there)] + there[5:]
    for first in range(0, len(present), together):
        found = added(built, found, labels, present[first : first + together])
    assert (built == labels).all()
    assert sorted(map(told, found)) == sorted(map(told, find_interfaces(labels)))


@given(seed=st.integers(0, 2**32), row=st.integers(0, 21), col=st.integers(0, 17))
@repeatable(100)
def test_the_contacts_that_are_closed_in_are_those_that_are_there_no_more(seed, row, col):
    labels = np.random.default_rng(seed).choice([0, 0, 0, 1, 2, 3, 4], (24, 20)).astype(np.uint32)
    mask = labels[row : row + 3, col : col + 5] == 0
    grown = labels.copy()
    grown[row : row + 3, col : col + 5][mask] = 9
    patch, _ = painted_patch(labels, [(9, row, col, mask)])
    found = find_interfaces(labels)
    after = [told(interface) for interface in find_interfaces(grown) if len(interface.points) == 1]
    places = {(*ids, points[0]) for *ids, points, _ in after}
    gone = [
        position
        for position, interface in enumerate(found)
        if len(interface.points) == 1
        and (interface.block, interface.other, tuple(interface.points[0])) not in places
    ]
    assert list(PointContacts.of(found).closed_in(patch)) == gone
