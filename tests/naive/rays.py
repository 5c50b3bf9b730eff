"""Slow, obvious twin of the local filling ratio: rays are painted on images (Eq. 4, Fig. 7)."""

import numpy as np

from tests.naive.indices import painted


def local_filling_ratio(occupied, mask, row, col):
    return filling_on_images(occupied, painted(occupied.shape, mask, row, col))


def filling_on_images(occupied, stone):
    """Eq. 4 of a painted stone."""
    left = np.logical_or.accumulate(stone[:, ::-1], axis=1)[:, ::-1]
    swept = (left | np.logical_or.accumulate(stone, axis=0)) & ~stone
    count = int(np.count_nonzero(swept))
    return float(np.count_nonzero(swept & occupied) / count) if count else 1.0
