"""Forces and mechanisms of the whole wall from what changes near a stone."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.kernels.cones import figures
from drystone.kernels.simplex import Added, Cones
from drystone.statics.incremental import LOCAL, LocalAnalysis, certified_bound
from drystone.statics.limit import lateral_resistance
from drystone.statics.local_update import local_update
from drystone.statics.model import Addition, Block, Interface, RigidBlockModel
from drystone.statics.result import LimitStatus
from tests.kernels.simplex_walls import needs_kernel
from tests.statics.growth import PX, wall_at_once, with_block
from tests.statics.walls import coursed, irregular, stacked

pytestmark = needs_kernel


def both(analysis):
    return (analysis.greatest, analysis.least), (analysis.least, analysis.greatest)


def first_of(labels, count=1):
    """The model of a wall, that of its first blocks alone, and what is known of these."""
    model = model_from_labels(labels).model
    first = RigidBlockModel(model.blocks[:count], model.interfaces[:count], model.mu)
    return model, first, LocalAnalysis.of(first, PX)


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


def test_a_stone_that_nothing_holds_falls_alone():
    """Its centroid is far beyond the edge of what it lies on, or it touches nothing."""
    model, first, analysis = first_of(stacked((30, 15, 0), (30, 15, 0)))
    stone = replace(model.blocks[1], centroid=(-40.0, 22.5))
    added = analysis.program.columns_of(Addition(first, (stone,), model.interfaces[1:]), model.mu)
    none = np.empty(0, np.int32)
    in_the_air = Added(added.weights, Cones(none, none, np.empty((6, 0))), added.closed)
    for falling in (added, in_the_air):
        for end, opposite in both(analysis):
            guess = local_update(analysis.program, end, opposite, falling)
            assert np.isnan(guess.alpha)
            assert not guess.velocity[:3].any()
            assert bound(analysis, falling, guess).fall.holds


def slender_stone():
    """A stone five times as high as wide on a stone of the middle of the wall."""
    whole = model_from_labels(coursed(1, 3, 160)).model
    middle = [block for block in whole.blocks if 60 < block.centroid[0] < 100]
    under = max(middle, key=lambda block: block.centroid[1])
    (x, _), top = (
        under.centroid,
        max(
            float(i.points[:, 1].max()) for i in whole.interfaces if under.id in (i.block, i.other)
        ),
    )
    ends = np.array([[x - 3.0, top], [x + 3.0, top]])
    stone = Block(999, 180.0, (x, top + 15.0))
    analysis = LocalAnalysis.of(whole, PX)
    model = analysis.model.with_added((stone,), (Interface(999, under.id, ends, (0.0, 1.0)),))
    return analysis, analysis.program.columns_of(model.added, model.mu), model


def test_forces_far_from_a_stone_that_decides_alone_are_mixed_too():
    analysis, added, model = slender_stone()
    for end, opposite in both(analysis):
        assert abs(end.alpha) > 0.3
        guess = local_update(analysis.program, end, opposite, added)
        assert guess.alpha == pytest.approx(end.sign * 0.2)
        assert bound(analysis, added, guess).fall is None
    assert lateral_resistance(model).right.alpha == pytest.approx(0.2)


def test_a_wall_that_stands_at_one_alpha_only_has_nothing_to_mix():
    analysis, added, _ = slender_stone()
    for end, _ in both(analysis):
        same = end._replace(sign=-end.sign)
        assert local_update(analysis.program, end, same, added) is None


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


def test_a_stone_that_changes_the_mechanism_has_one_near_it():
    """A pile of two blocks of which the upper one makes the lower one topple earlier."""
    model, _, analysis = first_of(stacked((10, 30, 0), (10, 10, 0)))
    whole = with_block(analysis.model, model.blocks[1], whole=model)
    added = analysis.program.columns_of(whole.added, model.mu)
    for end, opposite in both(analysis):
        guess = local_update(analysis.program, end, opposite, added)
        assert guess.alpha == pytest.approx(end.sign / 4)
        assert bound(analysis, added, guess).alpha == guess.alpha


def test_a_stone_that_raises_alpha_is_for_others():
    """A slender block that a flat one beside it props."""
    labels = np.zeros((40, 60), np.uint32)
    labels[:, 20:30], labels[30:, 30:60] = 1, 2
    model, _, analysis = first_of(labels)
    whole = with_block(analysis.model, model.blocks[1], whole=model)
    added = analysis.program.columns_of(whole.added, model.mu)
    assert local_update(analysis.program, *both(analysis)[0], added) is None
    assert analysis.resistance_with(whole).resistance.right.alpha > 1 / 4 + 1e-3


def test_a_wall_near_a_stone_may_fall_with_it():
    """A stone beyond the edge of a slab that a pier carries: both turn, whatever the load."""
    model, _, analysis = first_of(stacked((10, 10, 20), (60, 10, 0), (10, 20, 50)), 2)
    whole = with_block(analysis.model, model.blocks[2], whole=model)
    found = analysis.resistance_with(whole).resistance
    assert {found.left.status, found.right.status} == {LimitStatus.UNSTABLE}
    assert found.right.solver == LOCAL


def test_a_stone_that_goes_along_leaves_alpha_as_it_is():
    """The lower block slides; the upper one, on a rougher joint, slides with it."""
    model, first, analysis = first_of(stacked((60, 20, 0), (40, 10, 10)))
    rough = tuple(replace(i, mu=0.8) for i in model.interfaces[1:])
    added = analysis.program.columns_of(Addition(first, model.blocks[1:], rough), model.mu)
    for end, opposite in both(analysis):
        guess = local_update(analysis.program, end, opposite, added)
        assert guess.alpha == end.alpha == pytest.approx(end.sign * 0.58)
        assert guess.velocity[3:] == pytest.approx(end.velocity)
        assert bound(analysis, added, guess).alpha == end.alpha


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
