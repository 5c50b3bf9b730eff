"""Policies that choose by rules: at random, the lowest, by a sum, by filters, as towers do."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from drystone.selection.algorithm2 import TIE_DIGITS, Action, SelectionSettings, weighted_sum
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policy import Offer


class Random:
    """Any action after which the wall stands, all with the same chance."""

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """See :class:`drystone.selection.policy.Policy`."""
        return int(rng.integers(len(candidates)))


@dataclass(frozen=True)
class Largest:
    """The action of the largest values, the first of which counts most; ties go to the lower id."""

    values: Callable[[Sequence[Offer]], Sequence[Sequence[float]]]  # of all candidates

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int:  # noqa: ARG002
        """See :class:`drystone.selection.policy.Policy`."""
        values = self.values(candidates)

        def rank(k: int) -> tuple[float, ...]:
            return (*(-round(value, TIE_DIGITS) for value in values[k]), candidates[k].stone_id)

        return min(range(len(candidates)), key=rank)


LOWEST = Largest(
    lambda offers: [(-o.centroid_px[1], o.indices.LFR, -o.from_end_px) for o in offers]
)
"""The lowest centroid, then the largest LFR, then the nearest to the building side.

That is the order in which the released code of the paper's authors goes through the places of one
stone (lowest, tightest, first from the building side), here between stones."""


def scalarised(weights: SelectionSettings, w_sf: float) -> Largest:
    """Return the policy of the largest weighted sum of LLC, -NHR, IWR or IS, GDS, LFR and SF.

    The paper says of Johns et al. (2020) and Lambert and Kennedy (2012) that they sum all
    objectives linearly; which terms and weights they have it does not say.  These are the paper's
    own indices, without its filters; `w_sf` is the weight of SF.
    """

    def total(offer: Offer) -> float:
        return (
            weighted_sum(Action(offer.stone_id, offer.indices), weights) + w_sf * offer.indices.SF
        )

    return Largest(lambda offers: [(total(offer),) for offer in offers])


@dataclass(frozen=True)
class Sieve:
    """Filters one after the other; of what passes the lowest.

    A filter that nothing passes is left out, so there is always a choice.
    """

    filters: Sequence[Callable[[Sequence[Offer]], list[Offer]]]

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int:
        """See :class:`drystone.selection.policy.Policy`."""
        pool = list(candidates)
        for passing in self.filters:
            pool = passing(pool) or pool
        return list(candidates).index(pool[LOWEST.choose(pool, rng)])


def thresholds(settings: PolicySettings) -> Sieve:
    """Return the policy of fixed thresholds: of support, IWR (IS at the wall's ends), NHR, LFR.

    The paper says of Liu et al. (2021) and Thangavelu et al. (2018) that they remove undesirable
    solutions by a hierarchy of filters made of features; features, order, thresholds and the last
    choice are our reading.  Unlike the means of Algorithm 2 these thresholds do not depend on the
    other candidates.
    """

    def bonded(offer: Offer) -> bool:
        least = settings.min_slope if offer.indices.boundary else settings.min_interlocking
        return offer.indices.third >= least

    return Sieve(
        (
            lambda pool: [
                o for o in pool if o.support_width_px >= settings.min_support * o.width_px
            ],
            lambda pool: list(filter(bonded, pool)),
            lambda pool: [o for o in pool if o.indices.NHR <= settings.max_step],
            lambda pool: [o for o in pool if o.indices.LFR >= settings.min_filling],
        )
    )


def towers(settings: PolicySettings) -> Largest:
    """Return the policy of the least cost of four terms, with the weights of Furrer et al. (2017).

    What the terms became in a wall in 2D, all of it our reading:

    - area of the support polygon: the width of the support that is lacking to that of the stone,
      as a share of it;
    - kinetic energy of the stone after it was let go: nothing moves in time here, so the angle by
      which it turned until it rested (a stone that needs no turn has none);
    - distance of the centres: horizontal, of the centroid from the middle of the support;
    - deviation of the normal: the angle of the support's line from level.

    Each term is divided by the largest of the candidates, so that the weights compare like with
    like.  A stone that nothing bears from below has the largest of the last two.
    """
    terms: tuple[tuple[float, Callable[[Offer], float | None]], ...] = (
        (settings.w_area, lacking_support),
        (settings.w_energy, lambda offer: offer.turned_deg),
        (settings.w_distance, centre_distance_px),
        (settings.w_normal, slope_rad),
    )

    def values(offers: Sequence[Offer]) -> list[tuple[float]]:
        shares = [(weight, _shares([term(o) for o in offers])) for weight, term in terms]
        return [
            (-math.fsum(weight * share[k] for weight, share in shares),) for k in range(len(offers))
        ]

    return Largest(values)


def lacking_support(offer: Offer) -> float:
    """Return the share of a stone's width that its support lacks, in [0, 1]."""
    return max(0.0, 1.0 - offer.support_width_px / offer.width_px)


def centre_distance_px(offer: Offer) -> float | None:
    """Return the horizontal distance of the centroid from the middle of the support."""
    if offer.support_px is None:
        return None
    (left, _), (right, _) = offer.support_px
    return abs(offer.centroid_px[0] - (left + right) / 2)


def slope_rad(offer: Offer) -> float | None:
    """Return the angle of the line of the support from level, in [0, pi / 2]."""
    if offer.support_px is None:
        return None
    (left, low), (right, high) = offer.support_px
    return math.atan2(abs(high - low), right - left)


def _shares(values: Sequence[float | None]) -> list[float]:
    """Divide by the largest; what is not known is as bad as that."""
    most = max((value for value in values if value is not None), default=0.0)
    if most <= 0.0:
        return [float(value is None) for value in values]
    return [1.0 if value is None else value / most for value in values]
