"""What the simplex kernel says is believed where it is proved."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.backend import compiled
from drystone.statics import growing_large, growing_simplex
from drystone.statics.limit import lateral_resistance
from drystone.statics.solvers.warm import NAME as WARM
from tests.statics.growth import (
    PX,
    assert_same,
    bits,
    empty,
    implementation,
    upwards,
    wall_and_candidates,
    with_block,
)
from tests.statics.walls import coursed, irregular


@pytest.mark.skipif(compiled("simplex") is None, reason="kernels are not compiled here")
def test_both_kernels_say_the_same_to_the_last_bit():
    labels = irregular(5, 30, 110, 80)
    told = []
    for name in ("compiled", "numpy"):
        with pytest.MonkeyPatch.context() as patch:
            analysis, candidates = wall_and_candidates(labels, 14, implementation(name, patch))
            told.append([bits(analysis.resistance_with(model)) for model in candidates])
    assert told[0] == told[1]


def _spoilt_kernel(monkeypatch, spoil, tilts=(1, -1)):
    """Let the kernel lie about some tilts."""
    honest = growing_simplex.solve_added

    def wrong(tilt, added):
        answer = honest(tilt, added)
        return spoil(answer) if tilt.sign in tilts else answer

    monkeypatch.setattr(growing_simplex, "solve_added", wrong)


def _more(answer):
    return replace(answer, forces=answer.forces * (1 + 1e-6))


def _faster(answer):
    """A block moves on its own."""
    velocity = answer.velocity.copy()
    velocity[-2] -= 1e-3
    return replace(answer, velocity=velocity)


def _other_alpha(answer):
    return replace(answer, alpha=answer.alpha * 0.999)


def _gives_up(answer):
    return replace(answer, status=2, alpha=float("nan"), forces=np.empty(0), velocity=np.empty(0))


def _falls(answer):
    """Claims that nothing holds the wall up, with the mechanism of its optimum."""
    return replace(answer, status=1, alpha=float("nan"), forces=np.empty(0))


@pytest.mark.parametrize("spoil", [_more, _faster, _other_alpha, _gives_up, _falls])
@pytest.mark.parametrize("sign", [1, -1])
def test_answers_of_the_kernel_without_a_certificate_are_found_again_cold(spoil, sign, monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8)
    model = candidates[0]
    assert not analysis.resistance_with(model).solved_cold
    _spoilt_kernel(monkeypatch, spoil, (sign,))
    grown = analysis.resistance_with(model)
    expected = lateral_resistance(model)
    assert grown.solved_cold
    assert grown.resistance.left.alpha == expected.left.alpha
    assert grown.resistance.left.solver == expected.left.solver != growing_simplex.NAME
    extended = analysis.extended(model)
    assert bits(extended.grown) == bits(grown)
    assert extended.grown.solved_cold
    # The wall goes on without the kernel.
    further = with_block(extended.model, candidates[1].blocks[-1], whole=candidates[1])
    assert_same(extended.resistance_with(further), further, {WARM, growing_large.NAME})


def test_a_false_fall_is_found_out(monkeypatch):
    """A wall that stands is not called unstable because alpha has the wrong sign."""
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8)
    _spoilt_kernel(monkeypatch, lambda answer: replace(answer, alpha=-answer.alpha))
    grown = analysis.resistance_with(candidates[0])
    assert grown.solved_cold
    assert grown.resistance.stable


def test_a_wall_that_outgrows_the_kernel_goes_on():
    whole, blocks = upwards(coursed(1, 5, 110, 2))
    analysis = growing_simplex.begun(empty(), PX, most=9)
    kinds = []
    for block in blocks[:14]:
        model = with_block(analysis.model, block, whole=whole)
        grown = analysis.resistance_with(model)
        analysis = analysis.extended(model)
        assert bits(analysis.grown) == bits(grown)
        assert bits(analysis.resistance_with(analysis.model)) == bits(grown)
        kinds.append(type(analysis).__name__)
    assert kinds == ["SimplexGrowth"] * 9 + ["LargeGrowth"] * 5
    at_once = growing_simplex.begun(analysis.model, PX, most=9)
    assert type(at_once).__name__ == "LargeGrowth"
    assert_same(at_once.grown, analysis.model, {WARM})
