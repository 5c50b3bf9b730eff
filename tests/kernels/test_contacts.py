"""Patches of label images, the boundaries in them and their contacts (§4.2)."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from drystone.kernels.boundary import EMPTY, boundary_of
from drystone.kernels.contacts import contacts_in
from drystone.kernels.patches import GROUND, MARGIN_PX, Patch, painted_patch, whole_patch
from tests.naive import contacts as naive
from tests.statics.walls import coursed, irregular
from tests.strategies import dust_labels, label_images, masks, repeatable


def test_where_there_is_hardly_anything_the_ground_is_touched_at_most():
    for shape in ((0, 0), (0, 3), (3, 0), (1, 1)):
        boundary = boundary_of(np.ones(shape, np.int64))
        assert boundary.begins.tolist() == [0]
        assert boundary.labels.shape == boundary.nodes.shape == (0, 2)
        assert boundary.corners.shape == (0, 4)
    for labels, high in ((np.zeros((0, 0)), []), (np.zeros((3, 4)), []), (np.ones((1, 1)), [1])):
        found = contacts_in(whole_patch(labels.astype(np.uint32)))
        assert found.high.tolist() == high
        assert found.ends.shape == (len(high), 2, 2)


def test_labels_of_64_bits_survive():
    cells = np.array([[2**62], [2**40 + 1], [2**40]])
    assert boundary_of(cells).labels.tolist() == [[2**40 + 1, 2**40], [2**62, 2**40 + 1]]
    crossing = np.array([[EMPTY, 2**62], [2**40, EMPTY]])
    assert boundary_of(crossing).corners.tolist() == [[2**62, 2**40, 1, 1]]
    patch = whole_patch(np.array([[2**40, 0]]))
    assert patch.cells[MARGIN_PX].tolist() == [EMPTY] * 3 + [2**40] + [EMPTY] * 4


def cells_at(labels, shape, top, left):
    """What cells say about pixels inside and outside of an image."""
    far = 30
    cells = np.pad(labels.astype(np.int64), far)
    cells[cells == 0] = EMPTY
    cells[far + labels.shape[0] :] = GROUND
    return cells[far + top :, far + left :][: shape[0], : shape[1]].copy()


around = st.integers(-9, 9)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint32, np.int64, np.int16])
def test_a_whole_image_has_a_margin_of_nothing_and_the_ground_below(dtype):
    labels = np.array([[0, 3], [5, 5]], dtype)
    patch = whole_patch(labels)
    assert (patch.cells == cells_at(labels, (8, 8), -MARGIN_PX, -MARGIN_PX)).all()
    assert (patch.fresh, patch.origin) == (None, (-MARGIN_PX, 2 + MARGIN_PX))


@given(
    labels=dust_labels(),
    parts=st.lists(st.tuples(masks(9), around, around), min_size=1),
    strided=st.booleans(),
)
@repeatable(100)
def test_a_patch_is_the_painted_image_around_all_parts(labels, parts, strided):
    """Parts may leave the image: what is drawn there is seen too.  Views are read in place."""
    parts = [(2**32 - 1 - k, row, col, mask) for k, (mask, row, col) in enumerate(parts)]
    if strided:
        labels = np.repeat(labels, 2, axis=1)[::-1, ::2]
        parts = [(*part, np.asfortranarray(mask)) for *part, mask in parts]
    labels.flags.writeable = False
    before = labels.copy()
    patch, sums = painted_patch(labels, parts)
    assert (labels == before).all()
    left, top = patch.origin[0], labels.shape[0] - patch.origin[1]
    expected = cells_at(labels, patch.cells.shape, top, left)
    fresh = np.zeros(expected.shape, bool)
    for label, row, col, mask in parts:
        rows, cols = np.nonzero(mask)
        expected[row - top + rows, col - left + cols] = label
        fresh[row - top + rows, col - left + cols] = True
    assert (patch.cells == expected).all()
    assert (patch.fresh == fresh).all()
    rows, cols = np.nonzero(fresh)
    assert (rows.min(), cols.min()) == (MARGIN_PX, MARGIN_PX)
    assert (rows.max() + 1 + MARGIN_PX, cols.max() + 1 + MARGIN_PX) == fresh.shape
    places = [np.nonzero(mask) for *_, mask in parts]
    assert sums == [(len(rows), cols.sum(), rows.sum()) for rows, cols in places]


def under(tops):
    """A picture of two stones: one above the other, whose columns are so high."""
    rows = np.arange(max(tops) + 1, -1, -1)[:, None]
    return np.where(rows >= np.array(tops), 2, 1).astype(np.uint32)


steps = st.lists(st.sampled_from([-9, -2, -1, 0, 0, 0, 1, 1, 2, 3]), min_size=1, max_size=30)
skylines = steps.map(lambda up: under((np.cumsum(up) - min(np.cumsum(up)) + 1).tolist()))


@given(labels=st.one_of(label_images(), skylines, skylines.map(np.rot90)))
@example(irregular(0, 20, 90, 60))
@example(coursed(1, 4, 120, gap_px=1))
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
