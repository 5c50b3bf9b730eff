"""Convex parts: they cover the boundary from inside, and no seam ends at a corner."""

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st

from drystone.physics.convex import convex_parts
from tests.strategies import repeatable

COMB = np.column_stack(
    ([0.0, 5, 5, 4, 4, 3, 3, 2, 2, 1, 1, 0], [0.0, 0, 3, 3, 1, 1, 3, 3, 1, 1, 3, 3])
)
NOSE = np.column_stack(([0, 2.8, 2.8, 3, 3, 2.6, 0.5, 0], [0, 0, 0.2, 0.2, 0.6, 3, 2.8, 3]))
FLAT_CORNER = [1.0, 1, 1, 1, 1, 1, 2, 3, 2, 0.5, 0.3125, 1, 1, 1, 1, 0.5]
"""Of a star: areas of floats leave out its tenth corner."""

WEDGED = np.array([
    (0.9385254601648901, 0.1756715486330724), (0.8253753630296953, 0.2858775754557578),
    (-0.24894082885569405, 0.4635679112255344), (-0.28810120508363907, 0.48837109809676454),
    (-0.41444093868368614, 0.48998325609453613), (-0.5864577328415793, 0.4719174286218747),
    (-0.7047844517979649, 0.4835808526078347), (-0.7972200539204942, 0.2524682931261548),
    (-0.9081543280319734, 0.14464262785096418), (-0.878520850961386, -0.26747131134718166),
    (-0.76688223431812, -0.36134042740488814), (-0.536058431156056, -0.36162454993278836),
    (-0.36986479777748227, -0.3844155562890457), (-0.1357578645590972, -0.37642947586318903),
    (0.05210869436860875, -0.39573009879654114), (0.07286513522746259, -0.39869419393591515),
    (0.1340789397003198, -0.41502478595538744), (0.27655115758140075, -0.4555328425876844),
    (0.7000143139095029, -0.45541006968124464), (0.7935331413766975, -0.4236917151312209),
    (0.8842417844509728, -0.2039224198574251),
])  # fmt: skip
"""A stone of PR of which a part, cut by lines, crosses itself by a rounding error."""

GRID = 2.0**-40
"""Without a grid areas in common come out wrong now and then (drystone.model.overlap)."""


def star(reach):
    angle = np.arange(len(reach)) * 2.0 * np.pi / len(reach)
    return np.array(reach)[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))


@st.composite
def stars(draw):
    """Star-shaped outlines, most of them concave."""
    count = draw(st.integers(3, 24))
    return star(draw(st.lists(st.floats(0.3, 3.0), min_size=count, max_size=count)))


def check(outline):
    """Check the parts of an outline, and return them."""
    parts, whole = list(map(shapely.Polygon, convex_parts(outline))), shapely.Polygon(outline)
    covered = shapely.union_all(parts, grid_size=GRID)
    assert shapely.difference(covered, whole, grid_size=GRID).area < 1e-9 * whole.area
    # Of the boundary nothing is left open, nor just below it.
    assert whole.exterior.difference(covered.buffer(1e-6)).length == 0.0
    skin = shapely.difference(whole, whole.buffer(-1e-3, join_style="mitre"), grid_size=GRID)
    assert shapely.difference(skin, covered, grid_size=GRID).area < 1e-6 * whole.area
    for part in parts:
        assert part.exterior.is_ccw
        assert part.convex_hull.area == pytest.approx(part.area, rel=1e-7)
    return parts


def directions(ring, at):
    """Unit vectors of the edges that come to and leave a corner."""
    ahead = np.roll(ring, -1, axis=0)[at] - ring[at]
    behind = ring[at] - np.roll(ring, 1, axis=0)[at]
    return behind / np.hypot(*behind), ahead / np.hypot(*ahead)


@repeatable(40)
@given(stars())
@example(COMB)
@example(NOSE)
@example(star(FLAT_CORNER))
@example(WEDGED)
def test_parts_cover_the_boundary_and_seams_end_away_from_corners(outline):
    assert len(check(outline)) <= 12 or outline is not COMB
    # At a corner of the outline a part has both faces of it, or passes straight through.
    for part in convex_parts(outline):
        for i, corner in enumerate(part):
            for j in np.flatnonzero(np.hypot(*(outline - corner).T) < 1e-9).tolist():
                arriving, leaving = directions(part, i)
                straight = np.allclose(arriving, leaving, atol=1e-6)
                faces = directions(outline, j)
                assert straight or np.allclose((arriving, leaving), faces, atol=1e-6)


@pytest.mark.parametrize("outline", [COMB, NOSE], ids=["comb", "nose"])
def test_no_part_has_a_corner_at_which_it_does_not_turn(outline):
    between = (outline + np.roll(outline, -1, axis=0)) / 2
    split = np.stack([outline, between], axis=1).reshape(-1, 2)
    for part in (*convex_parts(split), *convex_parts(split[[0, 1, 2, -1]])):
        edges = (np.roll(part, -1, axis=0) - part) @ [1, 1j]
        turn = np.degrees(np.angle(edges / np.roll(edges, 1)))
        assert turn.min() > 1e-3
        assert turn.sum() == pytest.approx(360)
