"""Selecting the best action: hierarchical filters, then a weighted sum (§3.8, Algorithm 2)."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import TypeVar

from drystone.indices import Indices

Item = TypeVar("Item")

TIE_DIGITS = 9
"""Sums that contain LLC are equal to the precision of the limit analysis."""

MEAN_SLACK = 10.0**-TIE_DIGITS
"""So are values of LLC.  A mean may round above every one of equal values, and drop all."""


@dataclass(frozen=True, kw_only=True)
class SelectionSettings:
    """Weights of the objective functions (Eq. 15-22).

    Parameters
    ----------
    w_llc, w_nhr, w_third, w_gds, w_lfr : float
        Weights of LLC, -NHR, IWR or IS, GDS and LFR; the paper uses 1 for each.
    clip_nhr : bool
        NHR above 1 counts as 1: that of the first stone of a course has no bound (Eq. 8).
    """

    w_llc: float = 1.0
    w_nhr: float = 1.0
    w_third: float = 1.0
    w_gds: float = 1.0
    w_lfr: float = 1.0
    clip_nhr: bool = False

    @property
    def weights(self) -> tuple[float, float, float, float, float]:
        """omega_1 to omega_5."""
        return self.w_llc, self.w_nhr, self.w_third, self.w_gds, self.w_lfr


@dataclass(frozen=True)
class Action:
    """What selection sees of a candidate."""

    stone_id: int
    indices: Indices

    @property
    def llc(self) -> float:
        """LLC, with "does not stand" below every number."""
        return -math.inf if self.indices.LLC is None else self.indices.LLC

    @property
    def terms(self) -> tuple[float, float, float, float, float]:
        """LLC, -NHR, IWR or IS, GDS, LFR: the order of the filters."""
        i = self.indices
        return self.llc, -i.NHR, i.third, i.GDS, i.LFR


@dataclass(frozen=True)
class Selected:
    """The best action."""

    position: int  # its place among the actions given
    # the positions that passed each filter: K_1 of them, K_2, ...
    survivors: tuple[tuple[int, ...], ...]


def select_action(
    actions: Sequence[Action], settings: SelectionSettings | None = None
) -> Selected | None:
    """Return the best action (Algorithm 2); None when no action has LLC > 0.

    Filters keep what is at least the mean of the survivors, in the order LLC, -NHR, IWR | IS, GDS,
    LFR; boundary stones are compared with boundary stones at the third, inner ones with inner
    ones.  When a filter would keep nothing, the choice is by the sum of the terms so far.  Ties go
    to the lower id, then to the first of the poses (of no angle: it depends on the photograph).
    """
    settings = settings or SelectionSettings()
    pool = [k for k, action in enumerate(actions) if action.llc > 0]  # Pi_1
    if not pool:
        return None
    survivors = [tuple(pool)]
    for used in range(1, 6):
        kept = _at_least_mean(actions, pool, used - 1)
        survivors.append(tuple(kept))
        if not kept:
            break
        pool = kept

    sums = {k: round(weighted_sum(actions[k], settings, used), TIE_DIGITS) for k in pool}
    best = min(pool, key=lambda k: (-sums[k], actions[k].stone_id))
    return Selected(best, tuple(survivors))


def weighted_sum(action: Action, settings: SelectionSettings, terms: int = 5) -> float:
    """Return the objective of Eq. 15-22 with the first so many terms."""
    pairs = zip(settings.weights[:terms], action.terms[:terms], strict=True)
    return math.fsum(weight * term for weight, term in pairs)


def _at_least_mean(actions: Sequence[Action], pool: Sequence[int], term: int) -> list[int]:
    """Keep the actions whose term reaches the mean of the pool (Eq. 14, 16, 18)."""
    groups = [pool]
    if term == 2:  # IS of boundary stones, IWR of inner ones
        boundary = [k for k in pool if actions[k].indices.boundary]
        groups = [boundary, [k for k in pool if not actions[k].indices.boundary]]
    kept = (at_least_mean(group, lambda k: actions[k].terms[term]) for group in groups if group)
    return sorted(chain(*kept))


def at_least_mean(pool: Sequence[Item], value: Callable[[Item], float]) -> list[Item]:
    """Keep what reaches the mean of all."""
    values = [value(one) for one in pool]
    least = math.fsum(values) / len(values) - MEAN_SLACK
    return [one for one, worth in zip(pool, values, strict=True) if worth >= least]
