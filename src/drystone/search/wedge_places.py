"""Where a wedge could go in a finished wall, and whether it would stand in the way of its failure.

In an associative limit analysis a contact that is added can only raise the load multiplier, and
does so only if the mechanism in which the wall fails would close it, or slide along it without
opening it as much as friction asks for.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from drystone.contacts.settled import PlacedPolygons
from drystone.kernels.meetings import meetings
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.wedge_shape import open_sides
from drystone.settle.wedge import WedgeLimits, rests, wedges_below
from drystone.statics.model import GROUND

Ids = NDArray[np.int64]
Twist = tuple[float, float, float]
"""How a block moves: velocity of its point at the origin of the wall frame, rate of turning."""

STILL: Twist = (0.0, 0.0, 0.0)
SLOW = 1e-9
"""What moves no faster than this stands still; the fastest block has a velocity of 1."""


@dataclass(frozen=True, eq=False)
class WedgePlace:
    """A wedge that has room in a finished wall, and what it would touch."""

    step: int  # Which step places the stone that would lie on it
    corners: Points  # (n, 2) Its outline in the wall frame, counter-clockwise, source px
    # (m,) At each contact point, the id of the block that it touches; GROUND for the ground
    others: Ids
    points: Points  # (m, 2) The contact points, and unit vectors into the wedge
    normals: Points

    @classmethod
    def of(
        cls, step: int, corners: Points, placed: PlacedPolygons, limits: WedgeLimits
    ) -> "WedgePlace":
        """Find what a wedge touches of all blocks of a wall."""
        found = meetings(corners, placed.polygons, limits.contact_px, limits.setback)
        ids = [placed.ids[other] if other >= 0 else GROUND for other in found.others.tolist()]
        # A contact at a point comes twice, which changes no rate.
        return cls(
            step,
            corners,
            np.repeat(np.array(ids, np.int64), 2),
            found.points.reshape(-1, 2),
            np.repeat(found.normals, 2, axis=0),
        )

    @cached_property
    def area_px(self) -> float:
        """Its area, square source px."""
        return area_and_centroid(self.corners)[0]

    @cached_property
    def carriers(self) -> Ids:
        """Ids of what it touches, each once, ascending."""
        return np.unique(self.others)


def wedge_places(
    placed: PlacedPolygons, step: int, first: int, width: float, limits: WedgeLimits
) -> Iterator[WedgePlace]:
    """List wedges under a stone of a finished wall.

    They overlap nothing that is there, rest on what was there before the stone, and have something
    beside them at both sides.
    """
    before = placed.polygons.leading(first)
    for corners in wedges_below(placed.polygons, first, limits):
        if rests(corners, before, width, limits) and not any(open_sides(corners, placed.polygons)):
            yield WedgePlace.of(step, corners, placed, limits)


@dataclass(frozen=True, eq=False)
class Motion:
    """How the blocks of a wall move in a mechanism."""

    twists: Mapping[int, Twist]  # Of all blocks, by id, and of the ground
    mu: float  # Coefficient of friction

    @classmethod
    def of(
        cls,
        velocity: Mapping[int, Sequence[float]],
        centroids: Mapping[int, tuple[float, float]],
        mu: float,
    ) -> "Motion":
        """Make it of the velocities of centroids and the rates of turning of the free blocks."""
        twists = {GROUND: STILL}
        for block, (x, y) in centroids.items():
            along, up, turning = velocity.get(block, STILL)
            twists[block] = (along + turning * y, up - turning * x, turning)
        return cls(twists, mu)

    def stands_still(self, blocks: Sequence[int]) -> bool:
        """Say whether none of some blocks moves: nothing between them matters."""
        return all(max(map(abs, self.twists[block])) <= SLOW for block in blocks)

    def resisted_by(self, places: Sequence[WedgePlace]) -> NDArray[np.float64]:
        """Return how fast the mechanism violates the contacts of wedges."""
        rates = np.zeros(len(places))
        touching = [k for k, place in enumerate(places) if len(place.others)]
        if not touching:
            return rates
        met = [places[k] for k in touching]
        counts = np.array([len(place.carriers) for place in met])
        sizes = np.repeat([len(place.others) for place in met], counts)
        # One row for every contact point of a wedge and every neighbour that it moves along with.
        others = np.concatenate([np.tile(place.others, len(place.carriers)) for place in met])
        carriers = np.repeat(np.concatenate([place.carriers for place in met]), sizes)
        x, y = np.concatenate([np.tile(place.points, (len(place.carriers), 1)) for place in met]).T
        out_x, out_y = np.concatenate(
            [np.tile(place.normals, (len(place.carriers), 1)) for place in met]
        ).T
        along, up, turning = (self._rows(carriers) - self._rows(others)).T
        along, up = along - turning * y, up + turning * x
        needed = self.mu * np.abs(along * out_y - up * out_x) - (along * out_x + up * out_y)
        worst = np.maximum.reduceat(needed, np.cumsum(sizes) - sizes)
        rates[touching] = np.minimum.reduceat(worst, np.cumsum(counts) - counts).clip(0.0)
        return rates

    def _rows(self, blocks: Ids) -> NDArray[np.float64]:
        ids, where = np.unique(blocks, return_inverse=True)
        return np.array([self.twists[block] for block in ids.tolist()])[where]
