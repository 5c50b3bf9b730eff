"""Stabilise each stone in the same surroundings only once."""

import math
from dataclasses import replace

import numpy as np

from drystone.kernels.raster import Mask
from drystone.model.placement import Side, Wedge
from drystone.model.pose import PosedStone
from drystone.poses import PoseBook
from drystone.stabilise.rotate import Pose
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import Stabilised, WedgeStock, stabilise

Key = tuple[PosedStone, int, int, tuple[int, ...], bytes]


class StabiliseMemory:
    """Stabilisation as a function of a stone and what is around it, remembered.

    A stone is stabilised in a window of the landscape: from some way above it down to the ground,
    and some way beyond its sides.  So what happens further away cannot matter, and the outcome
    can be used again whenever the window looks the same, in a later step or in another wall.

    Parameters
    ----------
    book : PoseBook
        Gives turned stones.
    mean_height_px : float
        Mean height of the stones, which limits the wedges.
    settings : StabiliseSettings
        Which methods, with which limits.
    capacity : int
        Outcomes that are kept; when it is reached, all are forgotten.
    """

    def __init__(
        self,
        book: PoseBook,
        mean_height_px: float,
        settings: StabiliseSettings,
        capacity: int = 100_000,
    ) -> None:
        self._book = book
        self._mean_height_px = mean_height_px
        self._settings = settings
        self._capacity = capacity
        self._outcomes: dict[Key, Stabilised | None] = {}

    def stabilise(
        self, occupied: Mask, trial: Pose, side: Side, next_wedge: int
    ) -> Stabilised | None:
        """Return a stable placement from a trial one; None when there is none (§3.7).

        Parameters
        ----------
        occupied : (h, w) bool array
            The landscape without the stone.
        trial : (PosedStone, int, int)
            The stone and the row and column of its mask.
        side : {"left", "right"}
            End of the wall from which it is placed.
        next_wedge : int
            Id of the next wedge.

        Notes
        -----
        A stone that would turn or slide out of the window counts as not stable.
        """
        posed, row, col = trial
        reach = _reach_px(posed)
        top, left = max(0, row - reach), max(0, col - reach)
        window = occupied[top:, left : col + posed.width_px + reach]
        key = (posed, row - top, col - left, window.shape, np.packbits(window).tobytes())
        if key in self._outcomes:
            outcome = self._outcomes[key]
        else:
            stock = WedgeStock(1, self._mean_height_px)
            local = (posed, row - top, col - left)
            outcome = stabilise(window, local, side, self._book, stock, self._settings)
            if len(self._outcomes) >= self._capacity:
                self._outcomes.clear()
            self._outcomes[key] = outcome
        return None if outcome is None else _moved(outcome, top, left, side, next_wedge)


def _reach_px(posed: PosedStone) -> int:
    """Return how far around a stone the window goes: a third of its size and a little."""
    return math.ceil(max(posed.width_px, posed.height_px) / 3) + 6


def _moved(outcome: Stabilised, top: int, left: int, side: Side, next_wedge: int) -> Stabilised:
    """Return an outcome in the rows and columns of the whole wall, with wedge ids of its own."""
    at = outcome.placement
    wedges = tuple(
        Wedge(next_wedge + k, wedge.under, wedge.mask, wedge.row + top, wedge.col + left)
        for k, wedge in enumerate(outcome.wedges)
    )
    return Stabilised(replace(at, row=at.row + top, col=at.col + left, side=side), wedges)
