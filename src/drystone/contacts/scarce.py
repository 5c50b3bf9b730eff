"""Blocks with fewer than two contact points, and what they would touch if gaps were closed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.polygons import Points
from drystone.model.wall import Labels
from drystone.statics.model import GROUND, RigidBlockModel

ENOUGH = 2
"""Contact points without which nothing rests: an interface has two, at its ends."""


@dataclass(frozen=True)
class Scarce:
    """A block that touches too little."""

    block: int
    contacts: int  # contact points that it has, 0 or 1
    nearest: int | None
    """What it would touch next, GROUND (0) for the ground; None when there is nothing else."""
    gap: float  # how wide the gap to it is, px of the image or unit of the polygons


def scarce_contacts(
    model: RigidBlockModel, shapes: Labels | Mapping[int, Points]
) -> tuple[Scarce, ...]:
    """Find the free blocks that have fewer than two contact points, in the order of the model.

    `shapes` is what it was made from: the label image, row 0 at the top, or polygons (n, 2) by id.
    """
    touching: dict[int, set[int]] = {block.id: set() for block in model.blocks if not block.fixed}
    points = dict.fromkeys(touching, 0)
    for face in model.interfaces:
        for one, other in ((face.block, face.other), (face.other, face.block)):
            if one in touching:
                touching[one].add(other)
                points[one] += len(face.points)
    few = [block for block, count in points.items() if count < ENOUGH]
    near = _near_pixels if isinstance(shapes, np.ndarray) else _near_polygons
    return tuple(
        Scarce(block, points[block], *near(shapes, block, touching[block]))  # type: ignore[arg-type]
        for block in few
    )


def _near_pixels(labels: Labels, block: int, others: set[int]) -> tuple[int | None, float]:
    """Return the nearest label that is not touched, and how many px lie between."""
    lowest = np.flatnonzero((labels > 0).any(axis=1))[-1] + 1
    cells = np.vstack([labels[:lowest].astype(np.int64), np.full((1, labels.shape[1]), -1)])
    rows, cols = np.nonzero(cells == block)
    reach = 8
    while True:
        window = (_slice(rows, reach, cells.shape[0]), _slice(cols, reach, cells.shape[1]))
        part = cells[window]
        strangers = (part != 0) & (part != block)
        for other in others:
            strangers &= part != (-1 if other == GROUND else other)
        whole = part.shape == cells.shape
        if strangers.any():
            away = ndimage.distance_transform_edt(part != block)
            distances = np.where(strangers, away, np.inf)
            least = int(np.argmin(distances))
            gap = float(distances.flat[least]) - 1.0
            # Beyond the window there may be something nearer than what is far away in it.
            if gap <= reach or whole:
                found = int(part.flat[least])
                return (GROUND if found == -1 else found), gap
        elif whole:
            return None, np.inf
        reach *= 4


def _slice(places: NDArray[np.int64], reach: int, size: int) -> slice:
    return slice(max(0, int(places.min()) - reach), min(size, int(places.max()) + reach + 1))


def _near_polygons(
    polygons: Mapping[int, Points], block: int, others: set[int]
) -> tuple[int | None, float]:
    """Return the nearest polygon that is not touched, or the ground, and how far it is away."""
    own = shapely.Polygon(polygons[block])
    strangers: Sequence[int] = [i for i in polygons if i != block and i not in others]
    gaps = {i: float(shapely.distance(own, shapely.Polygon(polygons[i]))) for i in strangers}
    if GROUND not in others:
        gaps[GROUND] = max(0.0, float(own.bounds[1]))
    if not gaps:
        return None, np.inf
    nearest = min(gaps, key=gaps.__getitem__)
    return nearest, gaps[nearest]
