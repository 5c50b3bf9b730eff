"""Stacking towers: how firmly a stone stands by itself."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from drystone.selection.algorithm2 import TIE_DIGITS
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policy import Offer


class Towers:
    """The least weighted cost of four terms with the weights of Furrer et al. (2017).

    What the terms became in a wall in 2D, all of it our reading:

    - area of the support polygon: the width of the support that is lacking to that of the stone,
      as a share of it;
    - kinetic energy of the stone after it was let go: nothing moves in time here, so the angle by
      which it turned until it rested (a stone that needs no turn has none);
    - distance of the centres: horizontal, of the centroid from the middle of the support;
    - deviation of the normal: the angle of the support's line from level.

    Each term is divided by the largest of the candidates, so that the weights compare like with
    like.  A stone that nothing bears from below has the largest of the last two.

    Parameters
    ----------
    settings : PolicySettings
        The weights.
    """

    def __init__(self, settings: PolicySettings) -> None:
        self._settings = settings

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:  # noqa: ARG002
        """See :class:`drystone.selection.policy.Policy`; ties go to the lower id, then angle."""
        settings = self._settings
        terms: tuple[tuple[float, Callable[[Offer], float | None]], ...] = (
            (settings.w_area, lacking_support),
            (settings.w_energy, lambda offer: offer.turned_deg),
            (settings.w_distance, centre_distance_px),
            (settings.w_normal, slope_rad),
        )
        shares = [(weight, _shares([term(o) for o in candidates])) for weight, term in terms]

        def rank(k: int) -> tuple[float, int, float]:
            cost = math.fsum(weight * values[k] for weight, values in shares)
            return round(cost, TIE_DIGITS), candidates[k].stone_id, candidates[k].angle_deg

        return min(range(len(candidates)), key=rank)


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
