"""Selecting by cost: the geometry first, the limit analysis for the best few (our own rule).

Algorithm 2 filters by the lateral resistance before it looks at the geometry: it drops a large
stone that would close a course because a small one elsewhere carries a little more, and walls
end with stones left over.  Here every action has a cost made of craft rules; only the cheapest
are analysed, and the lateral resistance counts as one more term.
"""

import math
from dataclasses import dataclass, fields
from operator import attrgetter

from drystone.model.settings import Ranged, ranged

PIN_BONUS = 2.0
"""Bonus of an action that places a pinned stone: so it goes in early where it fits about as well as
others."""


@dataclass(frozen=True)
class Craft:
    """How well a stone sits, in costs of about 0 to 1, all but the last two best at 0.

    Parameters
    ----------
    height : float
        Of the stone's centroid over the ground, in mean stone heights.
    void : float
        Empty area under the stone, in mean stone areas.
    gap : float
        Empty area between the stone and its neighbour on the building side, likewise.
    slot : float
        Area beside it, on the other side, that the remaining stones cannot fill, likewise.
    headroom : float
        Area above it that the remaining stones cannot fill below the wall's top, likewise.
    step : float
        Difference of its top and its neighbour's, in mean stone heights (as NHR).
    roughness : float
        Mean deviation of its top from level, in mean stone heights.
    upright : float
        How much higher than wide it stands: max(0, 1 - width / height).
    joint : float
        1 - IWR, or 1 - IS for a boundary stone.
    area : float
        Of the stone, in mean stone areas; its weight is a bonus for large stones.
    thickness : float
        Shorter side of the stone's box, in mean stone heights; its weight is a bonus for stones
        that do not fit into what is left below the wall's top in the end.
    """

    height: float
    void: float
    gap: float
    slot: float
    headroom: float
    step: float
    roughness: float
    upright: float
    joint: float
    area: float
    thickness: float


@dataclass(frozen=True, kw_only=True)
class ScoreSettings(Ranged):
    """Weights of the costs of :class:`Craft`, and how many actions are analysed.

    Parameters
    ----------
    height, void, gap, slot, headroom, step, roughness, upright, joint : float
        Weight of each cost.
    area : float
        Bonus for a stone of mean area.
    thickness : float
        Bonus for a stone whose shorter side is the mean height.
    llc : float
        Bonus for LLC = 1.
    analysed : int
        How many of the cheapest actions that stand are compared by LLC.
    """

    height: float = 1.4
    void: float = 1.2
    gap: float = 1.0
    slot: float = 1.5
    headroom: float = 1.0
    step: float = 0.9
    roughness: float = 0.4
    upright: float = 0.7
    joint: float = 0.4
    area: float = 1.8
    thickness: float = 0.0
    llc: float = 1.3
    analysed: int = ranged(4, least=1)


_costs = attrgetter(*(one.name for one in fields(Craft) if one.name not in ("area", "thickness")))
"""Gives the costs of an action, or their weights, which have the same names."""


def craft_cost(craft: Craft, settings: ScoreSettings) -> float:
    """Return the weighted cost of an action, lower is better; large stones earn a bonus."""
    costs = [weight * cost for weight, cost in zip(_costs(settings), _costs(craft), strict=True)]
    bonus = settings.area * craft.area, settings.thickness * craft.thickness
    return math.fsum([*costs, -bonus[0], -bonus[1]])
