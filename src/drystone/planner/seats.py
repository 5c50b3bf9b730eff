"""How surely stones rest where they are planned (DESIGN 4.10).

Beside the wall as planned some stand as a builder would have built it: each stone a little aside,
turned, and of another shape than it was seen.  A place is tried in all of them, and a stone that
falls there is laid elsewhere; what fell all the same is put where it was planned.
"""

from collections import Counter, defaultdict
from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from drystone.kernels.polygons import Points, Polygons, area_and_centroid, no_polygons
from drystone.kernels.profiles import Floats
from drystone.model.builder import HAND, NUMBERS, BuilderErrors, Built
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall, outlined
from drystone.planner.vary import TRIAL_DRAWS
from drystone.poses import RecentlyUsed
from drystone.settle.putting import fallen_share, moved, put_down
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import in_order

NEAR = 1.0
"""What is farther from a stone than this, over its size, takes no part when it is put down."""

MARGIN = 1.25
"""A place is tried with a hand's errors times this, so that it is sure with some to spare."""

FALL = 4.0
"""A stone that would fall in all trials is laid when it is larger than so many mean stones."""

KNOWN_BYTES = 1 << 26
"""Trials that are remembered at most, about: fifty thousand."""


class SeatTrial(NamedTuple):
    """What became of a stone that was put down with errors."""

    fell: bool
    corners: Points  # where it rests; as planned where it fell
    pushed: dict[int, float]  # by how much which polygons of those near it are pushed along x


class _TriedPlace(NamedTuple):
    """A place of a stone: what is the same in all trials."""

    group: Group
    key: tuple[object, ...]  # what tells it from others
    low: Points  # lower left and upper right corner of the box of what is near
    high: Points
    x: float  # of the centroid
    y: float
    wedges: list[Points]

    @classmethod
    def of(cls, group: Group) -> "_TriedPlace":
        """Return where a group is planned."""
        placement = group.placement
        stone, at = placement.posed.stone, placement.exact
        far = NEAR * stone.area_px**0.5
        wedges = [corners for _, corners in outlined(placement, group.wedges)[1:]]
        return cls(
            group,
            (stone.id, placement.posed.angle_deg, at.x_px, at.y_px, *(w.tobytes() for w in wedges)),
            at.corners.min(axis=0) - far,
            at.corners.max(axis=0) + far,
            *area_and_centroid(at.corners)[1:],
            wedges,
        )

    def near(self, built: Polygons) -> list[int]:
        """List the polygons that take part when the stone is put down."""
        left, bottom, right, top = built.boxes.T
        across = (left <= self.high[0]) & (right >= self.low[0])
        return np.flatnonzero(across & (bottom <= self.high[1]) & (top >= self.low[1])).tolist()


class Seats:
    """Tries places; every stone has errors of its own, the same wherever it is laid.

    `mean_size` is the mean over the stones of the set of the root of their area, source px.  What
    is remembered makes it quicker and changes nothing.
    """

    def __init__(
        self,
        mean_size: float,
        settle: SettleSettings,
        mu: float,
        pinned: Collection[int] = (),
    ) -> None:
        self.mean_size = mean_size
        self._settle, self._mu = settle, mu
        self._pinned = pinned
        self._errors = BuilderErrors.of_precision(MARGIN * HAND, mean_size)
        self._known = RecentlyUsed[tuple[object, ...], SeatTrial](KNOWN_BYTES)
        self._numbers: dict[int, Floats] = {}  # what is drawn for each stone
        self._falls = defaultdict[int, Counter[int]](Counter)  # of each stone: in which trials
        self._put: tuple[Group | None, list[Built]] = None, []
        self._last: tuple[tuple[Group, ...], list[Polygons]] = (), []

    def bearable(self, stone: Stone) -> float:
        """Return in which share of the trials a stone may fall where no other place is sure.

        The wall lacks more where a large one is left out, and pinned ones must be in it.
        """
        if stone.id in self._pinned:
            return 1.0
        return stone.area_px / self.mean_size**2 / FALL

    def falls(self, group: Group, wall: Wall) -> float | None:
        """Return in which share of the trials a stone falls that is laid next.

        None where it falls in more of them than is bearable: then not all need to be made.
        """
        most = self.bearable(group.placement.posed.stone)
        fallen, trials = 0, self._settle.trials
        walls, falls = self._built(wall.groups), self._falls[group.placement.stone_id]
        place = _TriedPlace.of(group)
        # Where it fell elsewhere it may fall here: the sooner it is known that it falls too often.
        for k in sorted(range(trials), key=falls.__getitem__, reverse=True):
            if self._trial(place, k, walls[k], place.near(walls[k])).fell:
                fallen += 1
                falls[k] += 1
            if fallen > most * trials:
                return None
        return fallen / trials if trials else 0.0

    def _built(self, groups: tuple[Group, ...]) -> list[Polygons]:
        """Return the walls of all trials after some steps, the wedges of each before its stone."""
        done, walls = self._last
        known = len(done) <= len(groups) and all(a is b for a, b in zip(done, groups, strict=False))
        if not (done and known):
            done, walls = (), [no_polygons()] * self._settle.trials
        walls = list(walls)
        for group in groups[len(done) :]:
            place = _TriedPlace.of(group)
            for k, built in enumerate(walls):
                near = place.near(built)
                trial = self._trial(place, k, built, near)
                pushed = {near[i]: x for i, x in trial.pushed.items() if i < len(near)}
                walls[k] = moved(built, pushed).added([*place.wedges, trial.corners])
        self._last = groups, walls
        return walls

    def _trial(self, place: _TriedPlace, k: int, built: Polygons, near: list[int]) -> SeatTrial:
        """Put a stone down with its errors of a trial, in the wall of that trial."""
        key = k, built.boxes[near].tobytes(), place.key
        known = self._known.get(key)
        if known is not None:
            return known
        around = in_order(built, near)
        rest, pushed = put_down(
            self._as_built(place.group)[k],
            around.added(place.wedges) if place.wedges else around,
            self._mu,
            self._settle,
        )
        trial = SeatTrial(True, place.group.placement.exact.corners, {})
        if rest is not None:
            way = rest.x - place.x, rest.y - place.y
            if fallen_share(*way, rest.angle_deg, rest.size) <= 1.0:
                trial = SeatTrial(False, rest.corners, pushed)
        return self._known.keep(key, trial, 600 + trial.corners.nbytes + 40 * len(near))

    def _as_built(self, group: Group) -> list[Built]:
        """Return how a stone is put down in all trials, with the same errors wherever it is."""
        if self._put[0] is not group:
            stone = group.placement.stone_id
            if stone not in self._numbers:
                rngs = [
                    np.random.default_rng([TRIAL_DRAWS, k, stone])
                    for k in range(self._settle.trials)
                ]
                self._numbers[stone] = np.array([rng.standard_normal(NUMBERS) for rng in rngs])
            corners = group.placement.exact.corners
            self._put = group, self._errors.all_built(corners, self._numbers[stone])
        return self._put[1]
