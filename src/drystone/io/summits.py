"""The parts that erosions leave of a mask, all at once: what lies around summits of its depth."""

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Whole = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Summits:
    """Parts of a mask, each around the deepest place in it.

    A part begins where an erosion leaves its summit, and grows as less is eroded, until a deeper
    part reaches it: there it ends, and becomes one with that.

    The pixels of a row between two lowest places are a hill: what an erosion leaves of one hangs
    together.  So parts are made of hills and of the highest passes between them, of which there
    are few, and not of pixels.
    """

    depth: NDArray[np.float64]  # (h, w), distance to the background, px; 0 on the rim

    @cached_property
    def level(self) -> Whole:
        """How many px may be eroded before a pixel vanishes, row by row; -1 is background."""
        return np.ceil(self.depth.ravel()).astype(np.int32) - 1

    @cached_property
    def left(self) -> NDArray[np.int64]:
        """Number of pixels that erosions by 0, 1, 2 ... px leave."""
        return _at_least(self.level, int(self.level.max()) + 1)

    @cached_property
    def starts(self) -> NDArray[np.int64]:
        """First pixel of every hill."""
        change = np.flatnonzero(np.diff(self.level)) + 1
        up = self.level[change] > self.level[change - 1]
        return np.asarray(change[up & np.concatenate(([True], ~up[:-1]))])

    @cached_property
    def hill(self) -> Whole:
        """Hill of every pixel; background goes with the one before it."""
        begins = np.zeros(self.level.size, np.int32)
        begins[self.starts] = 1
        return np.cumsum(begins, dtype=np.int32) - np.int32(1)

    @cached_property
    def thickness(self) -> NDArray[np.float64]:
        """Depth of every summit; there is one for every hill."""
        return np.asarray(np.maximum.reduceat(self.depth.ravel(), self.starts))

    def _passes(self) -> tuple[Whole, Whole, Whole]:
        """Return the hills that meet, and the level of the pass between them, highest first."""
        width, level, hill = self.depth.shape[1], self.level, self.hill
        begins = np.zeros(level.size, bool)
        begins[self.starts] = True
        # A pair of hills in two rows meets along a stretch of columns.
        cuts = np.flatnonzero(begins[:-width] | begins[width:])
        height = np.maximum.reduceat(np.minimum(level[:-width], level[width:]), cuts)
        touch = self.starts[level[self.starts - 1] >= 0]
        one = np.concatenate((hill[cuts], hill[touch - 1]))
        other = np.concatenate((hill[cuts + width], hill[touch]))
        height = np.concatenate((height, level[touch - 1]))
        order = np.argsort(-height, kind="stable")
        order = order[height[order] >= 0]
        return one[order], other[order], height[order]

    @cached_property
    def _grown(self) -> tuple[Whole, dict[int, list[int]]]:
        """Let parts grow together (Kruskal); return where each ends, and what ends in which."""
        deep = self.thickness.tolist()
        into = list(range(len(deep)))
        ends = np.full(len(deep), -1, np.int32)
        taken: dict[int, list[int]] = defaultdict(list)

        def part_of(hill: int) -> int:
            while into[hill] != hill:
                into[hill] = into[into[hill]]
                hill = into[hill]
            return hill

        for one, other, height in zip(*(array.tolist() for array in self._passes()), strict=True):
            winner, loser = part_of(one), part_of(other)
            if winner != loser:
                if deep[winner] < deep[loser]:
                    winner, loser = loser, winner
                into[loser], ends[loser] = winner, height
                taken[winner].append(loser)
        return ends, taken

    @property
    def ends(self) -> Whole:
        """The erosion, px, that does not part each from a deeper one any more; -1 for none."""
        return self._grown[0]

    def areas(self, part: int) -> NDArray[np.int64]:
        """Return the pixels of a part that erosions by 0, 1 ... px leave, right above its end."""
        ends, taken = self._grown
        # Where each hill was reached from the summit.
        reached = {}
        todo = [(part, len(self.left))]
        while todo:
            hill, at = todo.pop()
            reached[hill] = at
            todo += [(more, min(at, ends[more])) for more in taken[hill] if ends[more] > ends[part]]
        first, last = min(reached), max(reached)
        at_hill = np.full(last - first + 1, -1, np.int32)
        at_hill[np.fromiter(reached, int) - first] = list(reached.values())
        bounds = np.append(self.starts, self.level.size)
        pixels = slice(bounds[first], bounds[last + 1])
        level = np.minimum(self.level[pixels], at_hill[self.hill[pixels] - first])
        return _at_least(level, len(self.left))


def _at_least(level: Whole, count: int) -> NDArray[np.int64]:
    """Return how many pixels have a level of at least 0, 1, 2 ..."""
    return np.bincount(level + 1, minlength=count + 1)[:0:-1].cumsum()[::-1]
