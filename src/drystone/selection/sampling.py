"""Candidate sets Pi_i: which of the remaining stones are tried in a step (§3.4, §5.1)."""

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

Sampling = Literal["variant", "shrinking", "uniform", "twofold", "full"]


def sample_stones(
    sampling: Sampling,
    remaining: Sequence[int],
    clusters: Mapping[int, int],
    rng: np.random.Generator,
) -> tuple[int, ...]:
    """Return the ids of the stones to try first in a step; these and those that are left ascend.

    How, :class:`drystone.planner.settings.PlannerSettings` says; with ``"twofold"`` then follows
    :func:`second_fold`, with ``"full"`` nothing is drawn.  `clusters` has every stone of the set.
    """
    if sampling == "full" or not remaining:
        return tuple(remaining)
    drawn: set[int] = set()
    if sampling != "uniform":
        members: dict[int, list[int]] = {}
        for stone_id in remaining:
            members.setdefault(clusters[stone_id], []).append(stone_id)
        drawn = {int(rng.choice(members[cluster])) for cluster in sorted(members)}
    lacking = min(len(set(clusters.values())), len(remaining)) - len(drawn)
    if sampling != "shrinking" and lacking:
        others = [i for i in remaining if i not in drawn]
        drawn.update(rng.choice(others, size=lacking, replace=False).tolist())
    return tuple(sorted(drawn))


def second_fold(
    winner: int, remaining: Sequence[int], clusters: Mapping[int, int]
) -> tuple[int, ...]:
    """Return all remaining stones of the winner's cluster: the second fold of two-fold sampling."""
    return tuple(i for i in remaining if clusters[i] == clusters[winner])
