"""Policies that ask little: anything that stands, and the lowest."""

from collections.abc import Sequence

import numpy as np

from drystone.selection.algorithm2 import TIE_DIGITS
from drystone.selection.policy import Offer


class Random:
    """Any action after which the wall stands, all with the same chance."""

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """See :class:`drystone.selection.policy.Policy`."""
        return int(rng.integers(len(candidates)))


class Lowest:
    """The lowest centroid, then the largest LFR, then the nearest to the building side.

    That is the order in which the released code of the paper's authors goes through the places of
    one stone (lowest, tightest, first from the building side), here between stones.
    """

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:  # noqa: ARG002
        """See :class:`drystone.selection.policy.Policy`."""

        def rank(k: int) -> tuple[float, ...]:
            offer = candidates[k]
            firsts = offer.centroid_px[1], -offer.indices.LFR, offer.from_end_px
            rounded = (round(value, TIE_DIGITS) for value in firsts)
            return (*rounded, offer.stone_id, offer.angle_deg)

        return min(range(len(candidates)), key=rank)
