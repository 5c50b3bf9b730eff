"""Forces and mechanisms of the whole wall from what changes near a stone."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.certificate import figures
from drystone.kernels.simplex import Added, Cones
from drystone.statics import growing_large, neighbourhood
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.ends import no_alpha, optimum
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Addition, Block, Interface, RigidBlockModel
from drystone.statics.neighbourhood import guessed
from drystone.statics.solvers.standard_form import least
from tests.statics.growth import PX, upwards, wall_and_candidates, with_block
from tests.statics.walls import coursed, irregular, stacked


def large(labels, count):
    return wall_and_candidates(labels, count, growing_large.begun)


def wall_of(labels, count):
    """A wall that stands and is given at once, and models with one more block."""
    whole, blocks = upwards(labels)
    there = {0, *(block.id for block in blocks[:count])}
    interfaces = tuple(i for i in whole.interfaces if {i.block, i.other} <= there)
    analysis = growing_large.begun(RigidBlockModel(tuple(blocks[:count]), interfaces, whole.mu), PX)
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def both(analysis):
    return (analysis.greatest, analysis.least), (analysis.least, analysis.greatest)


def end(analysis, added, guess):
    found = figures(
        analysis.program.cones, analysis.program.weights, added,
        guess.alpha, guess.forces, guess.velocity,
    )  # fmt: skip
    if np.isnan(guess.alpha):
        return no_alpha(found, "")
    return optimum(found, guess.alpha, guess.sign, "")


@pytest.mark.parametrize("labels", [coursed(1, 7, 150), irregular(4, 50, 150, 110)])
def test_guesses_are_proved_and_most_stones_have_one(labels):
    analysis, candidates = wall_of(labels, 40)
    proved = 0
    for model in candidates:
        expected = lateral_resistance(model)
        added = analysis.program.columns_of(model.added, model.mu)
        for (tilt, other), sought in zip(
            both(analysis), (expected.right, expected.left), strict=True
        ):
            guess = guessed(analysis.program, tilt, other, added)
            found = None if guess is None else end(analysis, added, guess)
            if found is None:
                continue
            proved += 1
            assert guess.sign == tilt.sign
            if found.falls is not None:
                assert not expected.stable
            elif expected.stable:
                assert tilt.sign * found.alpha == pytest.approx(sought.alpha, abs=1e-9)
    assert proved > len(candidates)  # of two for each


def test_only_the_strip_below_the_stone_is_changed():
    analysis, candidates = wall_of(coursed(1, 7, 150), 40)
    program, changed = analysis.program, 0
    x = program.centroid_x
    for model in candidates:
        added = program.columns_of(model.added, model.mu)
        for tilt, other in both(analysis):
            guess = guessed(program, tilt, other, added)
            if guess is None or guess.alpha != tilt.alpha:
                continue
            new = np.flatnonzero(guess.forces[: len(tilt.forces)] != tilt.forces)
            touched = {*program.cones.first[new], *program.cones.second[new]} - {-1}
            supports = {*added.cones.first, *added.cones.second} - {-1, len(x)}
            reach = neighbourhood.REACH * PX.length
            assert all(
                min(x[list(supports)]) - reach <= x[k] <= max(x[list(supports)]) + reach
                for k in touched
            )
            assert np.array_equal(guess.velocity[:-3], tilt.velocity)
            changed += len(touched) > 0
    assert changed > 3


def test_a_stone_that_nothing_holds_falls_alone():
    """Its centroid is far beyond the edge of what it lies on, or it touches nothing."""
    model = model_from_labels(stacked((30, 15, 0), (30, 15, 0))).model
    first = RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu)
    analysis = growing_large.begun(first, PX)
    stone = replace(model.blocks[1], centroid=(-40.0, 22.5))
    added = analysis.program.columns_of(Addition(first, (stone,), model.interfaces[1:]), model.mu)
    none = np.empty(0, np.int32)
    in_the_air = Added(added.weights, Cones(none, none, np.empty((6, 0))), added.closed)
    for falling in (added, in_the_air):
        for tilt, other in both(analysis):
            guess = guessed(analysis.program, tilt, other, falling)
            assert np.isnan(guess.alpha)
            assert not guess.velocity[:3].any()
            assert end(analysis, falling, guess).falls.holds


def test_a_slender_stone_on_a_broad_wall_decides_alone():
    """Twice as high as wide: alpha is .5, below that of the block under it, and forces mix."""
    model = model_from_labels(stacked((60, 20, 0), (10, 20, 25))).model
    first = RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu)
    analysis = growing_large.begun(first, PX)
    whole = with_block(analysis.model, model.blocks[1], whole=model)
    added = analysis.program.columns_of(whole.added, model.mu)
    for tilt, other in both(analysis):
        assert abs(tilt.alpha) == pytest.approx(0.58)
        guess = guessed(analysis.program, tilt, other, added)
        assert guess.alpha == pytest.approx(tilt.sign * 0.5)
        assert not guess.velocity[:3].any()
        found = end(analysis, added, guess)
        assert (found.alpha, found.falls) == (guess.alpha, None)


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
    analysis = growing_large.begun(whole, PX)
    model = analysis.model.with_added((stone,), (Interface(999, under.id, ends, (0.0, 1.0)),))
    return analysis, analysis.program.columns_of(model.added, model.mu), model


def test_forces_far_from_a_stone_that_decides_alone_are_mixed_too():
    analysis, added, model = slender_stone()
    for tilt, other in both(analysis):
        assert abs(tilt.alpha) > 0.3
        guess = guessed(analysis.program, tilt, other, added)
        assert guess.alpha == pytest.approx(tilt.sign * 0.2)
        assert end(analysis, added, guess).falls is None
    assert lateral_resistance(model).right.alpha == pytest.approx(0.2)


def test_a_wall_that_stands_at_one_alpha_only_has_nothing_to_mix():
    analysis, added, _ = slender_stone()
    for tilt, _ in both(analysis):
        same = tilt._replace(sign=-tilt.sign)
        assert guessed(analysis.program, tilt, same, added) is None


def test_contacts_that_closed_carry_nothing():
    """Such as would carry some of the stone, and nothing without it."""
    analysis, candidates = wall_of(coursed(1, 7, 150), 40)
    program, guesses, proved = analysis.program, 0, 0
    for model in candidates:
        stone = model.added
        for tilt, other in both(analysis):
            guess = guessed(program, tilt, other, program.columns_of(stone, model.mu))
            if guess is None or guess.alpha != tilt.alpha:
                continue
            loaded = (guess.forces[: len(tilt.forces)] > 0) & (tilt.forces == 0)
            for gone in np.unique(program.interfaces[loaded]).tolist():
                if tilt.forces[program.interfaces == gone].any():
                    continue
                closed = Addition(analysis.model, stone.blocks, stone.interfaces, (gone,))
                added = program.columns_of(closed, model.mu)
                without = guessed(program, tilt, other, added)
                guesses += without is not None
                proved += without is not None and end(analysis, added, without) is not None
    assert proved == guesses > 5


def test_a_stone_that_changes_the_mechanism_is_for_others(monkeypatch):
    """A pile of two blocks of which the upper one makes the lower one topple earlier."""
    asked = []
    monkeypatch.setattr(neighbourhood, "least", lambda *args: asked.append(0) or least(*args))
    model = model_from_labels(stacked((10, 30, 0), (10, 10, 0))).model
    analysis = growing_large.begun(
        RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu), PX
    )
    whole = with_block(analysis.model, model.blocks[1], whole=model)
    added = analysis.program.columns_of(whole.added, model.mu)
    assert [guessed(analysis.program, *tilts, added) for tilts in both(analysis)] == [None, None]
    assert len(asked) == 2  # without looking for forces
    grown = analysis.resistance_with(whole)
    assert grown.resistance.right.alpha == pytest.approx(1 / 4)


def test_a_stone_that_goes_along_leaves_alpha_as_it_is():
    """The lower block slides; the upper one, on a rougher joint, slides with it."""
    model = model_from_labels(stacked((60, 20, 0), (40, 10, 10))).model
    first = RigidBlockModel(model.blocks[:1], model.interfaces[:1], model.mu)
    analysis = growing_large.begun(first, PX)
    rough = tuple(replace(i, mu=0.8) for i in model.interfaces[1:])
    added = analysis.program.columns_of(Addition(first, model.blocks[1:], rough), model.mu)
    for tilt, other in both(analysis):
        guess = guessed(analysis.program, tilt, other, added)
        assert guess.alpha == tilt.alpha == pytest.approx(tilt.sign * 0.58)
        assert guess.velocity[3:] == pytest.approx(tilt.velocity)
        assert end(analysis, added, guess).alpha == tilt.alpha


def test_no_stone_is_for_others():
    analysis, _ = wall_of(coursed(1, 4, 80), 8)
    added = analysis.program.columns_of(analysis.model.with_added((), ()).added, 0.58)
    assert guessed(analysis.program, analysis.greatest, analysis.least, added) is None


def test_columns_may_begin_at_either_body():
    """Ids decide which body of an interface comes first; a stone may have a smaller one."""
    analysis, candidates = wall_of(coursed(1, 7, 150), 40)
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
        for tilt, other in both(analysis):
            one = guessed(program, tilt, other, added)
            two = guessed(program, tilt, other, replace(added, cones=swapped))
            assert (one is None) == (two is None)
            if one is not None:
                told += 1
                assert two.alpha == pytest.approx(one.alpha)
                assert (end(analysis, added, one) is None) == (end(analysis, added, two) is None)
    assert told > 2
