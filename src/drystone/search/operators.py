"""How a chain changes its wall: more often in the ways that have helped."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

RECREATED, RELAID, REPLANNED, NEW = "recreated", "relaid", "replanned", "new"
"""A part is taken down and built up again; upper courses are laid again, or planned again and
laid; or courses are planned for a new wall."""

OPERATORS = (RECREATED, RELAID, REPLANNED, NEW)

RELAID_SHARE, REPLANNED_SHARE = 0.5, 0.45
"""Shares of those changes of a planned wall that use its plan, before anything is known; the others
are new plans."""

EXPECTED, WEIGHT = 0.1, 6.0
"""How often an operator helps before anything is known, and for how many uses that counts."""


def shares(planned: bool, polish: float) -> tuple[float, ...]:
    """Return the shares of the operators before anything is known."""
    if not planned:
        return (1.0, 0.0, 0.0, 0.0)
    new = 1.0 - RELAID_SHARE - REPLANNED_SHARE
    return (polish, *((1.0 - polish) * one for one in (RELAID_SHARE, REPLANNED_SHARE, new)))


@dataclass(frozen=True)
class Credits:
    """How often operators were used, and how often a wall was better than the one it came from."""

    uses: tuple[int, ...] = (0,) * len(OPERATORS)  # in the order of `OPERATORS`
    helped: tuple[int, ...] = (0,) * len(OPERATORS)

    def __add__(self, other: "Credits") -> "Credits":
        return Credits(
            tuple(a + b for a, b in zip(self.uses, other.uses, strict=True)),
            tuple(a + b for a, b in zip(self.helped, other.helped, strict=True)),
        )

    def after(self, operator: str, helped: bool) -> "Credits":
        """Return what is known after one more use."""
        at = OPERATORS.index(operator)
        used = tuple(int(k == at) for k in range(len(OPERATORS)))
        return self + Credits(used, tuple(int(helped) * one for one in used))

    def drawn(self, usual: Sequence[float], rng: Generator) -> str:
        """Draw an operator: the more often it has helped, the likelier."""
        rate = [
            share * (helped + EXPECTED * WEIGHT) / (uses + WEIGHT)
            for share, uses, helped in zip(usual, self.uses, self.helped, strict=True)
        ]
        ends = np.cumsum(rate)
        return OPERATORS[int(np.searchsorted(ends, rng.random() * ends[-1], side="right"))]
