"""Random piles of polygons, and one more that was let down on them without turning."""

import numpy as np
from hypothesis import strategies as st

from drystone.kernels.polygons import Points, Polygons, no_polygons
from tests.naive.crevice import drop
from tests.polygons import simple_polygons
from tests.strategies import Draw

WIDTH = 60.0


def moved(polygon: Points, x: float, y: float = 0.0) -> Points:
    """The same polygon somewhere else."""
    return np.asarray(polygon + np.array([x, y]))


def let_down(stone: Points, around: Polygons, gap: float) -> Points:
    """The stone above what it meets first on its way down."""
    high = moved(stone, 0.0, 200.0 - float(stone[:, 1].min()))
    return moved(high, 0.0, gap - drop(high, around))


@st.composite
def piles(draw: Draw, most: int = 4, gap: float = 0.02) -> tuple[Points, Polygons]:
    """A stone somewhere on up to so many others, a gap above the first that it meets."""
    around = no_polygons()
    for polygon in draw(st.lists(simple_polygons(max_size=25.0), max_size=most)):
        x = draw(st.floats(10.0, 50.0))
        around = around.added([let_down(moved(polygon, x), around, gap)])
    stone = draw(simple_polygons(max_size=30.0))
    return let_down(moved(stone, draw(st.floats(10.0, 50.0))), around, gap), around
