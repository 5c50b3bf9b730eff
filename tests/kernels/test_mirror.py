"""The mirror image."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.mirror import mirrored
from tests.strategies import repeatable


def test_every_row_is_read_backwards() -> None:
    @repeatable(60)
    @given(width=st.integers(1, 40), height=st.integers(0, 3), seed=st.integers(0, 99))
    def check(width: int, height: int, seed: int) -> None:
        pixels = np.random.default_rng(seed).random((height, width)) < 0.5
        image = mirrored(pixels)
        assert image.tolist() == [row[::-1] for row in pixels.tolist()]
        assert image.dtype == bool
        assert image.flags.c_contiguous
        assert np.array_equal(mirrored(pixels[:, ::2]), pixels[:, ::2][:, ::-1])

    check()
