"""The state of construction, and the analysis that grows with it."""

from itertools import pairwise

import numpy as np
import pytest

from drystone.planner.evaluate import Evaluator
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings
from drystone.planner.solves import Solves
from drystone.search.whole_search import run_to_end
from drystone.statics.incremental import SIMPLEX, HighsAnalysis, IncrementalAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.highs import WARM
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, rubble

SETTINGS = [PlannerSettings(sampling="full", two_sided=True), greedy()]


def _alphas(resistance):
    return resistance.left.alpha, resistance.right.alpha


@pytest.mark.parametrize("settings", SETTINGS, ids=["paper", "best"])
def test_every_candidate_is_as_strong_as_its_model_analysed_whole(settings, monkeypatch):
    judged = []
    judge = Evaluator.judge

    def watched(this, wall, analysis, proposal):
        judged.append(judge(this, wall, analysis, proposal))
        return judged[-1]

    monkeypatch.setattr(Evaluator, "judge", watched)
    planner = finish(Planner(rubble(), RUBBLE_SITE, settings=settings))
    assert len(judged) > len(planner.build.actions) > 4
    unlike = 0
    for candidate in judged:
        whole = lateral_resistance(candidate.model)
        for found, sought in (
            (candidate.resistance.left, whole.left),
            (candidate.resistance.right, whole.right),
        ):
            assert found.status is sought.status
            assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
            assert found.certificate.holds
            assert found.solver in {SIMPLEX, WARM}  # from the bases of the wall, not from the start
        assert candidate.solves == Solves()
        unlike += _alphas(candidate.resistance) != _alphas(judged[0].resistance)
    assert unlike > 4


@pytest.mark.parametrize("settings", SETTINGS, ids=["paper", "best"])
def test_the_analysis_of_a_state_gives_what_its_last_action_was_judged_by(settings):
    for step in Planner(rubble(seed=1), RUBBLE_SITE, seed=1, settings=settings).steps():
        analysis = step.build.analysis
        assert step.build.model is step.action.model
        assert analysis.model.blocks is step.build.model.blocks
        assert analysis.model.interfaces is step.build.model.interfaces
        assert _alphas(analysis.result.resistance) == _alphas(step.action.resistance)


def test_states_are_kept_only_to_go_back_to_them():
    for rounds in (0, 1):
        settings = greedy({"search": {"budget": rounds + 1}})
        planner = Planner(rubble(), RUBBLE_SITE, settings=settings)
        begun = planner.build
        builds = [begun, *(step.build for step in planner.steps())]
        assert planner.build.states() == (tuple(builds) if rounds else (planner.build,))
        again = Planner(rubble(), RUBBLE_SITE, settings=settings)
        again.restore(planner.build.wall, {})
        states = again.build.states()
        assert len(states) == (len(builds) if rounds else 1)
        for state, build in zip(states, builds[-len(states) :], strict=True):
            assert state.wall.labels.tobytes() == build.wall.labels.tobytes()
        assert all(one is other.before for one, other in pairwise(states))


def test_the_unit_of_weight_is_a_stone_of_the_set(monkeypatch):
    """Certificates must not depend on which stones were placed, as in a resumed plan."""
    units = set()
    resistance_with = IncrementalAnalysis.resistance_with

    def watched(analysis, model):
        of = analysis if isinstance(analysis, HighsAnalysis) else vars(analysis)["program"]
        units.add((of.units.length, of.units.weight))
        return resistance_with(analysis, model)

    monkeypatch.setattr(IncrementalAnalysis, "resistance_with", watched)
    planner = Planner(rubble(), RUBBLE_SITE, settings=greedy({"search": {"budget": 2}}))
    run_to_end(planner)
    again = Planner(rubble(), RUBBLE_SITE, settings=greedy())
    again.restore(planner.build.wall, {})
    area = planner.workshop.stock.mean_area_px
    assert units == {(np.sqrt(area), area)}
