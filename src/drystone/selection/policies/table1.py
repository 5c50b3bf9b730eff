"""The systems of Table 1 as policies: what each looks at, and how it chooses.

The paper says which components each has, how they are combined, and little more: that Thangavelu
et al. (2018) maximise the number of contacting stones, and that Johns et al. (2020) and Liu et al.
(2021) let an engine remove poses that do not hold.  No weights are published in it, so all are 1.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType

from drystone.selection.algorithm2 import at_least_mean
from drystone.selection.policies.choices import Largest, Sieve, lacking_support
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


TERMS: Mapping[str, Callable[[Offer], float]] = MappingProxyType(
    {
        "packing": lambda offer: offer.indices.LFR,
        "course": lambda offer: -offer.indices.NHR,
        "interlocking": lambda offer: 0.5 if offer.indices.boundary else offer.indices.IWR,
        "footing": lambda offer: 1.0 - lacking_support(offer),
        "sloping": lambda offer: offer.indices.IS if offer.indices.boundary else 0.0,
        "gravity": lambda offer: -offer.turned_deg / 90.0,
        "lateral": lambda offer: offer.indices.LLC or 0.0,
    }
)
"""What is good in a component, larger is better."""


def summed(components: Sequence[str]) -> Largest:
    """Return the policy of the largest sum of some components (linear scalarisation)."""
    return Largest(
        lambda offers: [(math.fsum(TERMS[part](o) for part in components),) for o in offers]
    )


def filtered(components: Sequence[str], *, contacts: bool = False) -> Sieve:
    """Return the policy of filters at the mean of what is left, one a component.

    With `contacts` interlocking is the number of stones that a stone touches, and only those with
    the most pass.
    """
    by_contacts = {"interlocking": _most_touching} if contacts else {}
    return Sieve(
        [by_contacts.get(part, partial(at_least_mean, value=TERMS[part])) for part in components]
    )


def _most_touching(pool: Sequence[Offer]) -> list[Offer]:
    most = max(len(offer.touches) for offer in pool)
    return [offer for offer in pool if len(offer.touches) == most]


def learned_parts(components: Sequence[str]) -> ValueModel:
    """Return the learned values without the features of components that are not named."""
    model = shipped_model()
    left_out = {one for part, names in LEARNED.items() if part not in components for one in names}
    pairs = zip(FEATURES, model.weights, strict=True)
    return ValueModel(tuple(0.0 if f in left_out else w for f, w in pairs), model.trained)
