"""Where a stone could go: its outline dropped onto a height profile, at every column.

The stone comes straight down until it touches.  What that costs is estimated from the profile
alone; the best few places are worth settling exactly.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import compiled
from drystone.kernels.drop_costs import Dropped, DropTerms
from drystone.kernels.profiles import EDGE, Floats, HeightProfile, StoneProfiles

__all__ = ["DropTerms", "Wanted", "drops", "drops_numpy", "shown", "touching"]

_fast = compiled("drops")

CLOSE = 1e-9
"""Who rounds costs may need drops that cost so much more than the limit."""


class Wanted(NamedTuple):
    """Which places are wanted.

    Parameters
    ----------
    spots : int
        How many of each stone at most.
    apart_px : (k,) float array
        How far those of one stone are apart at least, along the wall.
    groups : (k,) int64 array
        Group of each stone.
    cheapest : int
        How many of the cheapest drops are wanted, at least; 0 for all.
    each : int
        How many drops of a group count as such at most; not less than 1.
    """

    spots: int
    apart_px: Floats
    groups: NDArray[np.int64]
    cheapest: int = 0
    each: int = 1


def drops(
    profile: HeightProfile,
    stones: StoneProfiles,
    terms: DropTerms,
    constants: Floats,
    wanted: Wanted,
) -> tuple[list[Floats], float]:
    """Return the best places of stones that are dropped onto a height profile, each by itself.

    Parameters
    ----------
    profile : HeightProfile
        Of the wall, seen so that the building side is on the left.
    stones : StoneProfiles
        Of posed stones, from their centroids, with columns of the same width.
    terms : DropTerms
        Sizes and weights.
    constants : (k,) float array
        Cost of each pose itself, wherever it goes.
    wanted : Wanted
        How many places are wanted.

    Returns
    -------
    places : list of (n, 4) float arrays
        Of each stone: x of its left end, y of its centroid, cost, and lean: how far the centroid
        is right (left when negative) of the columns that carry the stone, in widths of the stone.
        The cheapest first, then the cheapest of those that are far enough from it, and so on; of
        equal costs the lower one, then the one further left.  No rows when there is no place.
    limit : float
        Drops that cost more than this, by more than `CLOSE`, may be missing; infinite when all are
        there.

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
        When tops and owners differ in number, or what is said of each stone, an owner has no
        box, or it is not known for any length what stones could fill.
    """
    if len(profile.tops) != len(profile.owners):
        raise ValueError(f"{len(profile.tops)} tops have {len(profile.owners)} owners")
    if not (len(terms.rest_width_px) and len(terms.rest_height_px)):
        raise ValueError("what stones could fill is not known for any length")
    known = {len(stones.boxes), len(constants), len(wanted.apart_px), len(wanted.groups)}
    if len(known) > 1:
        raise ValueError(f"what is said of each stone is there for {sorted(known)} stones")
    if wanted.each < 1:
        raise ValueError(f"{wanted.each} of a group")
    kernel = drops_numpy if _fast is None else _fast.drops
    numbers = _numbers(len(profile.tops), stones, terms, wanted)
    few = max(0, wanted.spots), max(0, wanted.cheapest), wanted.each
    rows, taken, limit = kernel(profile, stones, terms, constants, numbers, few)
    return [mine[:size] for mine, size in zip(rows, taken.tolist(), strict=True)], limit


def _numbers(
    columns: int, stones: StoneProfiles, terms: DropTerms, wanted: Wanted
) -> NDArray[np.int64]:
    """Return where each stone may be, how many columns its places are apart, and its group.

    It may be with its left end on the first columns, so many; every x is on a column edge.
    """
    room = terms.width_px - (stones.boxes[:, 2] - stones.boxes[:, 0])
    last = np.minimum(np.floor(room / terms.cell_px + EDGE), columns - np.diff(stones.first))
    apart = np.ceil(wanted.apart_px / terms.cell_px - EDGE)
    numbers = np.empty((len(stones.boxes), 3), np.int64)
    numbers[:, 0] = np.maximum(last + 1.0, 0.0)
    numbers[:, 1] = np.minimum(np.maximum(apart, 1.0), max(1, columns))
    numbers[:, 2] = wanted.groups
    return numbers


def drops_numpy(
    profile: HeightProfile,
    stones: StoneProfiles,
    terms: DropTerms,
    constants: Floats,
    numbers: NDArray[np.int64],
    wanted: tuple[int, int, int],
) -> tuple[Floats, NDArray[np.intp], float]:
    """Return what :func:`drops` returns, by NumPy.

    Parameters
    ----------
    profile, stones, terms, constants
        As for :func:`drops`.
    numbers : (k, 3) int64 array
        On how many columns a stone's left end may be, how many its places are apart, its group.
    wanted : (int, int, int)
        Places of each stone, how many of the cheapest, and how many of those of a group.

    Returns
    -------
    rows : (k, m, 4) float array
        The places of each stone in its first rows.
    taken : (k,) int array
        How many there are.
    limit : float
        As for :func:`drops`.
    """
    most = min(wanted[0], int(numbers[:, 0].max(initial=0)))
    rows, taken = np.zeros((len(numbers), most, 4)), np.zeros(len(numbers), np.intp)
    boxes, cheapest = shown(profile), Cheapest(*wanted[1:])
    # What is cheap by itself first: it limits how dear the others may be.
    for at in np.argsort(constants, kind="stable").tolist():
        places, apart, group = numbers[at].tolist()
        if places <= 0:
            continue
        bottoms = stones.bottoms[stones.first[at] : stones.first[at + 1]]
        lift = touching(profile.tops, bottoms, places)
        drop = Dropped(profile.tops, bottoms, stones.boxes[at].tolist(), terms, lift)
        lean = drop.lean()
        cost = drop.cost(float(constants[at]), boxes) + terms.unbalanced * np.abs(lean)
        cost = np.where(drop.top > terms.height_px + terms.slack_px, np.inf, cost)
        cost = np.where(cost > cheapest.limit + CLOSE, np.inf, cost)
        for row, (place, price) in enumerate(_cheapest(cost, lift, apart, most)):
            y = lift[place] + terms.clearance_px
            rows[at, row] = place * terms.cell_px, y, price, lean[place]
            taken[at] = row + 1
        cheapest.keep(rows[at, : taken[at], 2].tolist(), group)
    return rows, taken, cheapest.limit


class Cheapest:
    """The costs of the cheapest drops so far, only so many of a group.

    Parameters
    ----------
    most : int
        How many; none when 0.
    each : int
        How many of a group.
    """

    def __init__(self, most: int, each: int) -> None:
        self.limit = math.inf
        self._most = most
        self._each = each
        self._kept: list[tuple[float, int]] = []

    def keep(self, costs: Sequence[float], group: int) -> None:
        """Take in the drops of a stone; the limit of what is still asked for may fall."""
        if not self._most:
            return
        every = sorted([*self._kept, *((cost, group) for cost in costs)])
        mine = [one for one in every if one[1] == group][self._each :]
        for one in mine:
            every.remove(one)
        self._kept = every[: self._most]
        if len(self._kept) == self._most:
            self.limit = self._kept[-1][0]


def touching(tops: Floats, bottoms: Floats, places: int) -> Floats:
    """Return y of the centroid where a stone touches first, for each of the first columns."""
    lift = np.full(places, -np.inf)
    for k, bottom in enumerate(bottoms.tolist()):
        lift = np.maximum(lift, tops[k : k + places] - bottom)
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
