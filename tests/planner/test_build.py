"""The state of construction, and the analysis that grows with it."""

from itertools import pairwise

import numpy as np
import pytest

from drystone.planner.build import Solves
from drystone.planner.evaluate import Evaluator
from drystone.planner.settings import PlannerSettings
from drystone.search.whole_search import run_to_end
from drystone.statics.incremental import SIMPLEX, HighsAnalysis, IncrementalAnalysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.highs import WARM
from tests.planner.scenes import greedy, of_rubble

SETTINGS = [PlannerSettings(sampling="full", two_sided=True), greedy()]


@pytest.mark.parametrize("settings", SETTINGS, ids=["paper", "best"])
def test_every_candidate_is_as_strong_as_its_model_analysed_whole(settings, monkeypatch):
    judged = []
    judge = Evaluator.judge

    def watched(this, wall, analysis, proposal):
        judged.append(judge(this, wall, analysis, proposal))
        return judged[-1]

    monkeypatch.setattr(Evaluator, "judge", watched)
    planner = of_rubble(settings)
    assert len(judged) > len(planner.build.actions) > 4
    alphas = set()
    for candidate in judged:
        whole = lateral_resistance(candidate.model)
        mine = candidate.resistance
        for found, sought in ((mine.left, whole.left), (mine.right, whole.right)):
            assert found.status is sought.status
            assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
            assert found.certificate.holds
            assert found.solver in {SIMPLEX, WARM}  # from the bases of the wall, not from the start
        assert candidate.solves == Solves()
        alphas.add((mine.left.alpha, mine.right.alpha))
    assert len(alphas) > 5


def test_states_are_kept_only_to_go_back_to_them():
    for rounds in (0, 1):
        settings = greedy({"search": {"budget": rounds + 1}})
        planner, again = of_rubble(settings, 0), of_rubble(settings, 0)
        builds = [planner.build, *(step.build for step in planner.steps())]
        assert planner.build.states() == (tuple(builds) if rounds else (planner.build,))
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
    planner, again = of_rubble(greedy({"search": {"budget": 2}}), 0), of_rubble(greedy(), 0)
    run_to_end(planner)
    again.restore(planner.build.wall, {})
    area = planner.workshop.stock.mean_area_px
    assert units == {(np.sqrt(area), area)}
