"""Stones drawn to the corner, and dilated."""

import numpy as np

from drystone.model.wall import Labels
from drystone_lab.reproduce.masons import dilated, drawn_together


def _blocks() -> Labels:
    labels = np.zeros((12, 30), np.uint32)
    labels[7:11, 3:9] = 5
    labels[6:11, 12:19] = 2
    labels[1:4, 5:15] = 9
    labels[2:5, 20:27] = 300
    return labels


def _distance(labels: Labels, block: int) -> float:
    row, col = np.argwhere(labels == block).mean(axis=0)
    return float(np.hypot(labels.shape[0] - 0.5 - row, col + 0.5))


def test_stones_keep_their_shape_and_come_nearer_until_they_are_stopped() -> None:
    before = _blocks()
    after = drawn_together(before)
    assert after.dtype == before.dtype
    for block in (5, 2, 9, 300):
        old, new = np.argwhere(before == block), np.argwhere(after == block)
        assert np.array_equal(old - old.min(axis=0), new - new.min(axis=0))
        assert _distance(after, block) <= _distance(before, block)
    # The first goes into the corner, the second on top of it; the third ends beside that one.
    assert np.argwhere(after == 5).min(axis=0).tolist() == [8, 0]
    assert np.argwhere(after == 9).min(axis=0).tolist() == [5, 0]
    assert np.argwhere(after == 2).min(axis=0).tolist() == [7, 10]


def test_dilation_is_by_one_pixel_and_takes_nothing_from_others() -> None:
    before = _blocks()
    after = dilated(before)
    assert np.array_equal(after[before > 0], before[before > 0])
    for row, col in np.ndindex(*before.shape):
        around = before[max(row - 1, 0) : row + 2, max(col - 1, 0) : col + 2]
        reached = set(around[around > 0].tolist())
        here = int(before[row, col])
        assert int(after[row, col]) == (here or min(reached, default=0))
    assert after.dtype == before.dtype
