"""Where a planned stone of pixels is put down near its place, and what that costs."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from drystone.kernels.lowering import lowered_positions
from drystone.model.landscape import Landscape
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.placement.feasible import can_be_lowered
from drystone.poses import wrap_deg
from drystone.search.laying_settings import PutDownSettings
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.stabilise import Stabilised


@dataclass(frozen=True)
class PixelAim:
    """Where a stone shall lie, as the view of its side sees it; working px.

    Parameters
    ----------
    left : float or None
        Its left end; None for anywhere along the wall.
    top : float
        Its top, up from the ground.
    angle_deg : float
        Its turn in the wall frame.
    unit : float
        Mean stone height: unit of the costs.
    """

    left: float | None
    top: float
    angle_deg: float
    unit: float


@dataclass(frozen=True, eq=False)
class Lying:
    """A stone that was put down somewhere and stays there.

    Parameters
    ----------
    stabilised : Stabilised
        Where, with its wedges.
    cost : float
        Lower is better.
    """

    stabilised: Stabilised
    cost: float


@dataclass(frozen=True, eq=False)
class PixelHand:
    """Puts stones down.

    Parameters
    ----------
    settings : PutDownSettings
        Where, and what it costs to lie elsewhere than planned.
    memory : StabiliseMemory
        Stabilises them.
    """

    settings: PutDownSettings
    memory: StabiliseMemory

    def places(
        self, landscape: Landscape, posed: PosedStone, aim: PixelAim
    ) -> list[tuple[int, int]]:
        """Return where a stone can be lowered to, the cheapest place first.

        Parameters
        ----------
        landscape : Landscape
            What is there.
        posed : PosedStone
            The stone as the landscape sees it.
        aim : PixelAim
            Where it shall go.

        Returns
        -------
        places : list of (int, int)
            Row and column of the top-left corner of its mask, in the view.
        """
        settings, height_px = self.settings, landscape.height_px
        found = lowered_positions(landscape.skyline, posed.silhouette, height_px)
        near = np.abs(height_px - found[:, 0] - aim.top) <= settings.astray * aim.unit
        if aim.left is not None:
            reach = settings.reach * math.sqrt(posed.area_px)
            near &= np.abs(found[:, 1] - aim.left) <= reach
        found = found[near]
        costs = [
            round(self.place_cost(landscape, posed, row, col, aim), 9)
            for row, col in found.tolist()
        ]
        order = np.lexsort([found[:, 1], costs])[: settings.places]
        return [(row, col) for row, col in found[order].tolist()]

    def place_cost(
        self, landscape: Landscape, posed: PosedStone, row: int, col: int, aim: PixelAim
    ) -> float:
        """Return what it costs to lie somewhere, as the view sees it."""
        settings = self.settings
        tops = landscape.skyline[col : col + posed.width_px]
        below = np.maximum(tops.astype(np.int64) - (row + posed.silhouette.bottom + 1), 0)
        astray = abs(landscape.height_px - row - aim.top)
        beside = 0.0 if aim.left is None else max(0.0, col - aim.left)
        return math.fsum(
            [
                settings.top * astray / aim.unit,
                settings.width * beside / aim.unit,
                settings.void * int(below.sum()) / posed.area_px,
            ]
        )

    def lying(
        self, wall: Wall, landscape: Landscape, posed: PosedStone, aim: PixelAim, wedge_id: int
    ) -> list[Lying]:
        """Put a stone down near its place, and return where it stays, the cheapest first.

        Parameters
        ----------
        wall : Wall
            What is there.
        landscape : Landscape
            Of the wall, from the side from which the stone is put down.
        posed : PosedStone
            The stone.
        aim : PixelAim
            Where it shall go.
        wedge_id : int
            Of the next wedge.
        """
        places = self.places(landscape, landscape.view(posed), aim)
        different: dict[tuple[float, int, int], Lying] = {}
        for one in self._stable(wall, landscape, posed, places, wedge_id):
            at = one.placement
            cost = self._cost(landscape, one, aim)
            if cost < math.inf:
                key = at.posed.angle_deg, at.row, at.col
                different.setdefault(key, Lying(one, round(cost, 9)))
        return sorted(different.values(), key=lambda lying: lying.cost)

    def _stable(
        self,
        wall: Wall,
        landscape: Landscape,
        posed: PosedStone,
        places: list[tuple[int, int]],
        wedge_id: int,
    ) -> Iterator[Stabilised]:
        for row, col in places:
            trial = posed, row, landscape.view_col(posed, col)
            found = self.memory.stabilise(wall.occupied, trial, landscape.side, wedge_id)
            if found is not None:
                yield found

    def _cost(self, landscape: Landscape, found: Stabilised, aim: PixelAim) -> float:
        """Return what it costs to lie somewhere; infinite where it is far from the plan."""
        settings, at = self.settings, found.placement
        view, col = landscape.view(at.posed), landscape.view_col(at.posed, at.col)
        astray = abs(landscape.height_px - at.row - aim.top)
        if astray > settings.astray * aim.unit:
            return math.inf
        if not can_be_lowered(landscape, view, at.row, col):
            return math.inf
        turn = abs(wrap_deg(at.posed.angle_deg - aim.angle_deg)) / 10.0
        return math.fsum(
            [
                self.place_cost(landscape, view, at.row, col, aim),
                settings.turn * turn,
                settings.wedge * len(found.wedges),
            ]
        )
