"""Proposals on pixels, and what both proposers promise."""

import math

import numpy as np
import pytest

from drystone.model.landscape import Landscape
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.proposing import SPARE, RasterProposer, StoneTrial, one_by_one
from drystone.planner.settings import PlannerSettings
from drystone.planner.settling import ExactProposer
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, rubble


class _Watched:
    """Trials of a step on pixels, and which of them were placed and stabilised."""

    def __init__(self, monkeypatch, built):
        settings = greedy({"geometry": "raster"})
        planner = finish(Planner(rubble(count=30), RUBBLE_SITE, settings=settings), built)
        workshop, build = planner.workshop, planner.build
        self.proposer = RasterProposer(workshop, settings, build, Profile())
        self.analysed = settings.score.analysed
        view = Landscape.of(build.wall)
        self.trials = [
            StoneTrial((posed,), view)
            for stone_id in workshop.remaining(build)
            for posed in workshop.poses(stone_id)
        ]
        self.placed = []
        self.stable = []
        spotted, stabilised = RasterProposer.spotted, RasterProposer.stabilised

        def watched_spotted(this, trial):
            self.placed.append(trial.key)
            return spotted(this, trial)

        def watched_stabilised(this, one):
            self.stable.append(one.trial.key)
            return stabilised(this, one)

        monkeypatch.setattr(RasterProposer, "spotted", watched_spotted)
        monkeypatch.setattr(RasterProposer, "stabilised", watched_stabilised)


@pytest.mark.parametrize("built", [2, 9])
def test_by_cost_the_cheapest_come_first_and_the_others_only_when_asked_for(built, monkeypatch):
    # Looked at often, so that it stops as soon as it may.
    monkeypatch.setattr("drystone.planner.proposing.TOGETHER", 2)
    step = _Watched(monkeypatch, built)
    batches = step.proposer.proposals(step.trials, one_by_one)
    first = next(batches)
    assert len(step.stable) < 0.7 * len(step.trials)
    later = [proposal for batch in batches for proposal in batch]
    assert sorted(step.placed) == sorted(trial.key for trial in step.trials)
    assert len(step.stable) == len(set(step.stable))
    costs = sorted(proposal.cost for proposal in first)
    unturned = [
        proposal.cost
        for proposal in later
        if not (proposal.stabilised.placement.rotation_moves or proposal.stabilised.wedges)
    ]
    # None that stays where it was placed is cheaper than as many as may be analysed first.
    assert len(unturned) > 8
    assert min(unturned) >= costs[SPARE * step.analysed - 1]
    (again, *rest) = step.proposer.proposals(step.trials, one_by_one)
    assert again == first
    assert [proposal for batch in rest for proposal in batch] == later


def test_a_promise_is_the_least_that_a_stone_costs_where_it_stays(monkeypatch):
    step = _Watched(monkeypatch, 6)
    stays = 0
    for trial in step.trials:
        spotted = step.proposer.spotted(trial)
        proposal = step.proposer.stabilised(spotted)
        assert (spotted.promise == math.inf) == (not spotted.spots)
        if proposal is not None:
            stabilised = proposal.stabilised
            if not (stabilised.placement.rotation_moves or stabilised.wedges):
                assert spotted.promise <= proposal.cost + 1e-9
                stays += 1
    assert stays > 10


@pytest.mark.parametrize("geometry", ["raster", "exact"])
@pytest.mark.parametrize("rule", ["score", "algorithm2"])
def test_what_is_proposed_is_of_the_trials_and_none_of_it_is_in_the_way(geometry, rule):
    settings = greedy({"geometry": geometry, "selection_rule": rule})
    planner = finish(Planner(rubble(2), RUBBLE_SITE, settings=settings), 2)
    workshop, build = planner.workshop, planner.build
    kind = RasterProposer if geometry == "raster" else ExactProposer
    proposer = kind(workshop, settings, build, Profile())
    view = Landscape.of(build.wall, "right")
    stones = workshop.remaining(build)[::2]
    trials = [StoneTrial((p,), view) for i in stones for p in workshop.poses(i)]
    found = [p for batch in proposer.proposals(trials, one_by_one) for p in batch]
    assert {p.stone_id for p in found} <= set(stones)
    assert len(found) > 2
    for proposal in found:
        placement = proposal.stabilised.placement
        assert proposal.side == "right"
        assert not build.wall.occupied[placement.window][placement.posed.mask].any()
        after = build.wall.add(placement, proposal.stabilised.wedges)
        assert np.count_nonzero(after.occupied) > np.count_nonzero(build.wall.occupied)


def test_without_craft_there_is_no_cost():
    for geometry, kind in (("raster", RasterProposer), ("exact", ExactProposer)):
        settings = PlannerSettings().updated({"geometry": geometry})
        planner = Planner(rubble(), RUBBLE_SITE, settings=settings)
        proposer = kind(planner.workshop, settings, planner.build, Profile())
        view = Landscape.of(planner.build.wall)
        trials = [StoneTrial(planner.workshop.poses(i), view) for i in (1, 2, 3)]
        (found,) = proposer.proposals(trials, one_by_one)
        assert [(p.stone_id, p.cost) for p in found] == [(1, 0.0), (2, 0.0), (3, 0.0)]
