"""Runs of one label along the rows of an image: what is counted on runs need not see pixels."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Ints = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class LabelRuns:
    """The longest runs of equal labels above 0, row by row; ends are the columns after the last."""

    width: int  # of the image
    labels: NDArray[np.integer]  # (n,) label of each run
    rows: Ints
    begins: Ints
    ends: Ints

    @property
    def lengths(self) -> Ints:
        """Number of pixels of each run."""
        return self.ends - self.begins


def label_runs(labels: NDArray[np.integer]) -> LabelRuns:
    """Find the runs of an image; 0 where nothing is."""
    width = labels.shape[1]
    flat = labels.ravel()
    is_first = np.empty(flat.shape, bool)
    np.not_equal(flat[1:], flat[:-1], out=is_first[1:])
    is_first[:: max(width, 1)] = True
    first = np.flatnonzero(is_first)
    beyond = np.append(first[1:], flat.size)
    taken = flat[first] > 0
    rows, begins = np.divmod(first[taken], max(width, 1))
    return LabelRuns(width, flat[first[taken]], rows, begins, beyond[taken] - rows * width)


def runs_in_pieces(runs: LabelRuns) -> Ints:
    """Return for each run the number of the connected piece of its label, from 0 on without gaps.

    Pixels that meet at a corner connect, too.
    """
    count = len(runs.rows)
    if not count:
        return np.zeros(0, np.intp)
    # In the row below, the runs that a run touches follow one another; runs are in order.
    stride = runs.width + 1
    below = (runs.rows + 1) * stride
    first = np.searchsorted(runs.rows * stride + runs.ends, below + runs.begins)
    last = np.searchsorted(runs.rows * stride + runs.begins, below + runs.ends, side="right")
    touched = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(count), touched)
    lower = np.arange(touched.sum()) + np.repeat(first - np.cumsum(touched) + touched, touched)
    alike = runs.labels[upper] == runs.labels[lower]
    edges = coo_array(
        (np.ones(np.count_nonzero(alike), bool), (upper[alike], lower[alike])), (count, count)
    )
    return np.asarray(connected_components(edges, directed=False)[1], np.intp)
