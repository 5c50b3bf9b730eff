"""Columns of the limit analysis: against plain loops."""

import numpy as np
import pytest

from drystone.kernels.cones import GROUND_BODY, cone_edges


def columns(found, length):
    parts = [list(part) for part in zip(*found, strict=True)] or [[], [], [], []]
    return cone_edges(*parts, length)


def test_points_may_be_slices_of_one_array():
    everything = np.arange(24.0).reshape(4, 6)
    wrench = [((1, 2.0, 3.0), (0, 5.0, 1.0)), ((2, 0.0, 1.0), GROUND_BODY)]
    slices = [everything[:2, 1:3], everything[1::2, ::3]]
    found = list(zip(wrench, [(0.6, 0.8), (1.0, 0.0)], [0.5, 0.7], slices, strict=True))
    whole = [(*part[:3], part[3].copy()) for part in found]
    for fast, slow in zip(columns(found, 3.0), columns(whole, 3.0), strict=True):
        assert np.array_equal(fast, slow)


def test_what_does_not_fit_together_is_refused():
    one = (((0, 0.0, 0.0), GROUND_BODY), (0.0, 1.0), 0.5, np.zeros((1, 2)))
    parts = [[part] for part in one]
    for k in range(4):
        with pytest.raises(ValueError, match="interfaces"):
            cone_edges(*parts[:k], parts[k] * 2, *parts[k + 1 :], 1.0)
    with pytest.raises(ValueError, match="points"):
        cone_edges(*parts[:3], [np.zeros((2, 3))], 1.0)
