"""The landscape from both ends: mirrored views, true stones (DESIGN 4.7)."""

import numpy as np
from hypothesis import given

from drystone.model.landscape import Box, Landscape
from drystone.model.placement import Placement
from drystone.model.stone import Stone
from drystone.model.wall import Wall
from drystone.placement.best import best_spots
from drystone.placement.settings import PlacementSettings
from drystone.poses import PoseBook
from tests.naive.indices import extent_of
from tests.strategies import repeatable, walls

L_STONE = Stone(9, np.array([[1, 0, 0], [1, 0, 0], [1, 1, 1]], bool))


@repeatable()
@given(wall=walls())
def test_a_view_is_of_the_pixels_and_that_from_the_right_of_the_mirrored_wall(wall):
    landscape = Landscape.of(wall)
    extents = [extent_of(wall.labels == p.stone_id) for p in wall.placements]
    assert landscape.boxes == tuple(Box(e.x0, e.x1, e.y0, e.y1) for e in extents)
    assert landscape.built_height_px == wall.height_px
    for col in range(landscape.width_px):
        rows = np.flatnonzero(wall.occupied[:, col])
        assert landscape.skyline[col] == (rows[0] if rows.size else landscape.height_px)
    mirrored = Wall.empty(wall.site)
    for p in wall.placements:
        col = wall.site.width_px - p.col - p.posed.width_px
        mirrored = mirrored.add(Placement(p.posed.mirrored, p.row, col))
    right, left = Landscape.of(wall, "right"), Landscape.of(mirrored, "left")
    assert np.array_equal(right.occupied, left.occupied)
    assert right.boxes == left.boxes
    assert (right.width_px, right.height_px) == (wall.site.width_px, wall.site.height_px)


@repeatable()
@given(wall=walls())
def test_places_found_from_the_right_hold_the_true_stone(wall):
    landscape = Landscape.of(wall, "right")
    posed = PoseBook().pose(L_STONE, 0.0)
    seen = landscape.view(posed)
    assert np.array_equal(seen.mask, posed.mask[:, ::-1])
    for spot in best_spots(landscape, [seen], PlacementSettings(tries=1000)):
        col = landscape.view_col(posed, spot.col)
        assert landscape.view_col(posed, col) == spot.col
        next_wall = wall.add(Placement(posed, spot.row, col, "right"))  # refuses any overlap
        window = next_wall.labels[next_wall.placements[-1].window]
        assert np.array_equal(window == L_STONE.id, L_STONE.mask)
