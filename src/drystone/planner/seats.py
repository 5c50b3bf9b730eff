"""How surely stones rest where they are planned: the wall is built some times with a builder's errors.

Beside the wall as planned stand a few as a builder would have it (DESIGN 4.10): each stone a little
aside, turned, and of another shape than it was seen.  A place is tried in all of them; a stone that
falls there is laid elsewhere.
"""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from drystone.kernels.polygons import Points, Polygons, no_polygons
from drystone.model.builder import WEDGE_SHARE, BuilderErrors, Built, misjudged
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall, outlined
from drystone.poses import wrap_deg
from drystone.settle.book import OutlineBook
from drystone.settle.putting import fallen_share, moved, put_down
from drystone.settle.settings import SettleSettings

PRECISION = float(os.environ.get("DS_PREC", "0.025"))
"""Of the errors: between those of a robot and of a hand."""


NEAR_PX = 1.0


class _Laid(NamedTuple):
    """What became of a step in one of the walls."""

    blocks: list[Points]  # corners of its wedges, and of the stone last
    pushed: dict[int, float]  # by how much which blocks that were there are pushed along x
    fell: bool  # then it is where it was planned


class _Seen(NamedTuple):
    """How a stone is misjudged, and how it is put down beside its place."""

    outline: Points  # of the stone, not turned
    aside: float
    turned_deg: float


@dataclass(frozen=True, eq=False)
class Seats:
    """Builds walls with errors; every stone has errors of its own, the same wherever it lies."""

    mean_size: float  # of the stones of the set, source px
    book: OutlineBook
    settle: SettleSettings
    mu: float
    _seen: dict[int, list[_Seen]] = field(default_factory=dict, init=False, repr=False)
    _refused: set[tuple[float, ...]] = field(default_factory=set, init=False, repr=False)
    _laid: WeakKeyDictionary[Group, list[_Laid]] = field(
        default_factory=WeakKeyDictionary, init=False, repr=False
    )
    _last: list[tuple[tuple[Group, ...], list[Polygons]]] = field(
        default_factory=list, init=False, repr=False
    )

    def refused(self, group: Group, wall: Wall) -> bool:
        """Say whether a stone was refused at this very place of what is built."""
        return self._key(group, wall) in self._refused

    def _key(self, group: Group, wall: Wall) -> tuple[float, ...]:
        """Return what tells a place: a stone, where it lies, and how many blocks are near."""
        placement = group.placement
        settled, posed = placement.exact, placement.posed
        low, high = settled.corners.min(axis=0), settled.corners.max(axis=0)
        boxes = wall.exact.polygons.boxes
        near = (boxes[:, :2] <= high + NEAR_PX).all(axis=1) & (boxes[:, 2:] >= low - NEAR_PX).all(axis=1)
        ids = wall.exact.ids
        return (
            posed.stone.id, settled.x_px, settled.y_px, posed.angle_deg,
            *(ids[i] for i in np.flatnonzero(near).tolist())
        )

    def falls(self, group: Group, wall: Wall, most: float) -> float:
        """Return in which share of the walls a stone falls that is laid after the steps before.

        1 when it is more than `most`.
        """
        laid, trials = list[_Laid](), self.settle.trials
        for one in self._laying(group, self._walls(wall.groups)):
            laid.append(one)
            if sum(one.fell for one in laid) > most * trials:
                self._refused.add(self._key(group, wall))
                return 1.0
        self._laid[group] = laid
        return sum(one.fell for one in laid) / trials if trials else 0.0

    def _walls(self, groups: tuple[Group, ...]) -> list[Polygons]:
        """Return the walls after some steps; those of the last call are at hand."""
        done, walls = self._last[0] if self._last else ((), [])
        if not (0 < len(done) <= len(groups) and all(a is b for a, b in zip(done, groups))):
            done, walls = (), [no_polygons()] * self.settle.trials
        for group in groups[len(done) :]:
            laid = self._laid.get(group)
            if laid is None:
                laid = self._laid[group] = list(self._laying(group, walls))
            walls = [moved(w, one.pushed).added(one.blocks) for w, one in zip(walls, laid)]
        self._last[:] = [(groups, walls)]
        return walls

    def _laying(self, group: Group, walls: list[Polygons]) -> Iterator[_Laid]:
        """Take a step in all walls, one after the other."""
        placement = group.placement
        settled, outline = placement.exact, self.book.outline(placement.posed.stone)
        planned = Built(outline, settled.x_px, settled.y_px, placement.posed.angle_deg)
        wedges = [corners for _, corners in outlined(placement, group.wedges)[1:]]
        for seen, wall in zip(self._errors(placement.posed.stone), walls, strict=True):
            yield self._put(planned, seen, wedges, wall)

    def _put(self, planned: Built, seen: _Seen, wedges: Sequence[Points], wall: Polygons) -> _Laid:
        around = wall.added(wedges) if wedges else wall
        angle_deg = planned.angle_deg
        put = Built(seen.outline, planned.x + seen.aside, planned.y, angle_deg + seen.turned_deg)
        rest, pushed = put_down(put, around, self.mu, self.settle)
        if rest is None:
            return _Laid([*wedges, planned.corners], {}, True)
        way = rest.x - planned.x, rest.y - planned.y
        if fallen_share(*way, wrap_deg(rest.angle_deg - angle_deg), planned.size) > 1.0:
            return _Laid([*wedges, planned.corners], {}, True)
        pushed = {i: x for i, x in pushed.items() if i < len(wall)}
        return _Laid([*wedges, rest.corners], pushed, False)

    def _errors(self, stone: Stone) -> list[_Seen]:
        """Return how a stone is misjudged, and how far it is put aside and turned, each time."""
        if stone.id not in self._seen:
            errors = BuilderErrors.of_precision(PRECISION, self.mean_size)
            rng = np.random.default_rng([7, stone.id])
            found = []
            for _ in range(self.settle.trials):
                outline = misjudged(self.book.outline(stone), errors.outline, rng)
                aside, turned = rng.standard_normal(2).tolist()
                found.append(_Seen(outline, errors.placement * aside, errors.angle_deg * turned))
            self._seen[stone.id] = found
        return self._seen[stone.id]
