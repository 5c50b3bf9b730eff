"""Walls that grow stone by stone, for tests of the growing analysis."""

from collections.abc import Callable

import pytest

from drystone.kernels import certificate, cones, simplex
from drystone.kernels.backend import compiled
from drystone.statics import growing_highs, growing_large, growing_simplex
from drystone.statics.appending import Units
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.growing import growing
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, RigidBlockModel
from drystone.statics.solvers import warm

PX = Units(15.0, 225.0)

IMPLEMENTATIONS = ["compiled", "numpy", "large", "highs"]
"""The simplex kernel twice, walls of many stones, and HiGHS."""

SOLVERS = {
    "compiled": {growing_simplex.NAME},
    "numpy": {growing_simplex.NAME},
    "large": {growing_simplex.NAME, growing_large.NAME, warm.NAME},
    "highs": {warm.NAME},
}
"""Who answers about walls that stand."""

Begin = Callable[[RigidBlockModel, Units], growing_simplex.GrowingAnalysis]


def implementation(name: str, monkeypatch: pytest.MonkeyPatch) -> Begin:
    """What begins a wall that is analysed by one of the implementations."""
    if name == "highs":
        return growing_highs.begun
    if name == "compiled" and compiled("simplex") is None:
        pytest.skip("kernels are not compiled here")
    if name == "numpy":
        for module in (simplex, certificate, cones):
            monkeypatch.setattr(module, "_fast", None)
    if name == "large":
        return lambda model, units: growing_simplex.begun(model, units, most=1)
    return growing


def empty(mu=0.58):
    return RigidBlockModel((), (), mu)


def with_block(built, *blocks, whole):
    """The model with more blocks of a whole wall: a stone, or a stone and its wedge."""
    new = {block.id for block in blocks}
    there = {GROUND, *new, *(b.id for b in built.blocks)}
    touching = [i for i in whole.interfaces if new & {i.block, i.other}]
    return built.with_added(blocks, tuple(i for i in touching if {i.block, i.other} <= there))


def upwards(labels):
    whole = model_from_labels(labels).model
    return whole, sorted(whole.blocks, key=lambda block: block.centroid[1])


def wall_and_candidates(labels, count, begin=growing):
    """The analysis of the lowest blocks, and models with each of the others that stand on them."""
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    for block in blocks[:count]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def assert_same(grown, model, solvers):
    """As the ordinary analysis says, certified, and found from what was known of the wall."""
    expected = lateral_resistance(model)
    assert not grown.solved_cold
    for direction in ("left", "right"):
        found = getattr(grown.resistance, direction)
        sought = getattr(expected, direction)
        assert found.direction == direction
        assert (found.status, found.message) == (sought.status, sought.message)
        assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
        assert found.certificate.holds
        assert found.solver in solvers
    assert grown.resistance.mu == model.mu


def bits(grown):
    both = grown.resistance.left, grown.resistance.right
    return [(r.status, r.alpha, r.certificate, r.solver) for r in both]


class Pivots:
    """Counts the calls of all sessions, and the pivots of their last runs."""

    def __init__(self, monkeypatch):
        self.count = self.calls = 0
        minimise = warm.WarmSession.minimise

        def counted(session, costs):
            solution = minimise(session, costs)
            self.calls += 1
            self.count += session.highs.getInfo().simplex_iteration_count
            return solution

        monkeypatch.setattr(warm.WarmSession, "minimise", counted)

    def of(self, work):
        before = self.count
        work()
        return self.count - before
