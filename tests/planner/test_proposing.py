"""Proposals on pixels, and what both proposers promise."""

import numpy as np
import pytest

from drystone.model.landscape import Landscape
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.proposing import RasterProposer, Trial, one_by_one
from drystone.planner.settings import PlannerSettings
from drystone.planner.settling import ExactProposer
from tests.planner.scenes import RUBBLE_SITE, greedy, rubble


def test_a_trial_is_known_by_its_first_pose_and_side() -> None:
    workshop = Planner(rubble(), RUBBLE_SITE, settings=greedy()).workshop
    poses = workshop.poses(3)
    planner = Planner(rubble(), RUBBLE_SITE)
    view = Landscape.of(planner.build.wall, "right")
    assert Trial(poses, view, None).key == (3, poses[0].angle_deg, "right")


def test_one_by_one_keeps_the_order() -> None:
    assert one_by_one(lambda x: -x, [3, 1, 2]) == [-3, -1, -2]


def test_on_pixels_all_proposals_come_at_once_and_none_is_made_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    settings = greedy({"geometry": "raster"})
    planner = Planner(rubble(), RUBBLE_SITE, settings=settings)
    next(step for step in planner.steps() if step.number == 2)
    workshop, build = planner.workshop, planner.build
    asked = []
    propose = RasterProposer.propose

    def watched(this: RasterProposer, trial: Trial) -> object:
        asked.append(trial.key)
        return propose(this, trial)

    monkeypatch.setattr(RasterProposer, "propose", watched)
    proposer = RasterProposer(workshop, settings, build, Profile())
    rest, view = workshop.rest(build), Landscape.of(build.wall)
    trials = [
        Trial((posed,), view, rest)
        for stone_id in workshop.remaining(build)
        for posed in workshop.poses(stone_id)
    ]
    (some,) = proposer.proposals(trials[4:8], one_by_one)
    (found,) = proposer.proposals(trials, one_by_one)
    assert sorted(asked) == sorted(trial.key for trial in trials)
    assert proposer.tried == len(trials)
    keys = [(p.stone_id, p.trial_angle_deg) for p in found]
    assert keys == [trial.key[:2] for trial in trials if trial.key[:2] in set(keys)]
    assert len(keys) > 4
    assert set(some) <= set(found)


@pytest.mark.parametrize("geometry", ["raster", "exact"])
@pytest.mark.parametrize("rule", ["score", "algorithm2"])
def test_what_is_proposed_is_of_the_trials_and_none_of_it_is_in_the_way(
    geometry: str, rule: str
) -> None:
    settings = greedy({"geometry": geometry, "selection_rule": rule})
    planner = Planner(rubble(2), RUBBLE_SITE, settings=settings)
    next(step for step in planner.steps() if step.number == 2)
    workshop, build = planner.workshop, planner.build
    kind = RasterProposer if geometry == "raster" else ExactProposer
    proposer = kind(workshop, settings, build, Profile())
    rest, view = workshop.rest(build), Landscape.of(build.wall, "right")
    stones = workshop.remaining(build)[::2]
    trials = [Trial((p,), view, rest) for i in stones for p in workshop.poses(i)]
    found = [p for batch in proposer.proposals(trials, one_by_one) for p in batch]
    assert {p.stone_id for p in found} <= set(stones)
    assert len(found) > 2
    for proposal in found:
        placement = proposal.stabilised.placement
        assert proposal.side == "right"
        assert not build.wall.occupied[placement.window][placement.posed.mask].any()
        after = build.wall.add(placement, proposal.stabilised.wedges)
        assert np.count_nonzero(after.occupied) > np.count_nonzero(build.wall.occupied)


def test_without_craft_there_is_no_cost() -> None:
    for geometry, kind in (("raster", RasterProposer), ("exact", ExactProposer)):
        settings = PlannerSettings().updated({"geometry": geometry})
        planner = Planner(rubble(), RUBBLE_SITE, settings=settings)
        proposer = kind(planner.workshop, settings, planner.build, Profile())
        view = Landscape.of(planner.build.wall)
        trials = [Trial(planner.workshop.poses(i), view, None) for i in (1, 2, 3)]
        (found,) = proposer.proposals(trials, one_by_one)
        assert [(p.stone_id, p.cost) for p in found] == [(1, 0.0), (2, 0.0), (3, 0.0)]
