"""The mirror image."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.backend import compiled
from drystone.kernels.mirror import mirrored, mirrored_numpy
from drystone.kernels.raster import Mask
from tests.strategies import repeatable

absent = pytest.mark.skipif(compiled("mirror") is None, reason="kernels are not compiled here")


@pytest.mark.parametrize(
    "mirror",
    [
        pytest.param(mirrored_numpy, id="numpy"),
        pytest.param(mirrored, id="compiled", marks=absent),
    ],
)
def test_every_row_is_read_backwards(mirror: Callable[[Mask], Mask]) -> None:
    @repeatable(60)
    @given(width=st.integers(1, 40), height=st.integers(0, 3), seed=st.integers(0, 99))
    def check(width: int, height: int, seed: int) -> None:
        pixels = np.random.default_rng(seed).random((height, width)) < 0.5
        image = mirror(pixels)
        assert image.tolist() == [row[::-1] for row in pixels.tolist()]
        assert image.dtype == bool
        assert image.flags.c_contiguous
        assert np.array_equal(mirror(pixels[:, ::2]), pixels[:, ::2][:, ::-1])

    check()
