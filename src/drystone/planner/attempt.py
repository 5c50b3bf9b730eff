"""One step: evaluate candidates on the landscape as it stands and choose (lines 6-17)."""

import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from itertools import chain
from operator import itemgetter
from statistics import fmean
from typing import TypeVar

import numpy as np

from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.model.pose import PosedStone
from drystone.planner import choose
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.deadline import NEVER, Deadline
from drystone.planner.evaluate import Evaluator
from drystone.planner.profile import Profile
from drystone.planner.proposing import Proposer, RasterProposer, StoneTrial, one_by_one
from drystone.planner.settings import PlannerSettings
from drystone.planner.settling import ExactProposer
from drystone.planner.workshop import Workshop
from drystone.selection.policies.registry import policy_named
from drystone.selection.policy import Policy
from drystone.selection.sampling import sample_stones, second_fold

Item = TypeVar("Item")
Result = TypeVar("Result")

TASKS = 16
"""Into how many tasks the candidates of a step are divided for an executor."""

SHORTLISTS = 8
"""Where stones fell in trials, no more shortlists are tried: 96 of 100 sure places are among these,
and at the end of a wall, where nothing is sure, all others would be tried in vain."""


class Attempt:
    """Attempts at the next action on one state of construction.

    Nothing is evaluated twice: the second fold, and attempts after a failure, meet stones that
    were tried on this very landscape before.  Neither the executor nor `until`, which is looked at
    for every candidate (TimeIsUp), shapes the result.
    """

    def __init__(
        self,
        workshop: Workshop,
        settings: PlannerSettings,
        build: Build,
        executor: Executor | None = None,
        profile: Profile | None = None,
        until: Deadline = NEVER,
    ) -> None:
        self.build = build
        self.solves = Solves()
        self._workshop = workshop
        self._settings = settings
        self._executor = executor
        self._until = until
        self._profile = profile or Profile()
        self._policy: Policy | None = None
        if settings.by_policy:
            # A new one for each step: what one remembers would be lost when a plan is resumed.
            rule = settings.selection_rule
            self._policy = policy_named(rule, settings.policy, settings.selection)
        kind = RasterProposer if settings.geometry == "raster" else ExactProposer
        self._proposer: Proposer = kind(workshop, settings, build, self._profile)
        self._evaluator = Evaluator(settings, workshop.stock, self._profile)
        sides: tuple[Side, ...] = ("left", "right") if settings.two_sided else ("left",)
        self._landscapes = {side: Landscape.of(build.wall, side) for side in sides}
        self._judged: dict[tuple[int, float, Side, int], Candidate] = {}
        # Those that stand, but fall in so large a share of the trials, which is bearable.
        self._unsure: list[tuple[float, Candidate]] = []
        self.declined = False  # whether a policy took none of the places that it was offered
        self._refused = False  # whether a stone fell in too many trials somewhere

    @property
    def candidates(self) -> int:
        """How many candidates were looked at."""
        return len(self._proposer.tried)

    def standing(self, among: Sequence[int]) -> list[Candidate]:
        """Return the actions of some stones, from all sides, after which the wall stands.

        They are what a policy is offered; of proposals that come in batches the first of which
        any stands.
        """
        for proposals in self._proposals(tuple(self._landscapes.values()), among):
            found = [candidate for candidate in self._judge(proposals) if candidate.stands]
            if found:
                return found
        return []

    def choose(
        self, rng: np.random.Generator, among: Sequence[int] | None = None
    ) -> Candidate | None:
        """Sample a candidate set of some stones, or of all that are left; return the best action.

        None when there is none.  UsageError (E147): the policy of another package failed.
        """
        remaining = tuple(self._workshop.remaining(self.build) if among is None else among)
        clusters = self._workshop.clusters
        sample = sample_stones(self._settings.sampling, remaining, clusters, rng)

        def best(landscapes: Sequence[Landscape]) -> Candidate | None:
            """Choose on some sides; with two-fold sampling in two rounds (§5.1)."""
            chosen = self._select(landscapes, sample, rng)
            if chosen is not None and self._settings.sampling == "twofold":
                fold = second_fold(chosen.stone_id, remaining, clusters)
                chosen = self._select(landscapes, fold, rng)
            return chosen

        if self._settings.selection_rule != "algorithm2":
            return best(tuple(self._landscapes.values()))
        winners = [best([landscape]) for landscape in self._landscapes.values()]
        found = [winner for winner in winners if winner is not None]
        return choose.better_side(found, self.build, self._settings.selection)

    def _select(
        self, landscapes: Sequence[Landscape], stones: Sequence[int], rng: np.random.Generator
    ) -> Candidate | None:
        for number, proposals in enumerate(self._proposals(landscapes, stones)):
            if number == SHORTLISTS and self._refused:
                break
            chosen = self._best(proposals, rng)
            if chosen is not None:
                return chosen
        # Nothing is sure.
        return min(self._unsure, key=itemgetter(0), default=(0.0, None))[1]

    def _sure(self, candidate: Candidate) -> bool:
        """Say whether a stone falls in no trial (:mod:`drystone.planner.seats`)."""
        wall = self.build.wall
        if wall.outlines is None:
            return True
        self._until.look()
        with self._profile.part("stabilisation"):
            least = min((falls for falls, _ in self._unsure), default=math.inf)
            falls = self._workshop.seats.falls(candidate.stabilised, wall, least)
        if falls:
            self._unsure.append((falls, candidate))
        self._refused |= falls != 0.0
        return falls == 0.0

    def _best(self, proposals: Sequence[Proposal], rng: np.random.Generator) -> Candidate | None:
        if self._policy is not None:
            name, settings = self._settings.selection_rule, self._settings.policy
            chosen, declined = choose.choose_by_policy(
                proposals, self._judge, self._policy, name=name, build=self.build,
                settings=settings, rng=rng,
            )  # fmt: skip
            self.declined |= declined
            return chosen
        if self._settings.selection_rule == "score":
            return choose.choose_by_score(proposals, self._judge, self._settings.score, self._sure)
        return choose.choose_by_algorithm2(proposals, self._judge, self._settings.selection)

    def _proposals(
        self, landscapes: Sequence[Landscape], stones: Sequence[int]
    ) -> Iterator[list[Proposal]]:
        """Place and stabilise the candidates of some sides (lines 7-15), batch by batch."""
        poses = self._workshop.poses
        if self._settings.orientation_choice == "placement":
            groups = [poses(stone_id) for stone_id in stones]
        else:
            groups = [(posed,) for stone_id in stones for posed in poses(stone_id)]
        trials = [StoneTrial(poses, view) for view in landscapes for poses in groups]
        heights = _course_heights(groups)
        for batch in self._proposer.proposals(trials, self._map):
            yield [
                replace(proposal, course_height_px=heights[proposal.stone_id]) for proposal in batch
            ]

    def _judge(self, proposals: Sequence[Proposal]) -> list[Candidate]:
        keys = [(p.stone_id, p.trial_angle_deg, p.side, p.spot) for p in proposals]
        new = [k for k, key in enumerate(keys) if key not in self._judged]
        if new:
            with self._profile.part("limit analysis"):
                # Before the threads ask for them, all at once.
                _ = self.build.analysis, self.build.sturdy_analysis
            with self._profile.part("contacts"):
                _ = None if self.build.wall.outlines else self.build.points
        results = self._map(
            lambda p: self._evaluator.judge(self.build, self._landscapes[p.side], p),
            [proposals[k] for k in new],
        )
        self._judged.update(zip([keys[k] for k in new], results, strict=True))
        self.solves = sum((one.solves for one in results), self.solves)
        # NHR depends on the other candidates, which differ between the folds.
        return [
            self._evaluator.compared(self._landscapes[proposal.side], proposal, self._judged[key])
            for proposal, key in zip(proposals, keys, strict=True)
        ]

    def _map(self, work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
        """Apply a function to all items, in their order, by the executor if there is one."""

        def in_time(item: Item) -> Result:
            self._until.look()
            return work(item)

        if self._executor is None or len(items) == 1:
            return one_by_one(in_time, items)
        # Handing over a candidate costs as much as a part of it: a few tasks, many candidates.
        size = math.ceil(len(items) / TASKS)
        chunks = [items[k : k + size] for k in range(0, len(items), size)] if items else []
        done = self._executor.map(partial(one_by_one, in_time), chunks)
        return [result for results in done for result in results]


def _course_heights(groups: Sequence[tuple[PosedStone, ...]]) -> dict[int, float | None]:
    """Return for each stone the mean height of the candidates that are other stones (Eq. 8)."""
    own: dict[int, list[float]] = {}
    for group in groups:
        own.setdefault(group[0].stone.id, []).append(fmean(posed.height_px for posed in group))
    total, count = math.fsum(chain(*own.values())), len(groups)
    return {
        stone_id: (total - math.fsum(mine)) / (count - len(mine)) if count > len(mine) else None
        for stone_id, mine in own.items()
    }
