"""How surely stones rest where they are planned (DESIGN 4.10).

Beside the wall as planned some stand as a builder would have built it: each stone a little aside,
turned, and of another shape than it was seen.  A place is tried in all of them.  A stone that falls
there, or under which others fall, is laid elsewhere; what fell all the same is held as planned.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from hashlib import blake2b
from itertools import accumulate, takewhile

import numpy as np

from drystone.kernels.as_built import Built, BuiltWall
from drystone.kernels.profiles import Floats
from drystone.model.builder import HAND, BuilderErrors, as_planned, put_down_with, stratified
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall, outlined
from drystone.planner.vary import TRIAL_DRAWS
from drystone.poses import RecentlyUsed
from drystone.settle.putting import astray, bare_wall, lost
from drystone.settle.settings import SettleSettings

MARGIN = 1.25
"""A place is tried with a hand's errors times this, so that it is sure with some to spare."""

FALL, FALL_OF_MANY, MANY = 19.0, 4.0, 80
"""A stone that would fall in all trials is laid when it is larger than so many mean stones.

So it may fall in one of twenty trials when it has 0.95 of the mean area.  With more than
:data:`MANY` stones a wall hardly ever stays whole, and is to be finished.
"""

KNOWN_BYTES = 1 << 27
"""Walls of trials that are remembered at most, about: those of fifty to a hundred steps."""


class Seats:
    """Tries places; every stone has errors of its own, the same wherever it is laid.

    `mean_size` is the mean over the stones of the set of the root of their area, source px, and
    `count` says how many they are.  What is remembered makes it quicker and changes nothing.
    """

    def __init__(
        self,
        mean_size: float,
        settle: SettleSettings,
        mu: float,
        pinned: Collection[int] = (),
        count: int = 0,
    ) -> None:
        self.mean_size = mean_size
        self._pinned = pinned
        self._fall = FALL if count <= MANY else FALL_OF_MANY
        self._errors = BuilderErrors.of_precision(MARGIN * HAND, mean_size)
        self._bare = [bare_wall(mu, settle)] * settle.trials
        self._known = RecentlyUsed[bytes, list[BuiltWall]](KNOWN_BYTES)  # by what was laid
        self._last: tuple[Sequence[Group], list[bytes]] = (), [b""]  # steps, and their digests
        self._numbers: dict[tuple[int, int], Floats] = {}  # what is drawn for a stone and wedges
        self._falls = defaultdict[int, Counter[int]](Counter)  # of each stone: in which trials

    def bearable(self, stone: Stone) -> float:
        """Return in which share of the trials a stone may fall where no other place is sure.

        The wall lacks more where a large one is left out, and pinned ones must be in it.
        """
        if stone.id in self._pinned:
            return 1.0
        return stone.area_px / self.mean_size**2 / self._fall

    def falls(self, group: Group, wall: Wall, least: float = math.inf) -> float | None:
        """Return in which share of the trials something falls when a stone is laid next.

        None where that is more than is bearable, or not less than `least`: then not all trials
        need to be made.
        """
        laid, walls = self._laid(wall.groups)
        stone, trials, fallen = group.placement.posed.stone, len(walls), 0
        most, falls = self.bearable(stone) * trials, self._falls[stone.id]
        after, pieces, planned = list(walls), self._pieces(group), _planned(group)
        # Where it fell elsewhere it may fall here: the sooner it is known that it falls too often.
        for k in sorted(range(trials), key=falls.__getitem__, reverse=True):
            fell, after[k] = _tried(walls[k], pieces[k], stone.id, planned)
            fallen += fell
            falls[k] += fell
            if fallen > most or fallen / trials >= least:
                return None
        self._keep(_digest(laid, group), after)
        return fallen / trials if trials else 0.0

    def _laid(self, groups: Sequence[Group]) -> tuple[bytes, list[BuiltWall]]:
        """Return what tells some steps from others, and the walls of all trials after them."""
        before, digests = self._last
        pairs = zip(groups, before, strict=False)
        same = sum(1 for _ in takewhile(lambda two: two[0] is two[1], pairs))
        digests = digests[:same] + list(accumulate(groups[same:], _digest, initial=digests[same]))
        self._last = groups, digests
        walls, known = self._bare, 0
        for done in range(len(groups), 0, -1):
            found = self._known.get(digests[done])
            if found is not None:
                walls, known = found, done
                break
        for group, digest in zip(groups[known:], digests[known + 1 :], strict=True):
            put, planned = zip(walls, self._pieces(group), strict=True), _planned(group)
            tried = [_tried(*one, group.placement.stone_id, planned)[1] for one in put]
            walls = self._keep(digest, tried)
        return digests[-1], walls

    def _keep(self, digest: bytes, walls: list[BuiltWall]) -> list[BuiltWall]:
        return self._known.keep(digest, walls, sum(wall.held_bytes for wall in walls))

    def _pieces(self, group: Group) -> list[list[tuple[int, Built]]]:
        """Return how a stone is put down in all trials, with the same errors wherever it is.

        Its wedges come before it.
        """
        blocks = outlined(group.placement, group.wedges)
        stone, trials = group.placement.stone_id, len(self._bare)
        key = stone, len(blocks)
        if key not in self._numbers:
            rng = np.random.default_rng([TRIAL_DRAWS, stone])
            self._numbers[key] = stratified(rng, trials, len(blocks))
        put = put_down_with(self._errors, blocks, self._numbers[key])
        return [pieces[::-1] for pieces in put]


def _planned(group: Group) -> dict[int, Built]:
    return {i: as_planned(corners) for i, corners in outlined(group.placement, group.wedges)}


def _tried(
    wall: BuiltWall, pieces: list[tuple[int, Built]], stone: int, planned: Mapping[int, Built]
) -> tuple[bool, BuiltWall]:
    """Lay a stone in the wall of a trial, and say whether something falls."""
    put = wall.put(pieces)
    rest = put.get(stone)
    if rest is None or astray(rest, planned[stone]):
        return True, wall.held(planned)
    after = put.loaded(stone)
    fell = lost(put, after)
    return (True, put.held({i: put.laid[i] for i in fell})) if fell else (False, after)


def _digest(before: bytes, group: Group) -> bytes:
    """Return what tells some steps of construction from others, after one more."""
    placement, at = group.placement, group.placement.exact
    place = np.array([placement.stone_id, placement.posed.angle_deg, at.x_px, at.y_px])
    wedges = [b"%d" % i + cut.tobytes() for i, cut in outlined(placement, group.wedges)[1:]]
    return blake2b(b"".join([before, place.tobytes(), *wedges]), digest_size=16).digest()
