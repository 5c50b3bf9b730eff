"""What places are worth, against one position after the other on images (Eq. 5, 12, 13)."""

import numpy as np
import pytest
from hypothesis import given

from drystone.kernels.lowering import lowered_positions_numpy, skyline_numpy
from drystone.kernels.merits import SnugWeights, dice_score, eq12_merits, snug_merits, threshold
from drystone.kernels.rays import RaySumsNumpy
from drystone.kernels.silhouette import silhouette
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from tests.naive import placement as naive
from tests.strategies import posed_on_walls, repeatable

Scene = tuple[Wall, PosedStone, int, int]


@repeatable(40)
@given(scene=posed_on_walls())
def test_eq12_is_that_of_every_position_on_its_own(scene: Scene) -> None:
    wall, posed, _, _ = scene
    at = naive.resting_positions(wall.occupied, posed.mask)[:40]
    rays = RaySumsNumpy(wall.occupied, wall.site.height_px - wall.height_px)
    merits = eq12_merits(
        np.array(at), silhouette(posed.mask), rays, wall.height_px, posed.anchor[0], 0.7
    )
    expected = [naive.eq12(wall.occupied, posed.mask, posed.anchor[0], p, 0.7) for p in at]
    assert merits == pytest.approx(expected, abs=1e-12)


@repeatable(40)
@given(scene=posed_on_walls())
def test_void_gap_height_and_end_are_counted_pixel_by_pixel(scene: Scene) -> None:
    wall, posed, _, _ = scene
    outline, top = silhouette(posed.mask), skyline_numpy(wall.occupied)
    positions = lowered_positions_numpy(top, outline, wall.site.height_px)
    rays = RaySumsNumpy(wall.occupied, wall.site.height_px - wall.height_px)
    at = [(row, col) for row, col in positions.tolist()]
    void = [naive.void_below(wall.occupied, posed.mask, p) / posed.area_px for p in at]
    gap = [min(1.0, naive.gap_beside(wall.occupied, posed.mask, p) / posed.area_px) for p in at]
    height = [(wall.site.height_px - p[0] - posed.height_px) / posed.height_px for p in at]
    end = [p[1] / wall.site.width_px for p in at]

    def merits(*weights: float) -> np.ndarray:
        return snug_merits(positions, outline, top, rays, SnugWeights(*weights))

    assert merits(1, 0, 0, 0) == pytest.approx([-h for h in height])
    assert merits(0, 1, 0, 0) == pytest.approx([-v for v in void])
    assert merits(0, 0, 1, 0) == pytest.approx([-g for g in gap])
    assert merits(0, 0, 0, 1) == pytest.approx([-e for e in end])
    together = zip(height, void, gap, end, strict=True)
    assert merits(3, 1, 2, 4) == pytest.approx(
        [-3 * h - v - 2 * g - 4 * e for h, v, g, e in together]
    )


def test_the_threshold_itself_counts_as_below() -> None:
    assert threshold(np.array([0.0, 0.7, 0.7000001, 1.0]), 0.7).tolist() == [0, 0, 0.7000001, 1.0]


def test_outside_between_and_inside_the_box() -> None:
    found = dice_score(np.array([0, 4, 8], np.int32), 8, 80.0)
    assert found == pytest.approx([0.0, 0.5 * 80 / 84, 1.0])
    assert dice_score(np.array([0], np.int32), 8, 0.0).tolist() == [0.0]
