"""Random piles of polygons, and one more that was let down on them without turning."""

from hypothesis import strategies as st

from drystone.kernels.polygons import no_polygons
from tests.naive.crevice import drop
from tests.polygons import moved, simple_polygons

WIDTH = 60.0


def let_down(stone, around, gap):
    """The stone above what it meets first on its way down."""
    high = moved(stone, 0.0, 200.0 - float(stone[:, 1].min()))
    return moved(high, 0.0, gap - drop(high, around))


@st.composite
def piles(draw, most=4, gap=0.02):
    """A stone somewhere on up to so many others, a gap above the first that it meets."""
    around = no_polygons()
    for polygon in draw(st.lists(simple_polygons(max_size=25.0), max_size=most)):
        x = draw(st.floats(10.0, 50.0))
        around = around.added([let_down(moved(polygon, x), around, gap)])
    stone = draw(simple_polygons(max_size=30.0))
    return let_down(moved(stone, draw(st.floats(10.0, 50.0))), around, gap), around
