"""Where stones could be let go: their cost before they settle, and the cheapest of them."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from operator import attrgetter

import numpy as np

from drystone.kernels.drops import DropTerms
from drystone.kernels.profiles import Floats
from drystone.model.site import Site
from drystone.planner.proposing import Key, StoneTrial
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock
from drystone.settle.book import OutlineBook
from drystone.settle.settings import SettleSettings

SLACK = 0.15
"""A stone may stand out over the wall's height by so many mean stone sizes where it is dropped."""

UNBALANCED = 2.0
"""Cost of a centroid that is beside what carries a dropped stone, in widths of the stone."""


@dataclass(frozen=True, eq=False)
class Drop:
    """A place where a stone could be let go."""

    trial: StoneTrial
    spot: int  # which place of the trial's pose
    start: tuple[float, float]  # of its centroid, in the view, source px
    cost: float  # estimated

    @property
    def key(self) -> tuple[Key, int]:
        """What tells it from the others of a step."""
        return self.trial.key, self.spot


@dataclass(frozen=True, eq=False)
class Dropped:
    """Where the poses of a trial could be let go."""

    trial: StoneTrial
    places: tuple[Floats, ...]  # (n, 4): of each pose (`drops`)
    limit: float  # those that cost more may be missing


def drop_terms(site: Site, stock: Stock, rest: Rest, settings: PlannerSettings) -> DropTerms:
    """Return what drops cost in a state of construction."""
    score, settle = settings.score, settings.settle
    return DropTerms(
        cell_px=1.0 / site.scale,
        width_px=site.extent_px[0] + 2.0 * settle.beyond_px,
        height_px=site.extent_px[1],
        slack_px=SLACK * stock.mean_area_px**0.5 / site.scale,
        clearance_px=2.0 * settle.clearance_px,
        narrowest_px=stock.narrowest_px / site.scale,
        mean_height_px=stock.mean_height_px / site.scale,
        mean_area_px=stock.mean_area_px / site.scale**2,
        height=score.height,
        void=score.void,
        gap=score.gap,
        slot=score.slot,
        headroom=score.headroom,
        step=score.step,
        joint=score.joint,
        unbalanced=UNBALANCED,
        rest_width_px=rest.width_px,
        rest_height_px=rest.height_px,
    )


def in_order(dropped: Sequence[Dropped], book: OutlineBook) -> Iterator[Drop]:
    """List the drops of some trials that are known, the cheapest first."""
    owners = [(one.trial, posed) for one in dropped for posed in one.trial.poses]
    places = [mine for one in dropped for mine in one.places]
    rows = np.concatenate([np.zeros((0, 4)), *places])
    sizes = np.array([len(mine) for mine in places], np.intp)
    owner = np.repeat(np.arange(len(places)), sizes)
    spot = np.arange(len(rows)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    order = np.argsort(rows[:, 2], kind="stable")

    def drop(at: int) -> Drop:
        trial, posed = owners[owner[at]]
        one = trial if len(trial.poses) == 1 else replace(trial, poses=(posed,))
        left = book.hung(posed.stone, posed.angle_deg, trial.landscape.side).profile.left
        x, y, cost, _ = rows[at].tolist()
        return Drop(one, int(spot[at]), (x - left, y), round(cost, 12))

    # Rounding keeps the order of costs, except that it makes some equal.
    for _, equal in groupby(map(drop, order.tolist()), key=attrgetter("cost")):
        yield from sorted(equal, key=_rank)


def _rank(drop: Drop) -> tuple[object, ...]:
    """Return what sorts drops: the angle does not, for it depends on the photograph."""
    return drop.cost, drop.trial.key[::2], drop.spot


def shortlist(drops: Iterable[Drop], settings: SettleSettings) -> list[Drop]:
    """Take the first drops, only so many of one stone.

    `drops` has the cheapest first, and is asked for no further than needed.
    """
    taken: list[Drop] = []
    counts: Counter[int] = Counter()
    for drop in drops:
        stone_id = drop.trial.key[0]
        if counts[stone_id] < settings.per_stone:
            counts[stone_id] += 1
            taken.append(drop)
            if len(taken) == settings.shortlist:
                break
    return taken
