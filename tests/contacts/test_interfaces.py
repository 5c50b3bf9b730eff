import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.interfaces import PointContacts, find_interfaces
from drystone.kernels.patches import painted_patch
from tests.naive import contacts as naive
from tests.statics.walls import coursed, irregular
from tests.strategies import repeatable


def told(interface):
    """What an interface says, to compare."""
    points = [tuple(point) for point in interface.points.tolist()]
    return interface.block, interface.other, points, interface.normal


@given(angle_deg=st.floats(-180, 180), offset=st.floats(-1, 1), size=st.integers(10, 60))
@repeatable(200)
def test_a_tilted_joint_is_one_run_with_a_bounded_error_of_its_normal(angle_deg, offset, size):
    angle = math.radians(angle_deg)
    row, col = np.mgrid[:size, :size]
    x, y = col + 0.5 - size / 2, size / 2 - row - 0.5
    normal = (-math.sin(angle), math.cos(angle))
    labels = np.where(x * normal[0] + y * normal[1] > offset, 2, 1).astype(np.uint32)
    (run,) = (i for i in find_interfaces(labels) if i.other == 1)
    error = math.acos(min(1.0, run.normal[0] * normal[0] + run.normal[1] * normal[1]))
    # Half a pixel up at one end and down at the other, and some for runs of a few steps.
    assert error * run.length < 1.6
    away = run.points - size / 2
    assert np.abs(away @ normal - offset).max() <= 0.5**0.5 + 1e-9


@pytest.mark.parametrize("seed", range(2))
def test_interfaces_of_tilted_joints_equal_their_naive_twin(seed):
    """Ids and points exactly; normals to rounding."""
    for labels in (irregular(seed, 20, 90, 60), coursed(seed, 4, 120, gap_px=seed)):
        found, expected = find_interfaces(labels), naive.interfaces(labels)
        assert [told(i)[:3] for i in found] == [i[:3] for i in expected]
        for interface, twin in zip(found, expected, strict=True):
            assert interface.normal == pytest.approx(twin[3], abs=1e-12)


@given(seed=st.integers(0, 2**32), row=st.integers(0, 21), col=st.integers(0, 17))
@repeatable(100)
def test_the_contacts_that_are_closed_in_are_those_that_are_there_no_more(seed, row, col):
    labels = np.random.default_rng(seed).choice([0, 0, 0, 1, 2, 3, 4], (24, 20)).astype(np.uint32)
    mask = labels[row : row + 3, col : col + 5] == 0
    grown = labels.copy()
    grown[row : row + 3, col : col + 5][mask] = 9
    patch, _ = painted_patch(labels, [(9, row, col, mask)])
    found = find_interfaces(labels)
    left = [told(interface)[:3] for interface in find_interfaces(grown)]
    told_before = [told(interface)[:3] for interface in found]
    points = [k for k, (*_, points) in enumerate(told_before) if len(points) == 1]
    gone = [k for k in points if told_before[k] not in left]
    assert list(PointContacts.of(found).closed_in(patch)) == gone
