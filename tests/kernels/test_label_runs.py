"""Runs of labels and their pieces, against pixels and SciPy's pieces."""

import numpy as np
import pytest
from hypothesis import given
from scipy import ndimage

from drystone.kernels.label_runs import label_runs, runs_in_pieces
from tests.strategies import label_images, repeatable


@given(labels=label_images())
@repeatable(100)
def test_runs_paint_the_image_and_are_as_long_as_they_can_be(labels):
    runs = label_runs(labels)
    painted = np.zeros_like(labels)
    places = zip(runs.labels, runs.rows, runs.begins, runs.ends, strict=True)
    for label, row, begin, end in places:
        assert begin < end
        assert not painted[row, begin:end].any()
        painted[row, begin:end] = label
        assert begin == 0 or labels[row, begin - 1] != label
        assert end == labels.shape[1] or labels[row, end] != label
    assert (painted == labels).all()
    assert (runs.lengths == runs.ends - runs.begins).all()
    order = list(zip(runs.rows.tolist(), runs.begins.tolist(), strict=True))
    assert order == sorted(order)


@given(labels=label_images())
@repeatable(100)
def test_pieces_are_those_of_every_label_alone(labels):
    runs = label_runs(labels)
    numbers = runs_in_pieces(runs)
    assert sorted(set(numbers.tolist())) == list(range(numbers.max(initial=-1) + 1))
    found = np.zeros(labels.shape, int)
    for number, row, begin, end in zip(numbers, runs.rows, runs.begins, runs.ends, strict=True):
        found[row, begin:end] = number + 1
    for label in np.unique(labels[labels > 0]):
        pieces, count = ndimage.label(labels == label, np.ones((3, 3)))
        pairs = {tuple(pair) for pair in zip(pieces.ravel(), found.ravel(), strict=True)}
        pairs = {pair for pair in pairs if pair[0]}
        assert len(pairs) == count == len({pair[1] for pair in pairs})


@pytest.mark.parametrize("shape", [(0, 0), (0, 4), (4, 0), (2, 3)])
def test_nothing_has_no_runs(shape):
    runs = label_runs(np.zeros(shape, np.uint32))
    assert len(runs.rows) == len(runs_in_pieces(runs)) == 0
