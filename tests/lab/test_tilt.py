"""The table of tilted walls: what counts as agreement."""

from types import SimpleNamespace

import numpy as np
import pytest

from drystone_lab import tilt
from drystone_lab.table import BenchSettings


def compared(associative, nonassociative, motion, *, fell=False):
    simulated = SimpleNamespace(
        direction="left", fell_at_rest=fell, settled_shift=0.1, interval=lambda _: motion
    )
    return SimpleNamespace(
        simulated=simulated, associative=associative, nonassociative=nonassociative
    )


@pytest.mark.parametrize(
    ("one", "agreement"),
    [
        (compared(0.5, 0.4, (0.39, 0.41)), "yes"),
        (compared(0.5, 0.4, (0.41, 0.42)), "no"),
        (compared(0.5, 0.4, None), "no"),
        (compared(0.5, None, (0.1, 0.2)), "no"),
        (compared(None, None, None, fell=True), "both fall"),
        (compared(0.5, 0.4, None, fell=True), "no"),
        (compared(0.5, 0.4, (0.0, 0.5), fell=True), "no"),
        (compared(None, None, (0.1, 0.2)), "no"),
    ],
)
def test_what_counts_as_agreement(one, agreement):
    assert tilt._row("wall", one)[5] == agreement


def test_a_picture_is_tilted_and_predicted():
    """A stone of 20 x 40 px topples at .5, whatever the flow rule."""
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    wall = SimpleNamespace(name="stone", stages=(np.ones((40, 20), np.uint32),), mu=0.58)
    for row in tilt._rows(wall, BenchSettings(quick=True)):
        assert row[2:4] == pytest.approx((0.5, 0.5))
        low, high = (float(end) for end in row[4].split(" to "))
        assert low == pytest.approx(0.5, abs=0.01)
        assert low < high < low + 0.01
