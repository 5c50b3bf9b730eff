"""Where stones could be let go: their cost before they settle, and the cheapest of them."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from operator import attrgetter

from drystone.kernels.drops import DropTerms
from drystone.model.pose import PosedStone
from drystone.model.site import Site
from drystone.planner.proposing import Key, Trial
from drystone.planner.settings import PlannerSettings
from drystone.planner.stock import Rest, Stock
from drystone.settle.settings import SettleSettings
from drystone.settle.wedge import WedgeLimits

SLACK = 0.15
"""A stone may stand out over the wall's height by so many mean stone sizes where it is dropped."""

UNBALANCED = 2.0
"""Cost of a centroid that is beside what carries a dropped stone, in widths of the stone."""


@dataclass(frozen=True, eq=False)
class Drop:
    """A place where a stone could be let go.

    Parameters
    ----------
    trial : Trial
        Stone and side.
    spot : int
        Which place of the trial's pose.
    start : (float, float)
        Of its centroid, in the view, source px.
    rank : (float, tuple)
        Estimated cost, and what tells it from the others of a step: sorts the cheapest first.
    """

    trial: Trial
    spot: int
    start: tuple[float, float]
    rank: tuple[float, tuple[Key, int]]

    @property
    def key(self) -> tuple[Key, int]:
        """What tells it from the others of a step."""
        return self.rank[1]


def drop_terms(site: Site, stock: Stock, rest: Rest, settings: PlannerSettings) -> DropTerms:
    """Return what drops cost in a state of construction.

    Parameters
    ----------
    site : Site
        Of the wall.
    stock : Stock
        Sizes of the stones.
    rest : Rest
        What the stones that are left could fill.
    settings : PlannerSettings
        Weights and clearances.
    """
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


def shortlist(drops: Sequence[Drop], settings: SettleSettings) -> tuple[list[Drop], list[Drop]]:
    """Take the cheapest drops, only so many of one stone; return those and the others."""
    taken: list[Drop] = []
    left: list[Drop] = []
    counts: Counter[int] = Counter()
    for drop in sorted(drops, key=attrgetter("rank")):
        stone_id = drop.key[0][0]
        if len(taken) < settings.shortlist and counts[stone_id] < settings.per_stone:
            counts[stone_id] += 1
            taken.append(drop)
        else:
            left.append(drop)
    return taken, left


def pose_cost(posed: PosedStone, stock: Stock, settings: PlannerSettings) -> float:
    """Return what a pose costs wherever it goes."""
    score = settings.score
    upright = max(0.0, 1.0 - posed.width_px / posed.height_px)
    return math.fsum(
        [
            score.roughness * posed.top_roughness_px / stock.mean_height_px,
            score.upright * upright,
            -score.area * posed.area_px / stock.mean_area_px,
            -score.thickness * min(posed.width_px, posed.height_px) / stock.mean_height_px,
        ]
    )


def wedge_limits(settings: PlannerSettings, stock: Stock, scale: float) -> WedgeLimits:
    """Return what wedges may be, in source px.

    Parameters
    ----------
    settings : PlannerSettings
        Sizes in working px and in mean stone heights.
    stock : Stock
        Sizes of the stones, working px.
    scale : float
        Working resolution over source resolution.
    """
    sizes, settle = settings.stabilise, settings.settle
    smallest = sizes.min_wedge_px / scale
    return WedgeLimits(
        smallest_px=smallest,
        largest_px=max(smallest, sizes.max_wedge_height * stock.mean_height_px / scale),
        margin=sizes.margin,
        mu=settings.mu,
        clearance_px=settle.clearance_px,
        contact_px=0.5 * settle.contact_px,
        rest=settle.margin,
        steep=settle.steep,
    )
