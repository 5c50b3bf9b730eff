"""What the machine does at best with the things that functions have to touch."""

from collections.abc import Callable

import numpy as np
import pytest

from benchmarks.conftest import Row, Timer
from benchmarks.table import FLOOR

REPEATED = 100
"""Passes a call, so that calls count for little."""

WORDS = 2**12
NEAR, FAR = WORDS, 2**16
"""Words of 8 bytes: three arrays of them stay near the core (96 KB), or do not (1.5 MB)."""


def floors() -> dict[str, tuple[int, Callable[[], object]]]:
    """Return what is done, the number of things, and how."""
    rng = np.random.default_rng(0)
    bits = rng.integers(2**63, size=(2, FAR), dtype=np.uint64)
    result = np.empty_like(bits[0])
    sums, places = rng.integers(2**31, size=280 * 80), rng.integers(280 * 80, size=WORDS)
    taken = np.empty(WORDS, sums.dtype)
    x, y = rng.random((2, WORDS))
    product = np.empty_like(x)

    def axpy() -> None:
        np.multiply(x, 1.5, out=product)
        np.add(y, product, out=product)

    return {
        "64-bit words or'ed, 96 KB": (
            NEAR,
            lambda: np.bitwise_or(bits[0, :NEAR], bits[1, :NEAR], out=result[:NEAR]),
        ),
        "64-bit words or'ed, 1.5 MB": (
            FAR,
            lambda: np.bitwise_or(bits[0], bits[1], out=result),
        ),
        "numbers looked up in 280 x 80": (
            WORDS,
            lambda: np.take(sums, places, out=taken, mode="clip"),
        ),
        "numbers multiplied and added": (WORDS, axpy),
    }


@pytest.mark.parametrize("what", list(floors()))
def test_floor(timer: Timer, what: str) -> None:
    """Do one simple thing with arrays, by NumPy."""
    count, once = floors()[what]

    def call() -> None:
        for _ in range(REPEATED):
            once()

    timer.often(Row(what, FLOOR, 0.0, None, REPEATED, float(count), "numbers"), call)
