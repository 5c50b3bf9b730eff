"""Walls of a search none of which is better than another in every figure of merit."""

from collections.abc import Iterable

from drystone.search.goal import Figures
from drystone.search.packed import Packed

MOST = 12
"""So many walls are kept."""

STEPS = {"F_SF": 0.005, "F_AV": 1.0, "F_AH": -0.1, "carried": 0.02}
"""Differences of figures that count; below 0 where less is better."""


def archived(kept: Iterable[Packed], more: Iterable[Packed]) -> tuple[Packed, ...]:
    """Add walls to those of which none is beaten by another.

    A wall is beaten by one of at least its merit that is at least as good in every figure, rounded
    to :data:`STEPS`; one that lacks pinned stones is, by any of more merit that lacks fewer.
    """
    scored = [(wall, score_of(wall.figures)) for wall in (*kept, *more) if wall.figures is not None]
    # None is beaten by one after it.
    scored.sort(key=lambda one: (one[0].merit, one[1]), reverse=True)
    found: list[tuple[Packed, tuple[int, ...]]] = []
    for wall, score in scored:
        if not any(as_good(other, score) for _, other in found):
            found.append((wall, score))
    return tuple(wall for wall, _ in found[:MOST])


def score_of(figures: Figures) -> tuple[int, ...]:
    """Return the figures in steps, and the pinned stones that are there; higher is better."""
    steps = (round(getattr(figures, name) / step) for name, step in STEPS.items())
    return (-figures.missing, *steps)


def as_good(one: tuple[int, ...], other: tuple[int, ...]) -> bool:
    """Say whether a wall is at least as good as another in every figure, and lacks no more."""
    if one[0] != other[0]:
        return one[0] > other[0]
    return all(a >= b for a, b in zip(one, other, strict=True))
