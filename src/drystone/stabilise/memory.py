"""Stabilise each stone in the same surroundings only once."""

import math

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.model.wall import Group
from drystone.poses import PoseBook, RecentlyUsed, memory_bytes
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import Outcome, Pose, WedgeStock, falls_to, make_stable

Key = tuple[Stone, float, int, int, int, tuple[int, ...], bytes]

MEMORY_BYTES = 1 << 28
"""Outcomes that are remembered at most, about: a hundred thousand."""


class StabiliseMemory:
    """Stabilisation as a function of a stone and what is around it, remembered.

    A stone that falls is made stable in a window of the landscape: from some way above it down to
    the ground, and some way beyond its sides.  So what happens further away cannot matter, and
    the outcome can be used again whenever the window looks the same, in a later step or in
    another wall: as far down, that is, as was looked at to make the stone stable.

    Outcomes not asked for for longest are forgotten and worked out again when they are: no result
    depends on the budget.  The mean height of the stones limits the wedges.
    """

    def __init__(self, book: PoseBook, mean_height_px: float, settings: StabiliseSettings) -> None:
        self._book = book
        self._stock = WedgeStock(1, mean_height_px)
        self._settings = settings
        self._outcomes = RecentlyUsed[Key, Outcome](MEMORY_BYTES)

    def stabilise(self, occupied: Mask, trial: Pose, side: Side, next_wedge: int) -> Group | None:
        """Return a stable placement from a trial one; None when there is none (§3.7).

        `occupied` is the landscape without the stone, `next_wedge` the id of the next wedge.  A
        stone that would turn or slide out of the window counts as not stable.
        """
        falls = falls_to(occupied, trial, self._settings)
        if falls is None:
            return None
        if falls == 0:  # most are: quicker seen than remembered
            return Group(Placement(*trial, side))
        posed, row, col = trial
        reach = _reach_px(posed)
        top, left = max(0, row - reach), max(0, col - reach)
        window = occupied[top:, left : col + posed.width_px + reach]
        local = (posed, row - top, col - left)
        outcome = self._outcome(window, local, side, row - top + posed.height_px + reach)
        return _moved(outcome.stabilised, top, left, side, next_wedge)

    def _outcome(self, window: Mask, trial: Pose, side: Side, depth: int) -> Outcome:
        """Return what becomes of a stone in a window that reaches down to the ground.

        An outcome is looked for by the window down to a depth: at first a guess, then as deep as
        what is found there has looked.
        """
        outcome: Outcome | None = None
        while True:
            part = window[:depth]
            posed, row, col = trial
            # By angle, not by pose: a pose that the book has made again is the same.
            place = posed.stone, posed.angle_deg, row, col
            key = (*place, depth, part.shape, np.packbits(part).tobytes())
            found = self._outcomes.get(key)
            if found is None:
                if outcome is None:
                    book, stock, settings = self._book, self._stock, self._settings
                    outcome = make_stable(window, trial, side, book, stock, settings)
                # About what it takes, with the pose, which the book may forget.
                size = len(key[-1]) + 1000
                if outcome.stabilised is not None:
                    size += memory_bytes(outcome.stabilised.placement.posed)
                    size += sum(wedge.mask.nbytes + 500 for wedge in outcome.stabilised.wedges)
                found = self._outcomes.keep(key, outcome, size)
            if found.depth <= depth or len(window) < depth:
                return found
            depth = found.depth


def _reach_px(posed: PosedStone) -> int:
    """Return how far around a stone the window goes: a third of its size and a little."""
    return math.ceil(max(posed.width_px, posed.height_px) / 3) + 6


def _moved(
    stabilised: Group | None, top: int, left: int, side: Side, next_wedge: int
) -> Group | None:
    """Return an outcome in the rows and columns of the whole wall, with wedge ids of its own."""
    if stabilised is None:
        return None
    at = stabilised.placement
    wedges = tuple(
        Wedge(next_wedge + k, wedge.under, wedge.mask, wedge.row + top, wedge.col + left)
        for k, wedge in enumerate(stabilised.wedges)
    )
    placement = Placement(at.posed, at.row + top, at.col + left, side, at.rotation_moves)
    return Group(placement, wedges)
