"""Linear scalarisation: one weighted sum of all indices."""

from collections.abc import Sequence

import numpy as np

from drystone.selection.algorithm2 import TIE_DIGITS, Action, SelectionSettings, weighted_sum
from drystone.selection.policy import Offer


class Scalarised:
    """The largest weighted sum of LLC, -NHR, IWR or IS, GDS, LFR and SF.

    The paper says of Johns et al. (2020) and Lambert and Kennedy (2012) that they sum all
    objectives linearly; which terms and weights they have it does not say.  These are the paper's
    own indices, without its filters.

    Parameters
    ----------
    weights : SelectionSettings
        Of the first five.
    w_sf : float
        Of SF.
    """

    def __init__(self, weights: SelectionSettings, w_sf: float) -> None:
        self._weights = weights
        self._w_sf = w_sf

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:  # noqa: ARG002
        """See :class:`drystone.selection.policy.Policy`; ties as in Algorithm 2."""

        def rank(k: int) -> tuple[float, int, float]:
            offer = candidates[k]
            action = Action(offer.stone_id, offer.angle_deg, offer.indices)
            total = weighted_sum(action, self._weights) + self._w_sf * offer.indices.SF
            return -round(total, TIE_DIGITS), offer.stone_id, offer.angle_deg

        return min(range(len(candidates)), key=rank)
