"""The systems of Table 1 as policies: what each looks at, and how it chooses.

The paper says which components each has, how they are combined, and little more: that Thangavelu
et al. (2018) maximise the number of contacting stones, and that Johns et al. (2020) and Liu et al.
(2021) let an engine remove poses that do not hold.  No weights are published in it, so all are 1.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from drystone.selection.algorithm2 import MEAN_SLACK, TIE_DIGITS
from drystone.selection.policies.choices import Lowest, lacking_support
from drystone.selection.policies.learned import FEATURES, ValueModel, shipped_model
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policy import Offer

MARKS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "paper": (
            "packing", "course", "interlocking", "wedging", "sloping", "gravity", "lateral",
        ),
        "johns": ("packing", "footing", "gravity"),
        "lambert": ("packing", "course", "footing", "sloping"),
        "liu2021": ("packing", "course", "interlocking", "footing", "sloping", "gravity"),
        "thangavelu": ("interlocking", "sloping", "gravity", "lateral"),
        "menezes": ("packing", "gravity"),
        "liu2018": ("packing", "interlocking", "gravity", "lateral"),
    }
)  # fmt: skip
"""Components that each policy has.  Our copy of Table 1 has lost its columns: how many marks a row
has is the paper's, and whose they are only where its text says so; the others are our reading."""

ENGINE = ("johns", "liu2021")
"""Those that ask an engine, while `gravity` is on: a pose that does not hold is dropped."""

LEARNED: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "packing": ("LFR", "GDS", "LFR_rank", "sliver", "end_sliver"),
        "course": ("NHR", "flush"),
        "interlocking": ("IWR",),
        "footing": ("support", "off_centre"),
        "sloping": ("IS", "slope"),
        "gravity": ("turned", "wedges"),
        "lateral": ("LLC", "LLC_rank"),
    }
)
"""Features of the learned value that belong to a component; the others are of the place alone."""


def parts(name: str, settings: PolicySettings) -> tuple[str, ...]:
    """Return the components that a policy has and that are not switched off."""
    return tuple(part for part in MARKS[name] if getattr(settings, part, True))


def _bond(offer: Offer) -> float:
    return 0.5 if offer.indices.boundary else offer.indices.IWR


def _slope(offer: Offer) -> float:
    return offer.indices.IS if offer.indices.boundary else 0.0


TERMS: Mapping[str, Callable[[Offer], float]] = MappingProxyType(
    {
        "packing": lambda offer: offer.indices.LFR,
        "course": lambda offer: -offer.indices.NHR,
        "interlocking": _bond,
        "footing": lambda offer: 1.0 - lacking_support(offer),
        "sloping": _slope,
        "gravity": lambda offer: -offer.turned_deg / 90.0,
        "lateral": lambda offer: offer.indices.LLC or 0.0,
    }
)
"""What is good in a component, larger is better."""


class Summed:
    """The largest sum of the components (linear scalarisation); ties go to the lower id."""

    def __init__(self, components: Sequence[str]) -> None:
        self._components = components

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:  # noqa: ARG002
        """See :class:`drystone.selection.policy.Policy`."""

        def rank(k: int) -> tuple[float, int]:
            total = math.fsum(TERMS[part](candidates[k]) for part in self._components)
            return -round(total, TIE_DIGITS), candidates[k].stone_id

        return min(range(len(candidates)), key=rank)


class Filtered:
    """Filters at the mean of what is left, one after the other; of what passes the lowest.

    With `contacts` interlocking is the number of stones that a stone touches, and only those with
    the most pass.
    """

    def __init__(self, components: Sequence[str], *, contacts: bool = False) -> None:
        self._components = components
        self._contacts = contacts

    def choose(self, candidates: Sequence[Offer], rng: np.random.Generator) -> int | None:
        """See :class:`drystone.selection.policy.Policy`."""
        pool = list(candidates)
        for part in self._components:
            if part == "interlocking" and self._contacts:
                most = max(len(offer.touches) for offer in pool)
                pool = [offer for offer in pool if len(offer.touches) == most]
                continue
            values = [TERMS[part](offer) for offer in pool]
            least = math.fsum(values) / len(values) - MEAN_SLACK
            pool = [offer for offer, value in zip(pool, values, strict=True) if value >= least]
        lowest = Lowest().choose(pool, rng)
        return None if lowest is None else list(candidates).index(pool[lowest])


def learned_parts(components: Sequence[str]) -> ValueModel:
    """Return the learned values without the features of components that are not named."""
    model = shipped_model()
    left_out = {one for part, names in LEARNED.items() if part not in components for one in names}
    pairs = zip(FEATURES, model.weights, strict=True)
    return ValueModel(tuple(0.0 if f in left_out else w for f, w in pairs), model.trained)
