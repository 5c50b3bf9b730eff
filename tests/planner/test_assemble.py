"""Units and areas of a finished plan, against hand-made walls."""

from itertools import count

import numpy as np
import pytest

from drystone.contacts.blocks import model_with
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.site import Site
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Group, Wall
from drystone.planner.assemble import plan_metrics, plan_steps
from drystone.planner.build import Build, Candidate, Proposal, Solves
from drystone.planner.evaluate import action_indices
from drystone.planner.settings import method_settings
from drystone.poses import PoseBook
from drystone.search.plan_wall import plan_wall
from drystone.statics.incremental import IncrementalAnalysis, IncrementalResult
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from tests.planner.scenes import blocks, gave_up, greedy, rubble

SCALE, PX_PER_M = 0.5, 200.0


def wedged_build():
    """A slab of 40 x 8 source px on two wedges of 4 x 2 working px."""
    site = Site.from_source(60, 40, SCALE, PX_PER_M)
    posed = PoseBook(SCALE).pose(Stone(7, np.ones((8, 40), bool)), 0.0)
    row = site.height_px - 2 - posed.height_px
    wedges = tuple(
        Wedge(8 + k, 7, np.ones((2, 4), bool), site.height_px - 2, col)
        for k, col in enumerate((2, 16))
    )
    stabilised = Group(Placement(posed, row, 1), wedges)
    empty = Wall.empty(site)
    model = model_with(RigidBlockModel((), ()), empty.labels, stabilised.placement, wedges)
    resistance = lateral_resistance(model)
    indices, course = action_indices(Landscape.of(empty), stabilised, resistance, None, 4.0)
    proposal = Proposal(stabilised, 0.0)
    action = Candidate(proposal, indices, course, model, resistance)
    return Build.empty(site, model.mu, 80.0).add(action)


def test_the_multipliers_of_a_group_stand_at_its_last_step_only():
    build = wedged_build()
    steps = plan_steps(build, {7: 1})
    assert [step.kind for step in steps] == ["stone", "wedge", "wedge"]
    assert [step.step for step in steps] == [1, 2, 3]
    assert [step.alpha_left is None for step in steps] == [True, True, False]
    assert steps[-1].alpha_right == build.actions[0].resistance.right.alpha
    corners = np.array(steps[1].polygon) * 100  # metres
    assert corners.min(axis=0) == pytest.approx([2.0, 0.0])
    assert corners.max(axis=0) == pytest.approx([6.0, 2.0])


def test_a_plan_says_which_method_made_it():
    stones = blocks({1: (20, 10), 2: (20, 10)})
    assert plan_wall(stones, 40, 10, scale=1.0, method="paper").plan.method == "paper"
    own = method_settings("paper").updated({"sampling": "full"})
    assert plan_wall(stones, 40, 10, scale=1.0, settings=own).plan.method == "custom"
    assert plan_wall(stones, 40, 10, scale=1.0, settings=own, method="paper").plan.method == "paper"


def test_a_wall_in_which_nothing_can_be_placed_is_an_incomplete_plan():
    """A stone on its tip: neither rotation nor wedges allowed."""
    tip = np.triu(np.ones((12, 12), bool))
    result = plan_wall(
        StoneSet((Stone(1, tip),)), 14, 14, scale=1.0,
        settings=method_settings("paper").updated(
            {"orientations": "sf", "stabilise": {"method": "none"}}
        ),
    )  # fmt: skip
    assert result.status == "incomplete"
    assert result.plan.steps == ()
    assert result.metrics.F_LR is None


def test_areas_are_in_square_metres_and_of_the_source():
    build = wedged_build()
    metrics = plan_metrics(build, build.actions[-1].resistance)
    # 16 working px of 2 source px each way, 200 source px in a metre
    assert metrics.wedge_area == pytest.approx(16 * (2 / 200) ** 2)
    assert metrics.F_SF == pytest.approx(40 * 8 / (60 * 40))
    # A stone of 5 x 3 source px is 3 x 2 or 2 x 2 px at half size, never 3.75.
    stones = StoneSet((Stone(1, np.ones((3, 5), bool)),))
    result = plan_wall(stones, 10, 8, method="paper", scale=SCALE)
    assert result.metrics.F_SF == pytest.approx(15 / 80)


@pytest.mark.parametrize("failing", [0, 1])
def test_candidates_on_which_the_solver_gave_up_are_counted_and_said(failing, monkeypatch):
    """Also where it gave up on the sturdy model alone, which is the second."""
    calls, analyse = count(), IncrementalAnalysis.resistance_with

    def fails_once(analysis, model):
        if next(calls) != failing:
            return analyse(analysis, model)
        return IncrementalResult(gave_up(model.mu), solved_cold=True)

    monkeypatch.setattr(IncrementalAnalysis, "resistance_with", fails_once)
    stones = blocks({1: (20, 10), 2: (20, 10), 3: (20, 10)})
    result = plan_wall(stones, 60, 10, scale=1.0, settings=greedy())
    (notice,) = (one for one in result.notices if one.code == "W303")
    assert "gave up on 1 candidates" in notice.message
    assert result.solves == Solves(failed=1, cold=1)


def test_candidates_that_were_solved_again_are_counted_and_change_nothing(monkeypatch):
    plain, again = [], []
    for found in (plain, again):
        for budget in (1, 2):
            settings = greedy({"search": {"budget": budget}})
            found.append(plan_wall(rubble(1, 7), 100, 36, scale=1.0, seed=1, settings=settings))
        monkeypatch.setattr(
            IncrementalAnalysis,
            "resistance_with",
            lambda _, model: IncrementalResult(lateral_resistance(model), solved_cold=True),
        )
    for one, other in zip(plain, again, strict=True):
        assert (one.notices, one.solves) == ((), Solves())
        assert (other.notices, other.solves.failed) == ((), 0)  # it costs time alone
        assert other.wall.labels.tobytes() == one.wall.labels.tobytes()
    # Those of the second wall are counted as well.
    assert again[1].solves.cold > again[0].solves.cold > 20
