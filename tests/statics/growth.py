"""Walls that grow stone by stone, for tests of the incremental analysis."""

import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.kernels import simplex
from drystone.statics.incremental import LOCAL, SIMPLEX, incremental_analysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.highs import WARM
from drystone.statics.lp.program import Units
from drystone.statics.model import GROUND, RigidBlockModel

PX = Units(15.0, 225.0)

ANALYSES = ["simplex", "local", "highs"]
"""What the incremental analysis falls through, from the top, the middle, and the bottom."""

SOLVERS = {"simplex": {SIMPLEX}, "local": {SIMPLEX, LOCAL, WARM}, "highs": {WARM}}
"""Who answers about walls that stand."""


def beginning(name, monkeypatch):
    """What begins a wall that is analysed by one of the analyses."""
    if name == "highs":
        monkeypatch.setattr(simplex, "AVAILABLE", False)
        return incremental_analysis
    if not simplex.AVAILABLE:
        pytest.skip("the simplex kernel is not compiled here")
    if name == "local":
        return lambda model, units: incremental_analysis(model, units, most=1)
    return incremental_analysis


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


def wall_and_candidates(labels, count, begin=incremental_analysis):
    """The analysis of the lowest blocks, and models with each of the others that stand on them."""
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    for block in blocks[:count]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def assert_same(result, model, solvers):
    """As the ordinary analysis says, certified, and found from what was known of the wall."""
    expected = lateral_resistance(model)
    assert not result.solved_cold
    for direction in ("left", "right"):
        found = getattr(result.resistance, direction)
        sought = getattr(expected, direction)
        assert found.direction == direction
        assert (found.status, found.message) == (sought.status, sought.message)
        assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
        assert found.certificate.holds
        assert found.solver in solvers
    assert result.resistance.mu == model.mu


def bits(result):
    both = result.resistance.left, result.resistance.right
    return [(r.status, r.alpha, r.certificate, r.solver) for r in both]
