"""Hierarchical filtering: one rule after the other removes what breaks it."""

from collections.abc import Callable, Sequence

import numpy as np

from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policies.simple import Lowest
from drystone.selection.policy import Offer


class Filters:
    """Fixed thresholds one after the other; the lowest of what passes.

    The order: support, IWR (IS at the ends of the wall), NHR, LFR.  A filter that nothing passes
    is left out, so there is always a choice.  The paper says of Liu et al. (2021) and Thangavelu
    et al. (2018) that they remove undesirable solutions by a hierarchy of filters made of
    features; features, order, thresholds and the last choice are our reading.  Unlike the means
    of Algorithm 2 these thresholds do not depend on the other candidates.

    Parameters
    ----------
    settings : PolicySettings
        The thresholds.
    """

    def __init__(self, settings: PolicySettings) -> None:
        self._settings = settings

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """See :class:`drystone.selection.policy.Policy`."""
        pool = list(range(len(candidates)))
        for passes in (self._supported, self._bonded, self._level, self._tight):
            pool = _kept(candidates, pool, passes)
        lowest = Lowest().choose([candidates[k] for k in pool], rng)
        return None if lowest is None else pool[lowest]

    def _supported(self, offer: Offer) -> bool:
        return offer.support_width_px >= self._settings.min_support * offer.width_px

    def _bonded(self, offer: Offer) -> bool:
        settings, indices = self._settings, offer.indices
        least = settings.min_slope if indices.boundary else settings.min_interlocking
        return indices.third >= least

    def _level(self, offer: Offer) -> bool:
        return offer.indices.NHR <= self._settings.max_step

    def _tight(self, offer: Offer) -> bool:
        return offer.indices.LFR >= self._settings.min_filling


def _kept(
    candidates: Sequence[Offer], pool: Sequence[int], passes: Callable[[Offer], bool]
) -> list[int]:
    """Return what passes a filter; all when nothing does."""
    return [k for k in pool if passes(candidates[k])] or list(pool)
