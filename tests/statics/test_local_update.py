"""Forces and mechanisms of the whole wall from what changes near a stone."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.kernels.cones import figures
from drystone.kernels.simplex import Cones
from drystone.statics.incremental import LOCAL, LocalAnalysis, certified_bound
from drystone.statics.limit import lateral_resistance
from drystone.statics.local_update import local_update
from drystone.statics.lp.highs import WARM
from drystone.statics.model import Addition, RigidBlockModel
from tests.kernels.simplex_walls import needs_kernel
from tests.statics.growth import PX, upwards, with_block
from tests.statics.walls import coursed, irregular, stacked

pytestmark = needs_kernel


def both(analysis):
    return (analysis.greatest, analysis.least), (analysis.least, analysis.greatest)


def wall_at_once(labels, count):
    """A wall of the lowest blocks that is given at once, and models with one more block."""
    whole, blocks = upwards(labels)
    there = {0, *(block.id for block in blocks[:count])}
    interfaces = tuple(i for i in whole.interfaces if {i.block, i.other} <= there)
    analysis = LocalAnalysis.of(RigidBlockModel(tuple(blocks[:count]), interfaces, whole.mu), PX)
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def bound(analysis, added, guess):
    found = figures(
        analysis.program.cones, analysis.program.weights, added,
        guess.alpha, guess.forces, guess.velocity,
    )  # fmt: skip
    return certified_bound(found, guess.alpha, guess.sign, "")


@pytest.mark.parametrize("labels", [coursed(1, 7, 150), irregular(4, 50, 150, 110)])
def test_guesses_are_proved_and_most_stones_have_one(labels):
    analysis, candidates = wall_at_once(labels, 40)
    proved = 0
    for model in candidates:
        expected = lateral_resistance(model)
        added = analysis.program.columns_of(model.added, model.mu)
        for (end, opposite), sought in zip(
            both(analysis), (expected.right, expected.left), strict=True
        ):
            guess = local_update(analysis.program, end, opposite, added)
            found = None if guess is None else bound(analysis, added, guess)
            if found is None:
                continue
            proved += 1
            assert guess.sign == end.sign
            if found.fall is not None:
                assert not expected.stable
            elif expected.stable:
                assert end.sign * found.alpha == pytest.approx(sought.alpha, abs=1e-9)
    assert proved > len(candidates)  # of two for each


PROPPED = np.zeros((40, 60), np.uint32)
PROPPED[:, 20:30], PROPPED[30:, 30:60] = 1, 2


@pytest.mark.parametrize(
    ("labels", "alphas", "solver"),
    [
        (stacked((10, 30, 0), (10, 10, 0)), (0.25, 0.25), LOCAL),  # the lower one topples earlier
        (stacked((60, 20, 0), (40, 10, 10)), (0.58, 0.58), LOCAL),  # it goes along
        (stacked((60, 20, 0), (6, 30, 27)), (0.2, 0.2), LOCAL),  # it decides alone
        (stacked((30, 15, 0), (30, 15, 29)), None, LOCAL),  # it falls alone
        (np.array([[2], [0], [1]], np.uint32), None, LOCAL),  # in the air
        (stacked((10, 10, 20), (60, 10, 0), (10, 20, 50)), None, LOCAL),  # with a slab on a pier
        (PROPPED, (61 / 156, 26 / 49), WARM),  # a slender block: more than its 1 / 4
    ],
)
def test_who_knows_what_a_stone_changes(labels, alphas, solver):
    """The joint of the stone is rougher than the others."""
    model = model_from_labels(labels).model
    *blocks, stone = model.blocks
    old = tuple(i for i in model.interfaces if stone.id not in (i.block, i.other))
    new = tuple(replace(i, mu=0.8) for i in model.interfaces if stone.id in (i.block, i.other))
    analysis = LocalAnalysis.of(RigidBlockModel(tuple(blocks), old, model.mu), PX)
    found = analysis.resistance_with(analysis.model.with_added((stone,), new)).resistance
    assert found.stable == (alphas is not None)
    assert (found.left.alpha, found.right.alpha) == pytest.approx(alphas or (None, None))
    assert found.left.solver == found.right.solver == solver


def test_contacts_that_closed_carry_nothing():
    """Such as would carry some of the stone, and nothing without it."""
    analysis, candidates = wall_at_once(coursed(1, 7, 150), 40)
    program, guesses, proved = analysis.program, 0, 0
    for model in candidates:
        stone = model.added
        for end, opposite in both(analysis):
            guess = local_update(program, end, opposite, program.columns_of(stone, model.mu))
            if guess is None or guess.alpha != end.alpha:
                continue
            loaded = (guess.forces[: len(end.forces)] > 0) & (end.forces == 0)
            for gone in np.unique(program.interfaces[loaded]).tolist():
                if end.forces[program.interfaces == gone].any():
                    continue
                closed = Addition(analysis.model, stone.blocks, stone.interfaces, (gone,))
                added = program.columns_of(closed, model.mu)
                without = local_update(program, end, opposite, added)
                guesses += without is not None
                proved += without is not None and bound(analysis, added, without) is not None
    assert proved == guesses > 5


def test_columns_may_begin_at_either_body():
    """Ids decide which body of an interface comes first; a stone may have a smaller one."""
    analysis, candidates = wall_at_once(coursed(1, 7, 150), 40)
    program, told = analysis.program, 0
    for model in candidates[:4]:
        added = program.columns_of(model.added, model.mu)
        old = added.cones
        swapped = Cones(
            np.where(old.second < 0, old.first, old.second),
            np.where(old.second < 0, old.second, old.first),
            np.ascontiguousarray(
                np.where(old.second < 0, old.entries, np.roll(old.entries, 3, axis=0))
            ),
        )
        for end, opposite in both(analysis):
            one = local_update(program, end, opposite, added)
            two = local_update(program, end, opposite, replace(added, cones=swapped))
            assert (one is None) == (two is None)
            if one is not None:
                told += 1
                assert two.alpha == pytest.approx(one.alpha)
                assert (bound(analysis, added, one) is None) == (
                    bound(analysis, added, two) is None
                )
    assert told > 2
