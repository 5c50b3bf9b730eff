"""Walls of many stones: what a stone changes near it is enough for most answers."""

import numpy as np
import pytest

from drystone.statics import growing_large
from drystone.statics.growing_large import NAME, LargeGrowth
from drystone.statics.limit import lateral_resistance
from drystone.statics.solvers.warm import WarmSession
from tests.statics.growth import PX, assert_same, bits, empty, upwards, with_block
from tests.statics.test_neighbourhood import wall_of
from tests.statics.walls import coursed, irregular


@pytest.mark.parametrize("labels", [coursed(1, 7, 150), irregular(4, 50, 150, 110)])
def test_most_answers_need_no_look_at_the_whole_wall(labels, monkeypatch):
    asked = []
    honest = WarmSession.minimise

    def counted(session, costs):
        asked.append(costs[0])
        return honest(session, costs)

    analysis, candidates = wall_of(labels, 40)
    assert isinstance(analysis, LargeGrowth)
    monkeypatch.setattr(WarmSession, "minimise", counted)
    near = 0
    for model in candidates:
        before = len(asked)
        grown = analysis.resistance_with(model)
        solvers = [grown.resistance.left.solver, grown.resistance.right.solver]
        if solvers == [NAME, NAME]:
            near += len(asked) == before
    assert near > len(candidates) / 3


def test_a_stone_that_floats_is_known_to_fall_at_once():
    analysis, _ = wall_of(coursed(1, 7, 150), 40)
    _, blocks = upwards(coursed(1, 7, 150))
    model = analysis.model.with_added((blocks[-1],), ())
    grown = analysis.resistance_with(model)
    assert not lateral_resistance(model).stable
    assert_same(grown, model, {NAME})
    # HiGHS goes on with a wall that fell.
    fallen = analysis.extended(model)
    assert bits(fallen.grown) == bits(grown)
    assert not isinstance(fallen, LargeGrowth)


def test_a_stone_on_the_ground_needs_nothing_below_it():
    whole, blocks = upwards(coursed(1, 7, 150))
    analysis = growing_large.begun(with_block(empty(), blocks[0], whole=whole), PX)
    model = with_block(analysis.model, blocks[1], whole=whole)
    grown = analysis.resistance_with(model)
    assert grown.resistance.right.solver == NAME
    assert_same(grown, model, {NAME, "HiGHS warm simplex"})


def test_what_is_built_is_the_same_for_both():
    """The program of the kernel and that of HiGHS, whatever was added."""
    analysis, candidates = wall_of(coursed(6, 4, 80), 9)
    for closed, candidate in zip(((), (3,), (0, 5)), candidates, strict=False):
        ids = {block.id for block in analysis.model.blocks}
        new = tuple(
            i
            for i in candidate.added.interfaces
            if {i.block, i.other} <= {0, *ids, candidate.blocks[-1].id}
        )
        model = analysis.model.with_added(candidate.added.blocks, new, closed)
        analysis = analysis.extended(model)
        if not isinstance(analysis, LargeGrowth):
            break
        program = analysis.warm.open_program.program
        assert len(analysis.program.cones.first) + 1 == program.column_count
        assert np.array_equal(analysis.program.weights, program.rhs[1::3])
        assert analysis.model is analysis.warm.model
        assert analysis.greatest.alpha == pytest.approx(analysis.grown.resistance.right.alpha)
