"""What HiGHS says is believed where it is proved; many blocks at once."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.statics import growing_highs, growing_large
from drystone.statics.appending import units_of
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Interface, RigidBlockModel
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.refined import RefinedSession
from drystone.statics.solvers.warm import NAME as WARM
from tests.statics.growth import PX, Pivots, assert_same, implementation, wall_and_candidates
from tests.statics.walls import coursed, stacked


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


@pytest.mark.parametrize("name", ["large", "highs"])
def test_an_answer_without_a_certificate_is_found_again_from_its_basis(name, monkeypatch):
    """Once, and without a pivot."""
    begin = implementation(name, monkeypatch)
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8, begin)
    expected = analysis.resistance_with(candidates[0])
    pivots = Pivots(monkeypatch)
    honest, counts = RefinedSession.minimise, []

    def drifts(session, costs):
        before = pivots.count
        solution = honest(session, costs)
        counts.append(pivots.count - before)
        first = len(counts) % 2
        return replace(solution, columns=solution.columns * (1 + 1e-6)) if first else solution

    monkeypatch.setattr(growing_large, "guessed", lambda *_: None)
    monkeypatch.setattr(RefinedSession, "minimise", drifts)
    grown = analysis.resistance_with(candidates[0])
    assert not grown.solved_cold
    assert len(counts) == 4
    assert counts[1] == counts[3] == 0 < counts[0] + counts[2]
    for side in ("left", "right"):
        found, sought = (getattr(g.resistance, side) for g in (grown, expected))
        assert found.certificate.holds
        assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)


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


@pytest.mark.parametrize("sign", [1, -1])
def test_one_end_alone_is_found_from_its_own_basis(sign, monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(3, 5, 90), 14, growing_highs.begun)
    pivots = Pivots(monkeypatch)
    same = growing_highs.end(*analysis.prepared(analysis.model.with_added((), ())), sign)
    assert (pivots.count, pivots.calls) == (0, 1)
    side = "right" if sign > 0 else "left"
    known = getattr(analysis.grown.resistance, side)
    assert sign * same.alpha == pytest.approx(known.alpha, abs=1e-12)
    compared = 0
    for model in candidates:
        end = growing_highs.end(*analysis.prepared(model), sign)
        expected = lateral_resistance(model)
        assert end.certificate.holds
        if expected.stable:
            assert end.falls is None
            sought = getattr(expected, side)
            assert sign * end.alpha == pytest.approx(sought.alpha, abs=1e-9)
            compared += 1
    assert compared > 3


def test_an_end_beyond_0_is_a_fall():
    """The upper block lies over the edge by more than half: it needs a push to the left."""
    model = model_from_labels(stacked((20, 20, 0), (20, 20, 12)), 0.9).model
    first = RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu)
    analysis = growing_highs.begun(first, PX)
    over = analysis.model.with_added(model.blocks[1:], model.interfaces[1:])
    greatest = growing_highs.end(*analysis.prepared(over), 1)
    assert greatest.alpha == pytest.approx(-0.2)
    assert greatest.falls.holds
    assert greatest.falls.fall_work > 0
    least = growing_highs.end(*analysis.prepared(over), -1)
    assert least.falls is None


def test_no_end_is_none():
    """Between pins of the ground alpha has no end."""
    floor = model_from_labels(stacked((20, 20, 0))).model
    analysis = growing_highs.begun(RigidBlockModel((), (), 0.58), PX)
    pins = [
        Interface(1, 0, np.array([[x, 10.0]]), (side, 0.0)) for x, side in ((0, 1.0), (20, -1.0))
    ]
    pinned = analysis.model.with_added(floor.blocks, (*floor.interfaces, *pins))
    assert growing_highs.end(*analysis.prepared(pinned), 1) is None
