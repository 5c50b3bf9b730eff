"""Stones that look like two touching stones under one id (W110)."""

import math
from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask

Whole = NDArray[np.int32]

_WAIST = 1.6
"""Both parts must be this many times as thick as the neck between them."""

_MOST_HILLS = 2**16
"""No stone has as many: more are noise."""

_PART_SHARE = 0.15
"""Each part must have this share of the stone."""


def neck_width_px(mask: Mask, most_px: int = 2**22) -> int | None:
    """Return the width of the neck between two thick parts of a mask; None without one.

    A width of 0 means that the parts meet at a corner of pixels only.  A mask of more than
    `most_px`, or one that is noise, is looked at in a coarser picture.  There a neck that is
    thinner than one of its pixels counts as one of them.

    The neck is the smallest erosion that leaves two parts, each thicker than the neck by a
    factor 1.6 and with at least 15 % of what the erosion leaves.
    """
    step = math.ceil(math.sqrt(mask.size / most_px))
    depth = ndimage.distance_transform_edt(np.pad(mask[::step, ::step], 1))
    if depth.max() < 2 * _WAIST:
        return None
    summits = Summits(depth)
    if len(summits.starts) > _MOST_HILLS:
        return neck_width_px(mask, depth.size // 4)
    erosions = np.arange(int(depth.max() / _WAIST) + 1)
    wide_px = _WAIST * np.maximum(erosions, 1)
    least_px = _PART_SHARE * summits.left[: len(erosions)]
    # Most summits are reached by a deeper part before an erosion leaves them thick enough.
    apart = np.flatnonzero(summits.thickness >= _WAIST * np.maximum(summits.ends + 1, 1))
    found = np.zeros(len(erosions), int)
    for part in apart.tolist() if len(apart) > 1 else ():
        areas = summits.areas(part)[: len(erosions)]
        thick = summits.thickness[part] >= wide_px
        found += (erosions > summits.ends[part]) & thick & (areas >= least_px)
    if not (found > 1).any():
        return None
    return max(2 * step * int(np.argmax(found > 1)), step if step > 1 else 0)


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
