"""One step: nothing is evaluated twice, and the surest place is taken."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from drystone.model.landscape import Landscape
from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.model.wall import Group
from drystone.planner.attempt import SHORTLISTS, Attempt
from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.profile import Profile
from drystone.planner.proposing import RasterProposer
from drystone.planner.settings import PlannerSettings
from tests.planner.scenes import blocks, greedy, of_rubble


def _attempt(settings):
    planner = of_rubble(settings, 2)
    return Attempt(planner.workshop, settings, planner.build)


@pytest.mark.parametrize(
    "settings",
    [
        PlannerSettings(sampling="twofold", two_sided=True),
        PlannerSettings(sampling="uniform", orientations="quarter"),
        greedy({"geometry": "raster"}),
    ],
    ids=["two-fold", "quarter", "best"],
)
def test_nothing_is_evaluated_twice(settings, monkeypatch):
    attempt = _attempt(settings)
    proposed, judged = Counter(), Counter()
    spotted, judge = RasterProposer.spotted, Evaluator.judge

    def spotted_once(this, trial):
        posed = trial.poses[0]
        proposed[posed.stone.id, posed.angle_deg, trial.landscape.side] += 1
        return spotted(this, trial)

    def judge_once(this, wall, analysis, proposal):
        judged[proposal.stone_id, proposal.trial_angle_deg, proposal.side] += 1
        return judge(this, wall, analysis, proposal)

    monkeypatch.setattr(RasterProposer, "spotted", spotted_once)
    monkeypatch.setattr(Evaluator, "judge", judge_once)
    chosen = [attempt.choose(np.random.default_rng(seed)) for seed in range(4)]
    assert set(proposed.values()) == {1}
    assert set(judged.values()) == {1}
    assert attempt.candidates == len(proposed)
    # What was tried before does not shape the choice.
    for seed, one in enumerate(chosen):
        fresh = _attempt(settings).choose(np.random.default_rng(seed))
        assert (one.stone_id, one.side, one.indices) == (fresh.stone_id, fresh.side, fresh.indices)
        assert one.course_height_px == fresh.course_height_px


def test_the_height_of_a_course_is_the_mean_of_other_stones():
    # Eq. 8: the first stone is compared with the mean height of the other candidates.
    stones = blocks({1: (20, 10), 2: (20, 10), 3: (20, 4)})
    settings = PlannerSettings(sampling="full", orientations="sf")
    planner = Planner(stones, Site(60, 20), settings=settings)
    attempt = Attempt(planner.workshop, settings, planner.build)
    chosen = attempt.choose(np.random.default_rng(0))
    assert chosen.stone_id == 1
    assert chosen.proposal.course_height_px == 7.0
    assert chosen.course_height_px == 7.0
    assert chosen.indices.NHR == pytest.approx(0.3)


def test_orientations_are_candidates_or_the_rule_picks_one():
    stones = blocks({1: (20, 10), 2: (16, 8)})
    for choice, tried in (("candidates", 4), ("placement", 2)):
        settings = PlannerSettings(sampling="full", orientations="quarter").updated(
            {"orientation_choice": choice}
        )
        planner = Planner(stones, Site(60, 30), settings=settings)
        attempt = Attempt(planner.workshop, settings, planner.build)
        attempt.choose(np.random.default_rng(0))
        assert attempt.candidates == tried


@pytest.mark.parametrize(("clearance_px", "proposed"), [(0, True), (1, True), (2, False)])
def test_a_stone_that_turns_keeps_its_clearance(clearance_px, proposed):
    """From where it is stabilised it moves into a slot with one px to spare on both sides."""
    placing = {"reach": "above", "clearance_px": clearance_px}
    settings = greedy({"geometry": "raster", "placement": placing})
    planner = Planner(blocks({1: (20, 10), 2: (20, 10)}), Site(60, 40), settings=settings)
    proposer = RasterProposer(planner.workshop, settings, planner.build, Profile())
    posed = planner.workshop.poses(1)[0]
    assert posed.mask.shape == (10, 20)
    slot = np.zeros((40, 60), bool)
    slot[10:, :19] = slot[10:, 41:] = True
    turned = Group(Placement(posed, 30, 20, "left", 1))
    assert proposer._reached(Landscape(slot, ()), turned) is proposed


BRICKS = {k: (9 + k, 12) for k in range(1, 13)}


class _Falling:
    """Trials in which all stones fall as often as they are told to."""

    def __init__(self, falls):
        self.falls_of, self.asked = falls, []

    def falls(self, group, _, least):
        stone = group.placement.stone_id
        self.asked.append(stone)
        share = self.falls_of.get(stone, 0.5)
        return share if share < least else None


def _chosen(falls):
    """Choose a first brick of which some are sure; also return the stones in order of cost."""
    alone = {"shortlist": 1, "per_stone": 1, "spots": 1}
    settings = greedy({"settle": alone, "two_sided": False, "orientations": "sf"})
    planner = Planner(blocks(BRICKS), Site(60, 40), settings=settings)
    seats = _Falling(falls)
    workshop = replace(planner.workshop, seats=seats)
    found = Attempt(workshop, settings, planner.build).choose(np.random.default_rng(0))
    return found.stone_id, seats.asked


def test_the_surest_place_of_the_first_shortlists_is_taken():
    first, asked = _chosen({})
    assert first == asked[0]
    assert len(asked) == SHORTLISTS
    # A place that is sure is taken where it comes.
    for stone in asked[1], asked[-1]:
        assert _chosen({stone: 0.0})[0] == stone
    # Where none is, the one that falls least; what comes later is not asked for.
    assert _chosen({asked[3]: 0.2, asked[5]: 0.3})[0] == asked[3]
    later = next(stone for stone in BRICKS if stone not in asked)
    assert _chosen({later: 0.0}) == (first, asked)
    # Where a place is sure at once, no trial of another counts.
    assert _chosen({asked[0]: 0.0})[1] == asked[:1]
