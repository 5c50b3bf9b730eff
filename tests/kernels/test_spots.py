"""The best places: compiled and NumPy against sorting all of them (§3.6)."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.backend import compiled
from drystone.kernels.bits import bit_landscape
from drystone.kernels.lowering import Positions, skyline
from drystone.kernels.merits import SnugWeights
from drystone.kernels.raster import Mask
from drystone.kernels.rays import RaySums, RaySumsNumpy, ray_sums
from drystone.kernels.silhouette import Ints, Silhouette, silhouette
from drystone.kernels.spots import (
    best,
    best_by_eq12,
    best_by_eq12_numpy,
    best_by_height,
    best_by_height_numpy,
    best_by_snugness,
    best_by_snugness_numpy,
)
from tests.strategies import Draw, landscapes, masks, repeatable

absent = pytest.mark.skipif(compiled("spots") is None, reason="kernels are not compiled here")
wanted = st.sampled_from([1, 2, 5, 1000])
WEIGHTS = [(0, 0, 0, 0), (0, 0, -0.5, 0), (0, -0.5, 0, 0), (1.6, 0.5, 0.7, 0.25), (0, 1, 1, -0.5)]


@st.composite
def scenes(draw: Draw) -> "Scene":
    """Some have a floor, so that rays downwards are filled, with dents in it."""
    occupied, floor = draw(landscapes()), draw(st.integers(0, 12))
    occupied[occupied.shape[0] - floor :] = True
    occupied[-floor - 1 :, draw(st.lists(st.integers(0, occupied.shape[1] - 1), max_size=3))] = (
        False
    )
    return Scene.of(occupied, draw(masks(8)))


@dataclass
class Scene:
    """A landscape, a mask, and the places where it rests."""

    top: Ints
    rays: RaySums
    slow_rays: RaySums
    outline: Silhouette
    positions: Positions

    @classmethod
    def of(cls, occupied: Mask, mask: Mask) -> "Scene":
        top, outline = skyline(occupied), silhouette(mask)
        first = int(top.min())
        positions = bit_landscape(occupied, top).resting(outline)
        rays, slow_rays = ray_sums(occupied, first), RaySumsNumpy(occupied, first)
        return cls(top, rays, slow_rays, outline, positions)

    @property
    def built(self) -> int:
        return self.rays.height - int(self.top.min())


@absent
@repeatable(200)
@given(
    scene=scenes(),
    anchor=st.integers(0, 511),
    beta=st.sampled_from([0.0, 0.3, 0.7, 1.0]),
    tries=wanted,
)
def test_eq12_compiled_is_eq12_in_numpy(scene: Scene, anchor: int, beta: float, tries: int) -> None:
    rest = (scene.built, anchor / 64, beta, tries)
    assert best_by_eq12(scene.positions, scene.outline, scene.rays, *rest) == best_by_eq12_numpy(
        scene.positions, scene.outline, scene.slow_rays, *rest
    )


@absent
@repeatable(100)
@given(scene=scenes(), tries=wanted)
def test_lowest_compiled_is_lowest_in_numpy(scene: Scene, tries: int) -> None:
    fast = best_by_height(scene.positions, scene.outline, scene.rays, tries)
    assert fast == best_by_height_numpy(scene.positions, scene.outline, scene.slow_rays, tries)


@absent
@repeatable(200)
@given(scene=scenes(), weights=st.sampled_from(WEIGHTS), tries=wanted)
def test_snugness_compiled_is_snugness_in_numpy(
    scene: Scene, weights: tuple[float, float, float, float], tries: int
) -> None:
    costs = SnugWeights(*weights)
    fast = best_by_snugness(scene.positions, scene.outline, scene.top, scene.rays, costs, tries)
    assert fast == best_by_snugness_numpy(
        scene.positions, scene.outline, scene.top, scene.slow_rays, costs, tries
    )


def test_a_place_further_on_is_not_passed_over_when_its_rays_are_all_filled() -> None:
    occupied = np.zeros((20, 100), bool)
    occupied[5:, :50] = occupied[10:, :] = occupied[:, 99] = True
    # Voids under the upper step, in whose corner is the most promising place.
    occupied[10:19, :40] = np.arange(40) % 10 == 5
    scene = Scene.of(occupied, np.ones((5, 10), bool))
    rest = (scene.built, 5.0, 0.7, 1)
    for choose, rays in (best_by_eq12, scene.rays), (best_by_eq12_numpy, scene.slow_rays):
        (place,) = choose(scene.positions, scene.outline, rays, *rest)
        assert (place.row, place.col) == (5, 50)
        assert place.merit == round((1 + 1 - 0.55) * 1e12)


@repeatable(100)
@given(data=st.data(), tries=st.integers(1, 9))
def test_the_best_are_the_first_of_all_sorted(data: st.DataObject, tries: int) -> None:
    worth = st.sampled_from([0.0, 0.5, 0.5 + 1e-14, 0.5 + 1e-11, 1.0])
    at = sorted(data.draw(st.sets(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=1)))
    merits = {p: data.draw(worth) for p in at}
    arrays = np.array([merits[p] for p in at]), np.array(at)
    ranked = sorted(at, key=lambda p: (-round(merits[p], 12), -p[0], p[1]))
    assert [(row, col) for _, row, col in best(*arrays, tries)] == ranked[:tries]
    ranked = sorted(at, key=lambda p: (-p[0], -round(merits[p], 12), p[1]))
    lowest = best(*arrays, tries, lowest_first=True)
    assert [(row, col) for _, row, col in lowest] == ranked[:tries]
    assert all(merit == round(merits[row, col] * 1e12) for merit, row, col in lowest)


@absent
def test_compiled_code_does_not_read_outside_the_image() -> None:
    scene = Scene.of(np.zeros((3, 4), bool), np.ones((2, 2), bool))
    outside = np.array([[0, 0], [2, 0]])
    with pytest.raises(IndexError, match="leaves"):
        best_by_eq12(outside, scene.outline, scene.rays, 0, 1.0, 0.7, 1)
    with pytest.raises(IndexError, match="leaves"):
        best_by_height(outside, scene.outline, scene.rays, 1)
    with pytest.raises(IndexError, match="leaves"):
        best_by_snugness(outside, scene.outline, scene.top, scene.rays, SnugWeights(1, 1, 1, 1), 1)
