"""What HiGHS says is believed where it is proved; many blocks at once."""

from dataclasses import replace

import pytest

from drystone.statics import growing_highs, growing_large
from drystone.statics.appending import units_of
from drystone.statics.limit import lateral_resistance
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.refined import RefinedSession
from drystone.statics.solvers.warm import NAME as WARM
from tests.statics.growth import Pivots, assert_same, implementation, wall_and_candidates
from tests.statics.walls import coursed


@pytest.mark.parametrize("name", ["large", "highs"])
def test_answers_of_highs_without_a_certificate_are_found_again_cold(name, monkeypatch):
    begin = implementation(name, monkeypatch)
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8, begin)
    honest = RefinedSession.minimise

    def wrong(session, costs):
        solution = honest(session, costs)
        if costs[0] > 0 and solution.columns is not None:  # the left tilt only
            return replace(solution, columns=solution.columns * (1 + 1e-6))
        return solution

    monkeypatch.setattr(growing_large, "guessed", lambda *_: None)
    assert not analysis.resistance_with(candidates[0]).solved_cold
    monkeypatch.setattr(RefinedSession, "minimise", wrong)
    grown = analysis.resistance_with(candidates[0])
    expected = lateral_resistance(candidates[0])
    assert grown.solved_cold
    assert grown.resistance.left.alpha == expected.left.alpha
    assert grown.resistance.left.solver == expected.left.solver != WARM
    assert analysis.extended(candidates[0]).grown.solved_cold


def test_many_blocks_at_once_begin_with_an_interior_point(monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(3, 5, 90), 14)
    asked = []

    def counted(program, algorithm):
        asked.append(algorithm)
        return HighsSession(program, algorithm)

    pivots = Pivots(monkeypatch)
    monkeypatch.setattr(growing_highs, "MANY_BLOCKS_AT_ONCE", 14)
    monkeypatch.setattr(growing_highs, "HighsSession", counted)
    at_once = growing_highs.begun(analysis.model, units_of(analysis.model))
    assert asked == ["ipm"]
    assert pivots.count == 0
    assert_same(at_once.grown, analysis.model, {WARM})
    for model in candidates:
        assert_same(at_once.resistance_with(model), model, {WARM})
