"""Where a stone could go: its outline dropped onto a height profile, at every column.

The stone comes straight down until it touches.  What that costs is estimated from the profile
alone; the best few places are worth settling exactly.
"""

import math

import numpy as np

from drystone.kernels.backend import compiled
from drystone.kernels.drop_costs import Dropped, DropTerms
from drystone.kernels.profiles import EDGE, Floats, HeightProfile, StoneProfile

__all__ = ["DropTerms", "drops", "drops_numpy", "shown", "touching"]

_fast = compiled("drops")


def drops(
    profile: HeightProfile,
    stone: StoneProfile,
    terms: DropTerms,
    constant: float,
    count: int,
    apart_px: float,
) -> Floats:
    """Return the best places of a stone that is dropped onto a height profile.

    Parameters
    ----------
    profile : HeightProfile
        Of the wall, seen so that the building side is on the left.
    stone : StoneProfile
        Of the posed stone, from its centroid, with columns of the same width.
    terms : DropTerms
        Sizes and weights.
    constant : float
        Cost of the pose itself, wherever it goes.
    count : int
        How many places are wanted at most.
    apart_px : float
        How far they are apart at least, along the wall.

    Returns
    -------
    places : (k, 4) float array
        x of the stone's left end, y of its centroid, cost, and lean: how far the centroid is
        right (left when negative) of the columns that carry the stone, in widths of the stone.
        The cheapest first, then the cheapest of those that are far enough from it, and so on; of
        equal costs the lower one, then the one further left.  No rows when there is no place.

    Notes
    -----
    The costs are those of :class:`DropTerms`, as the raster has them as far as a profile tells:
    `height` of the centroid and `step` from the left neighbour's top in mean stone heights; in
    mean stone areas `void` under the stone, `gap` to what first reaches over the middle of its
    height on the left (at most 1), and `slot` beside and `headroom` over it that the others
    cannot fill; `joint`, 1 - IWR.  Neighbour and joints are those of the boxes of polygons that
    show in the profile.  At an end of the wall the joint costs as much as a level top.

    Raises
    ------
    ValueError
        When tops and owners differ in number, an owner has no box, or it is not known for any
        length what stones could fill.
    """
    if len(profile.tops) != len(profile.owners):
        raise ValueError(f"{len(profile.tops)} tops have {len(profile.owners)} owners")
    if not (len(terms.rest_width_px) and len(terms.rest_height_px)):
        raise ValueError("what stones could fill is not known for any length")
    room = terms.width_px - (stone.right - stone.left)
    last = min(
        math.floor(room / terms.cell_px + EDGE), len(profile.tops) - len(stone.bottoms)
    )  # the last column that the left end may be on
    if last < 0:
        return np.zeros((0, 4))
    # Every x is on a column edge.
    apart = max(1, math.ceil(apart_px / terms.cell_px - EDGE))
    kernel = drops_numpy if _fast is None else _fast.drops
    found: Floats = kernel(profile, stone, terms, constant, (last + 1, apart, count))
    return found


def drops_numpy(
    profile: HeightProfile,
    stone: StoneProfile,
    terms: DropTerms,
    constant: float,
    numbers: tuple[int, int, int],
) -> Floats:
    """Return what :func:`drops` returns, by NumPy.

    Parameters
    ----------
    profile, stone, terms, constant
        As for :func:`drops`.
    numbers : (int, int, int)
        How many columns the stone's left end may be on, how many apart, and how many places are
        wanted.
    """
    places, apart, count = numbers
    drop = Dropped(profile.tops, stone, terms, touching(profile, stone, places))
    cost = drop.cost(constant, shown(profile))
    lean = drop.lean()
    cost = cost + terms.unbalanced * np.abs(lean)
    cost = np.where(drop.top > terms.height_px + terms.slack_px, np.inf, cost)
    rows = [
        (at * terms.cell_px, drop.lift[at] + terms.clearance_px, price, lean[at])
        for at, price in _cheapest(cost, drop.lift, apart, count)
    ]
    return np.array(rows, np.float64).reshape(-1, 4)


def touching(profile: HeightProfile, stone: StoneProfile, places: int) -> Floats:
    """Return y of the centroid where the stone touches first, for each of the first columns."""
    lift = np.full(places, -np.inf)
    for k, bottom in enumerate(stone.bottoms.tolist()):
        lift = np.maximum(lift, profile.tops[k : k + places] - bottom)
    return lift


def shown(profile: HeightProfile) -> Floats:
    """Return the boxes of the polygons that own columns, in their order.

    Raises
    ------
    ValueError
        When there is no box of an owner.
    """
    owners = np.unique(profile.owners)
    owners = owners[owners >= 0]
    if len(owners) and owners[-1] >= len(profile.boxes):
        raise ValueError(f"a column of polygon {owners[-1]}, but there are {len(profile.boxes)}")
    return np.asarray(profile.boxes[owners])


def _cheapest(cost: Floats, lift: Floats, apart: int, count: int) -> list[tuple[int, float]]:
    """Return the cheapest places that are so many columns apart, with their costs."""
    cost = cost.copy()
    chosen: list[tuple[int, float]] = []
    while len(chosen) < count:
        least = float(cost.min())
        if least == np.inf:
            break
        equal = np.flatnonzero(cost == least)
        best = int(equal[np.argmin(lift[equal])])
        chosen.append((best, least))
        cost[max(0, best - apart + 1) : best + apart] = np.inf
    return chosen
