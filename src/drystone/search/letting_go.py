"""Letting a planned stone go near its place: from where, and where it comes to rest."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from drystone.kernels.polygons import Points
from drystone.kernels.profiles import Floats, StoneProfile, hanging
from drystone.kernels.raster import wrap_deg
from drystone.planner.search_settings import LayingSettings
from drystone.planner.views import SideView
from drystone.settle.rest import Repose, Start, Turned, repose, rests, touch_down
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits, wedge_for
from drystone.stabilise.settings import Method

CLOSED_UP = 0.25
"""A stone may come to rest nearer to its end of the wall than planned, by so many mean heights."""

SAME_PX, SAME_DEG = 1.0, 0.05
"""Stones that rest so near to each other rest alike."""


@dataclass(frozen=True)
class Aim:
    """Where a stone shall come to rest, as the view of its side sees it; source px."""

    left_px: float | None  # its left end; None for anywhere along the wall
    top_px: float
    angle_deg: float  # its turn in the wall frame
    highest_px: float  # above this no stone may be
    unit_px: float  # mean stone height: unit of the costs


@dataclass(frozen=True, eq=False)
class Resting:
    """Where a stone came to rest, and what that costs."""

    repose: Repose
    wedge: Points | None  # (n, 2), corners of the wedge that holds it, in the wall frame
    cost: float


def cheapest_apart(cost: Floats, apart: float, most: int) -> Iterator[int]:
    """List the places of least cost that are so far from each other; none of infinite cost."""
    free, columns = cost.copy(), max(1, math.ceil(apart))
    for _ in range(most):
        at = int(free.argmin())
        if free[at] == np.inf:
            return
        yield at
        free[max(0, at - columns + 1) : at + columns] = np.inf


@dataclass(frozen=True, eq=False)
class Hand:
    """Lets stones go."""

    settings: LayingSettings  # from where, and what it costs to rest elsewhere than planned
    settle: SettleSettings
    limits: WedgeLimits
    method: Method  # what is tried with a stone that does not rest

    def starts(self, stone: Turned, view: SideView, aim: Aim) -> list[Start]:
        """Return from where a stone is let go: where it first touches, the cheapest place first."""
        settings, column_px = self.settings, view.column_px
        profile = hanging(stone.corners, column_px)
        first, last = self._columns(profile, stone.size_px, view, aim)
        if last < first:
            return []
        under = sliding_window_view(view.profile.tops, len(profile.bottoms))[first : last + 1]
        lift = (under - profile.bottoms).max(axis=1) + 2.0 * self.settle.clearance_px
        left = np.arange(first, last + 1, dtype=np.float64) * column_px
        cost = self._place_cost(left, lift + profile.top, aim)
        # It may go down further as it settles, but not up.
        cost[lift + profile.top > aim.top_px + settings.astray * aim.unit_px] = np.inf
        least = settings.apart if aim.left_px is not None else settings.spread
        places = cheapest_apart(cost, least * stone.size_px / column_px, settings.starts)
        return [(float(left[at]) - profile.left, float(lift[at])) for at in places]

    def _columns(
        self, stone: StoneProfile, size_px: float, view: SideView, aim: Aim
    ) -> tuple[int, int]:
        """Return the first and the last column on which the stone's left end may be."""
        room = view.scene.width_px + self.settle.beyond_px - (stone.right - stone.left)
        last = min(math.floor(room / view.column_px), len(view.profile.tops) - len(stone.bottoms))
        if aim.left_px is None:
            return 0, last
        reach = self.settings.reach * size_px
        first = max(0, math.floor((aim.left_px - reach) / view.column_px))
        return first, min(last, math.ceil((aim.left_px + reach) / view.column_px))

    def _place_cost(self, left_px: Floats, top_px: Floats, aim: Aim) -> Floats:
        """Return what it costs to be at some places."""
        cost = self.settings.top * np.abs(top_px - aim.top_px)
        if aim.left_px is not None:
            aside = left_px - aim.left_px
            # Closing up is welcome, but much nearer to the end joints come to lie above joints.
            lost = np.maximum(aside, -aside - CLOSED_UP * aim.unit_px)
            cost += self.settings.width * np.maximum(lost, 0.0)
        return np.asarray(cost / aim.unit_px)

    def resting(
        self, stone: Turned, view: SideView, aim: Aim, starts: Sequence[Start]
    ) -> list[Resting]:
        """Let a stone go, and return where it rests near its place, the cheapest first.

        Where it rests nowhere, it is wedged.
        """
        turns = self.method in ("both", "rotation")
        settled = (
            [
                repose(stone, view.scene, found)
                for found in rests(stone, view.scene, start, self.settle, turns=turns)
            ]
            for start in starts
        )
        found = self._cheapest(settled, self.settings.enough, view, aim)
        if found or self.method not in ("both", "wedge"):
            return found
        lowered = (touch_down(stone, view.scene, start, self.settle) for start in starts)
        there = ([] if one is None else [one] for one in lowered)
        return [
            Resting(place.repose, wedge, place.cost + self.settings.wedge)
            for place in self._cheapest(there, math.inf, view, aim)
            if (wedge := wedge_for(place.repose, view.scene, self.limits)) is not None
        ]

    def _cheapest(
        self, found: Iterable[list[Repose]], enough: float, view: SideView, aim: Aim
    ) -> list[Resting]:
        """Return the different places near the plan, the cheapest first.

        Start after start is looked at until there are enough of them.
        """
        near: dict[tuple[int, int, int], Resting] = {}
        for of_start in found:
            for one in of_start:
                cost, at = self._cost(one, view, aim), one.settled
                if cost < math.inf:
                    x, y = round(at.x_px / SAME_PX), round(at.y_px / SAME_PX)
                    like = x, y, round(one.angle_deg / SAME_DEG)
                    near.setdefault(like, Resting(one, None, cost))
            if len(near) >= enough:
                break
        # Costs that differ by rounding are equal; then the earlier start goes first.
        return sorted(near.values(), key=lambda one: round(one.cost, 9))

    def _cost(self, found: Repose, view: SideView, aim: Aim) -> float:
        """Return what it costs to rest somewhere; infinite where it is far from the plan."""
        settings, corners = self.settings, found.settled.corners
        top = float(corners[:, 1].max())
        if top > aim.highest_px or abs(top - aim.top_px) > settings.astray * aim.unit_px:
            return math.inf
        if view.scene.side == "left":
            left = float(corners[:, 0].min())
        else:
            left = view.scene.width_px - float(corners[:, 0].max())
        place = self._place_cost(np.array([left]), np.array([top]), aim)
        turn = abs(wrap_deg(found.angle_deg - aim.angle_deg)) / 10.0
        unsure = max(0.0, 1.0 - found.margin)
        return math.fsum([float(place[0]), settings.turn * turn, settings.rest * unsure])
