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
