"""The placement rule of our own: void, gap, height, end."""

import numpy as np
import pytest
from hypothesis import given

from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.feasible import feasible_positions
from drystone.placement.settings import PlacementSettings
from drystone.placement.snug import snug_objective
from tests.naive import placement as naive
from tests.strategies import posed_on_walls, repeatable


def merit(scene: tuple[Wall, PosedStone, int, int], **weights: float) -> np.ndarray:
    """Merit of all positions from above, with all other weights zero."""
    names = ("height_weight", "void_weight", "gap_weight", "end_weight")
    settings = PlacementSettings(**{name: weights.get(name, 0.0) for name in names})  # type: ignore[arg-type]
    wall, posed, _, _ = scene
    landscape = Landscape.of(wall)
    return snug_objective(landscape, posed, places(scene), settings)


def places(scene: tuple[Wall, PosedStone, int, int]) -> np.ndarray:
    return feasible_positions(Landscape.of(scene[0]), scene[1], "above")


@repeatable(40)
@given(scene=posed_on_walls())
def test_void_gap_height_and_end_are_counted_pixel_by_pixel(
    scene: tuple[Wall, PosedStone, int, int],
) -> None:
    wall, posed, _, _ = scene
    at = [(row, col) for row, col in places(scene).tolist()]
    void = [naive.void_below(wall.occupied, posed.mask, p) / posed.area_px for p in at]
    gap = [min(1.0, naive.gap_beside(wall.occupied, posed.mask, p) / posed.area_px) for p in at]
    bottom = [(wall.site.height_px - p[0] - posed.height_px) / posed.height_px for p in at]
    end = [p[1] / wall.site.width_px for p in at]
    assert merit(scene, void_weight=1) == pytest.approx([-v for v in void])
    assert merit(scene, gap_weight=1) == pytest.approx([-g for g in gap])
    assert merit(scene, height_weight=1) == pytest.approx([-b for b in bottom])
    assert merit(scene, end_weight=1) == pytest.approx([-e for e in end])
    together = merit(scene, void_weight=1, gap_weight=2, height_weight=3, end_weight=4)
    assert together == pytest.approx(
        [-v - 2 * g - 3 * b - 4 * e for v, g, b, e in zip(void, gap, bottom, end, strict=True)]
    )
