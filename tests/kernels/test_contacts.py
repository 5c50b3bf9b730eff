"""Contacts in patches (§4.2)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.boundary import EMPTY
from drystone.kernels.contacts import contacts_in
from drystone.kernels.patches import Patch, painted_patch, whole_patch
from tests.naive import contacts as naive
from tests.strategies import label_images, repeatable


@pytest.mark.parametrize(
    ("labels", "high"), [(np.zeros((0, 0)), []), (np.zeros((3, 4)), []), (np.ones((1, 1)), [1])]
)
def test_where_there_is_hardly_anything_the_ground_is_touched_at_most(labels, high):
    found = contacts_in(whole_patch(labels.astype(np.uint32)))
    assert found.high.tolist() == high
    assert found.ends.shape == (len(high), 2, 2)


def under(tops):
    """A picture of two stones: one above the other, whose columns are so high."""
    rows = np.arange(max(tops) + 1, -1, -1)[:, None]
    return np.where(rows >= np.array(tops), 2, 1).astype(np.uint32)


steps = st.lists(st.sampled_from([-9, -2, -1, 0, 0, 0, 1, 1, 2, 3]), min_size=1, max_size=30)
skylines = steps.map(lambda up: under((np.cumsum(up) - min(np.cumsum(up)) + 1).tolist()))


@given(labels=st.one_of(label_images(), skylines, skylines.map(np.rot90)))
@repeatable(150)
def test_contacts_equal_their_naive_twin(labels):
    """Runs are cut at corners, and left out is the ledge of a pixel at their ends."""
    found = contacts_in(whole_patch(labels))
    assert not np.signbit(found.normals[found.normals == 0.0]).any()
    twin = naive.interfaces(labels)
    assert list(zip(found.high, found.low, strict=True)) == [told[:2] for told in twin]
    assert found.run_count == sum(len(points) == 2 for _, _, points, _ in twin)
    assert found.ends.tolist() == [[list(p[0]), list(p[-1])] for _, _, p, _ in twin]
    normals = np.array([told[3] for told in twin]).reshape(-1, 2)
    assert found.normals == pytest.approx(normals, abs=1e-12)


def test_long_runs_are_fitted_as_well():
    found = contacts_in(whole_patch(under([k // 5 for k in range(3000)])))
    (normal,) = found.normals[(found.high == 2) & (found.low == 1)]
    assert normal == pytest.approx(np.array([-1.0, 5.0]) / 26**0.5, abs=1e-5)


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
