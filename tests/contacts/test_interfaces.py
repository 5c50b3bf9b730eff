import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from drystone.contacts.interfaces import PointContacts, find_interfaces
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


def test_the_normal_points_into_the_larger_id_on_all_four_sides():
    rows = ("0004000", "0355560", "0002000")
    labels = np.array([[int(pixel) for pixel in row] for row in rows], np.uint32)
    normals = {(i.block, i.other): i.normal for i in find_interfaces(labels) if i.other != GROUND}
    assert normals == {(5, 2): (0, 1), (5, 3): (1, 0), (5, 4): (0, -1), (6, 5): (1, 0)}


@given(angle_deg=st.floats(-180, 180), offset=st.floats(-1, 1), size=st.integers(10, 60))
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
