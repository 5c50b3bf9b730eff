"""Choosing the action of a step from the proposals of both sides (lines 17, Eq. 29)."""

from collections.abc import Callable, Sequence

import numpy as np

from drystone.model.site import Site
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.offers import offer
from drystone.selection.algorithm2 import (
    TIE_DIGITS,
    Action,
    SelectionSettings,
    select_action,
    weighted_sum,
)
from drystone.selection.policy import Policy, choice_of
from drystone.selection.scored import ScoreSettings, cheapest_first

EQUAL_GDS = 1e-9
"""Two winners' GDS within this are equal (DESIGN 4.7)."""

Judge = Callable[[Sequence[Proposal]], list[Candidate]]


def choose_by_algorithm2(
    proposals: Sequence[Proposal], judge: Judge, settings: SelectionSettings
) -> Candidate | None:
    """Return the best action of one side by Algorithm 2; all proposals are analysed."""
    candidates = [candidate for candidate in judge(proposals) if candidate.sturdy]
    selected = select_action([_action(c) for c in candidates], settings)
    return None if selected is None else candidates[selected.position]


def better_side(
    winners: Sequence[Candidate], build: Build, settings: SelectionSettings
) -> Candidate | None:
    """Return the better of the sides' winners (Eq. 29).

    The larger GDS; when equal the larger weighted sum, then the side used less, then left.
    """
    if not winners:
        return None
    most = max(winner.indices.GDS for winner in winners)
    level = [winner for winner in winners if winner.indices.GDS >= most - EQUAL_GDS]

    def rank(winner: Candidate) -> tuple[float, int, bool]:
        total = weighted_sum(_action(winner), settings)
        return -round(total, TIE_DIGITS), build.count(winner.side), winner.side != "left"

    return min(level, key=rank)


def _action(candidate: Candidate) -> Action:
    return Action(candidate.stone_id, candidate.proposal.trial_angle_deg, candidate.indices)


def choose_by_score(
    proposals: Sequence[Proposal], judge: Judge, settings: ScoreSettings
) -> Candidate | None:
    """Return the action of the least cost, lateral resistance included.

    Proposals are analysed from the cheapest on, in batches, until enough of them stand.
    """
    keys = [(p.stone_id, p.trial_angle_deg, float(p.side != "left"), p.spot) for p in proposals]
    order = cheapest_first([p.cost for p in proposals], keys)
    standing: list[Candidate] = []
    for start in range(0, len(order), settings.analysed):
        batch = judge([proposals[k] for k in order[start : start + settings.analysed]])
        standing += [c for c in batch if c.stands]
        if len(standing) >= settings.analysed:
            break

    def cost(candidate: Candidate) -> float:
        bonus = settings.llc * (candidate.indices.LLC or 0.0)
        return round(candidate.proposal.cost - bonus, TIE_DIGITS)

    return min(standing[: settings.analysed], key=cost, default=None)


def choose_by_policy(
    proposals: Sequence[Proposal],
    judge: Judge,
    policy: Policy,
    *,
    name: str,
    site: Site,
    rng: np.random.Generator,
) -> Candidate | None:
    """Return the action that a policy chooses among those after which the wall stands.

    All proposals, those of all sides, are analysed; as with the other rules LLC must be positive.
    UsageError (E147): the policy failed.
    """
    standing = [c for c in judge(proposals) if c.stands]
    position = choice_of(name, policy, [offer(one, site) for one in standing], rng)
    return None if position is None else standing[position]
