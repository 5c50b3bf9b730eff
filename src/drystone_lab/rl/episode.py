"""Walls to learn on: stones that arrive one after the other, what is offered, what it is worth."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from drystone.errors import UsageError
from drystone.generate import GENERATORS
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet
from drystone.placement.settings import PlacementSettings
from drystone.planner.attempt import Attempt
from drystone.planner.build import Build, Candidate
from drystone.planner.offers import offer
from drystone.planner.settings import PlannerSettings
from drystone.planner.workshop import Workshop
from drystone.search.goal import WallFigures, figures_of, merit_of, possible_filling
from drystone.selection.policy import Offer

KINDS = ("fourier", "polygon", "brick", "rubble")


@dataclass(frozen=True, kw_only=True)
class DrawSettings:
    """What walls are drawn."""

    kinds: tuple[str, ...] = KINDS  # Generators, all with the same chance
    stones: int = 20  # How many stones arrive, at least 3
    # Square root of the mean area of a stone, at least 8.  Images are not reduced: working
    # and source px are the same
    size_px: float = 18.0
    surplus: float = 1.2  # Area of all stones over the area of the wall, at least .2
    aspect: float = 2.5  # Width of the wall over its height, from 1/stones to stones

    def __post_init__(self) -> None:
        unknown = sorted(set(self.kinds) - set(KINDS))
        if unknown or not self.kinds:
            raise _refused(f"there is no generator {unknown}", f"Known: {', '.join(KINDS)}.")
        if self.stones < 3 or not self.size_px >= 8:
            raise _refused("walls need 3 stones or more, of 8 px or more", "Give more of them.")
        if not self.surplus >= 0.2 or not 1 / self.stones <= self.aspect <= self.stones:
            what = "surplus must be 0.2 or more, aspect from 1/stones to stones"
            raise _refused(what, "A wall is as wide and as high as a stone, or more.")


def draw_wall(settings: DrawSettings, rng: Generator) -> tuple[StoneSet, Site]:
    """Draw stones, numbered from 1 in the order in which they arrive, and the site of their wall.

    >>> stones, site = draw_wall(DrawSettings(kinds=("brick",)), np.random.default_rng(1))
    >>> len(stones), site
    (20, Site(width_px=118, height_px=47, scale=1.0, px_per_m=None))
    """
    kind = settings.kinds[int(rng.integers(len(settings.kinds)))]
    kind_settings, make = GENERATORS[kind]
    stones = in_order(make(kind_settings(**_numbers(kind, settings, rng)), rng), rng)
    area = stones.total_area_px / settings.surplus
    height = max(1, round((area / settings.aspect) ** 0.5))
    return stones, Site(max(1, round(settings.aspect * height)), height)


def in_order(stones: StoneSet, rng: Generator) -> StoneSet:
    """Return the same stones numbered from 1 in a random order."""
    order = rng.permutation(len(stones)).tolist()
    return StoneSet(
        tuple(Stone(k, stones.stones[old].mask) for k, old in enumerate(order, 1)),
        stones.source,
        stones.notices,
    )


def _numbers(kind: str, settings: DrawSettings, rng: Generator) -> dict[str, float]:
    size, count = settings.size_px, settings.stones
    if kind == "fourier":  # round to elongated, the largest almost twice as large as the smallest
        radius = size / np.pi**0.5
        numbers = {"smallest_radius_px": 0.7 * radius, "largest_radius_px": 1.25 * radius}
        return {"count": count, **numbers, "D2": float(rng.uniform(0.0, 0.2))}
    if kind == "polygon":  # bricks whose corners are moved a little or much
        sides = {"width_px": 1.2 * size, "height_px": size / 1.2}
        return {"count": count, **sides, "noise": float(rng.uniform(0.1, 0.4))}
    if kind == "brick":  # a third of them halves, which the mean area counts too
        halves = count // 3
        aspect = float(rng.uniform(1.6, 3.0))
        height = max(2, round(size / ((1.0 - 0.5 * halves / count) * aspect) ** 0.5))
        return {"count": count - halves, "halves": halves, "height_px": height, "aspect": aspect}
    # rubble, in courses about as high as its stones are wide
    ratio, courses = 0.9, round((count / settings.aspect) ** 0.5)
    height_px = size * (count / ratio / settings.aspect) ** 0.5
    sides = {"width_px": settings.aspect * height_px, "height_px": height_px}
    return {"count": count, **sides, "area_ratio": ratio, "courses": courses}


def _refused(what: str, cure: str) -> UsageError:
    return UsageError("E123", f"{what}.", where="DrawSettings", cure=cure)


ARRIVING = PlannerSettings(
    orientations="quarter",
    sampling="full",
    two_sided=True,
    skip_too_large=True,
    order="given",
    placement=PlacementSettings(rule="snug", reach="above", tries=4),
)
"""How stones that arrive are offered unless said otherwise: pixels, the pose of largest SF and its
quarter turns, from both ends, the first of four places at which the stone can be made stable."""


class Episode:
    """One wall: stones arrive, each is built in one of the places offered, or put aside.

    Stones arrive in `order`, ascending when missing; those that fit in no pose never do.  At most
    `most` places are offered: the lowest, by centroid.
    """

    def __init__(
        self,
        workshop: Workshop,
        order: Sequence[int] | None = None,
        settings: PlannerSettings = ARRIVING,
        most: int | None = None,
    ) -> None:
        self.workshop = workshop
        exact = settings.geometry == "exact"
        self.build = Build.empty(
            workshop.site, settings.mu, workshop.stock.mean_area_px, exact=exact
        )
        arriving = workshop.fitting if order is None else order
        self._waiting = [i for i in arriving if i in workshop.fitting]
        self._settings = settings
        self._most = most
        self._possible = possible_filling(self.workshop)
        self._attempt = Attempt(self.workshop, settings, self.build)
        self._candidates: list[Candidate] = []
        self.offers: tuple[Offer, ...] = ()
        self.stone_id: int | None = None
        self.aside = 0
        self._next()

    @property
    def over(self) -> bool:
        """True when nothing is offered any more."""
        return not self.offers

    @property
    def waiting(self) -> int:
        """How many stones have not arrived yet."""
        return len(self._waiting)

    def take(self, position: int | None) -> None:
        """Build the stone that has arrived, and let the next come that can be built."""
        if position is None:
            self.aside += 1
        else:
            if not 0 <= position < len(self._candidates):
                raise IndexError(position)
            self.build = self.build.add(self._candidates[position])
            self._attempt = Attempt(self.workshop, self._settings, self.build)
        self._next()

    def copy(self) -> "Episode":
        """Return an episode in the same state, which goes on by itself."""
        other = copy(self)
        other._waiting = list(self._waiting)  # noqa: SLF001 - of its own kind
        return other

    def _next(self) -> None:
        self._candidates, self.offers, self.stone_id = [], (), None
        while self._waiting and self.build.wall.filling <= self._settings.stop.filling:
            stone_id = self._waiting.pop(0)
            found = self._attempt.standing((stone_id,))
            if found:
                site = self.workshop.site
                offers = [offer(candidate, site) for candidate in found]
                # Those that are kept stay in their order.
                order = sorted(range(len(offers)), key=lambda k: offers[k].centroid_px[1])
                kept = sorted(order[: self._most])
                self._candidates = [found[k] for k in kept]
                self.offers = tuple(offers[k] for k in kept)
                self.stone_id = stone_id
                return
            self.aside += 1

    @property
    def carried(self) -> float:
        """F_LR of the wall as it is; 0 when it is empty."""
        actions = self.build.actions
        return (actions[-1].resistance.value or 0.0) if actions else 0.0

    @property
    def figures(self) -> WallFigures | None:
        """All figures of merit of the wall as it is; None when it is empty."""
        return figures_of(self.build, self._settings.pin)

    @property
    def merit(self) -> float:
        """Merit of the wall as it is (:mod:`drystone.search.goal`); 0 when it is empty."""
        figures = self.figures
        return 0.0 if figures is None else merit_of(figures, self._possible, self._settings.goal)

    @property
    def potential(self) -> float:
        """What the wall is worth so far: filling and resistance alone, until it is finished.

        Joints and edges mean little while the wall grows, and take the most time to measure.
        """
        if self.over or not self.build.actions:
            return self.merit
        so_far = WallFigures(
            stones=len(self.build.actions),
            F_SF=self.build.wall.filling,
            F_LR=self.carried,
            F_AV=0.0, F_AH=0.0, T_LEVEL=0.0, E_FLUSH=0.0,
        )  # fmt: skip
        return merit_of(so_far, self._possible, replace(self._settings.goal, F_AV=0.0, F_AH=0.0))
