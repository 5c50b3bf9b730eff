"""Choosing the action of a step from the proposals of both sides (lines 17, Eq. 29)."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.offers import holds, offer
from drystone.selection.algorithm2 import (
    TIE_DIGITS,
    Action,
    SelectionSettings,
    select_action,
    weighted_sum,
)
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.policies.table1 import ENGINE
from drystone.selection.policy import Policy, choice_of
from drystone.selection.scored import ScoreSettings

Judge = Callable[[Sequence[Proposal]], list[Candidate]]


def choose_by_algorithm2(
    proposals: Sequence[Proposal], judge: Judge, settings: SelectionSettings
) -> Candidate | None:
    """Return the best action of one side by Algorithm 2; all proposals are analysed."""
    candidates = [candidate for candidate in judge(proposals) if candidate.sturdy]
    selected = select_action([action_of(c, settings) for c in candidates], settings)
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
    # So near they are equal (DESIGN 4.7).
    level = [winner for winner in winners if winner.indices.GDS >= most - 1e-9]

    def rank(winner: Candidate) -> tuple[float, int, bool]:
        total = weighted_sum(action_of(winner, settings), settings)
        used = sum(action.side == winner.side for action in build.actions)
        return -round(total, TIE_DIGITS), used, winner.side != "left"

    return min(level, key=rank)


def action_of(candidate: Candidate, settings: SelectionSettings) -> Action:
    """Return what selection sees of a candidate."""
    indices = candidate.indices
    if settings.clip_nhr:
        indices = replace(indices, NHR=min(1.0, indices.NHR))
    return Action(candidate.stone_id, indices)


def choose_by_score(
    proposals: Sequence[Proposal],
    judge: Judge,
    settings: ScoreSettings,
    sure: Callable[[Candidate], bool] = lambda _: True,
) -> Candidate | None:
    """Return the action of the least cost, lateral resistance included.

    Proposals are analysed from the cheapest on, in batches, until enough of them stand, and one of
    these is sure.
    """
    order = sorted(
        proposals, key=lambda p: (round(p.cost, 12), p.stone_id, p.side != "left", p.spot)
    )

    def cost(candidate: Candidate) -> float:
        bonus = settings.llc * (candidate.indices.LLC or 0.0)
        return round(candidate.proposal.cost - bonus, TIE_DIGITS)

    standing: list[Candidate] = []
    for start in range(0, len(order), settings.analysed):
        batch = judge(order[start : start + settings.analysed])
        standing += [c for c in batch if c.stands]
        if len(standing) >= settings.analysed or start + settings.analysed >= len(order):
            compared, standing = standing[: settings.analysed], standing[settings.analysed :]
            for candidate in sorted(compared, key=cost):
                if sure(candidate):
                    return candidate
    return next((c for c in standing if sure(c)), None)


def choose_by_policy(
    proposals: Sequence[Proposal],
    judge: Judge,
    policy: Policy,
    *,
    name: str,
    build: Build,
    settings: PolicySettings,
    rng: np.random.Generator,
) -> tuple[Candidate | None, bool]:
    """Return the action that a policy chooses among those after which the wall stands.

    Says too whether it took none of those that it was offered.  Where it asks an engine, what does
    not stay where it is put is dropped, and it chooses again.

    All proposals, those of all sides, are analysed; as with the other rules LLC must be positive.
    UsageError (E147): the policy failed.
    """
    standing = [c for c in judge(proposals) if c.stands]
    wall, mu = build.wall, build.analysis.model.mu
    wedges = frozenset(wedge.id for wedge in wall.wedges)
    asks = name in ENGINE and settings.gravity
    while True:
        offers = [offer(one, wall.site, wedges) for one in standing]
        position = choice_of(name, policy, offers, rng)
        if position is None:
            return None, bool(offers)
        chosen = standing[position]
        if not asks or holds(wall, chosen.stabilised, mu):
            return chosen, False
        standing = [one for one in standing if one is not chosen]
