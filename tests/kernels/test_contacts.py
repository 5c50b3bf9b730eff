"""Contacts in patches: compiled and NumPy give the same bits (§4.2)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels import contacts as module
from drystone.kernels.boundary import EMPTY, boundary_numpy
from drystone.kernels.contacts import contacts_in, contacts_numpy
from drystone.kernels.patches import Patch, painted_patch, whole_patch
from tests.naive import contacts as naive
from tests.statics.walls import coursed, irregular
from tests.strategies import label_images, repeatable

compiled_too = pytest.mark.skipif(module._fast is None, reason="kernels are not compiled here")


def same_bits(patch):
    """Whether the compiled kernel gives the bits of the other one."""
    fast = contacts_in(patch)
    slow = contacts_numpy(patch.cells, boundary_numpy(patch.cells, patch.fresh), patch.origin)
    assert fast.run_count == slow.run_count
    return all(
        a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
        for a, b in (
            (fast.high, slow.high),
            (fast.low, slow.low),
            (fast.ends, slow.ends),
            (fast.normals, slow.normals),
        )
    )


@compiled_too
@given(labels=label_images(), ids=st.none() | st.lists(st.integers(1, 4), max_size=3))
@repeatable(300)
def test_contacts_have_the_same_bits(labels, ids):
    patch = whole_patch(labels)
    if ids is not None:
        patch = Patch(patch.cells, np.isin(patch.cells, ids), patch.origin)
    assert same_bits(patch)


@compiled_too
@pytest.mark.parametrize("seed", range(6))
def test_contacts_of_tilted_and_loose_joints_have_the_same_bits(seed):
    dust = np.random.default_rng(seed).integers(0, 3, (60, 80)).astype(np.uint32)
    for labels in (irregular(seed, 30, 160, 120), coursed(seed, 5, 120, gap_px=3), dust):
        assert same_bits(whole_patch(labels))
        assert same_bits(whole_patch(labels * (labels % 3 > 0)))


@compiled_too
@pytest.mark.parametrize("labels", [np.zeros((0, 0)), np.zeros((3, 4)), np.ones((1, 1))])
def test_contacts_of_hardly_anything_have_the_same_bits(labels):
    assert same_bits(whole_patch(labels.astype(np.uint32)))


@given(labels=label_images())
@repeatable(60)
def test_contacts_equal_their_naive_twin(labels):
    found = contacts_in(whole_patch(labels))
    twin = naive.interfaces(labels)
    assert list(zip(found.high, found.low, strict=True)) == [told[:2] for told in twin]
    assert found.run_count == sum(len(points) == 2 for _, _, points, _ in twin)
    assert found.ends.tolist() == [[list(p[0]), list(p[-1])] for _, _, p, _ in twin]
    normals = np.array([told[3] for told in twin]).reshape(-1, 2)
    assert found.normals == pytest.approx(normals, abs=1e-12)


def test_a_point_near_the_edge_of_the_cells_sees_what_is_there():
    cells = np.array([[EMPTY, 7], [4, EMPTY]])
    found = contacts_in(Patch(cells, None, (10, 20)))
    assert found.ends.tolist() == [[[11.0, 19.0], [11.0, 19.0]]]
    assert found.normals.tolist() == [[0.0, 1.0]]
    assert found.run_count == 0


def test_only_contacts_of_what_is_fresh():
    labels = np.array([[1, 1, 2, 2, 0, 0]], np.uint32)
    patch, _ = painted_patch(labels, [(9, 0, 4, np.ones((1, 1), bool))])
    found = contacts_in(patch)
    assert list(zip(found.high, found.low, strict=True)) == [(9, 0), (9, 2)]
