"""Hundreds of random walls: no crash, no false "optimal", lower bound <= upper bound.

Every answer is proved again from the blocks and interfaces alone: forces in equilibrium and within
friction for both directions show that a wall stands (and, by convexity, that it stands under its
own weight); a mechanism bounds what it carries, or falls.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from tests import strategies
from tests.naive.statics import contact_matrices
from tests.statics.walls import stacked
from tests.strategies import picture

FRICTIONS = st.sampled_from([0.58, 0.3, 0.1, 0.0, 0.9, 1.0, 50.0])
ALLOWED = 1e-7
"""Of an unbalanced force, in mean weights, or of a closing contact, in the largest velocity."""


def scales(model):
    """Of the forces and moments on the blocks: mean weights, times a mean length."""
    weight = np.mean([block.weight for block in model.blocks])
    return weight * np.array([1.0, 1.0, np.sqrt(np.mean([block.area for block in model.blocks]))])


def loads(model, sign, alpha=0.0):
    """The weight of every block as it lies, and as it pushes at alpha."""
    weights = np.array([block.weight for block in model.blocks])
    return np.column_stack((sign * alpha * weights, -weights, np.zeros(len(weights))))


def unbalanced(model, result, sign):
    """Largest force or moment on a block that is not balanced, in mean weights."""
    normal, tangent = contact_matrices(model)
    pressing, along = result.forces.T
    assert (np.abs(along) <= model.mu * pressing + ALLOWED * scales(model)[0]).all()
    carried = (normal @ pressing + tangent @ along).reshape(-1, 3)
    return np.abs((carried + loads(model, sign, result.alpha)) / scales(model)).max()


def work_of_weight(model, mechanism, sign):
    """Of the weight as it lies and as it pushes, in mean weights; the mechanism is admissible."""
    assert mechanism.block_ids == tuple(block.id for block in model.blocks)
    opening, slip = (part.T @ mechanism.velocity.ravel() for part in contact_matrices(model))
    turning = np.abs(mechanism.velocity[:, 2]).max() * scales(model)[2] / scales(model)[0]
    allowed = ALLOWED * max(1.0, turning) * (1 + model.mu)
    assert (opening >= model.mu * np.abs(slip) - allowed).all()
    down = (loads(model, sign) * mechanism.velocity).sum() / scales(model)[0]
    both = (loads(model, sign, 1.0) * mechanism.velocity).sum() / scales(model)[0]
    return down, both - down


def assert_proved(labels, mu):
    """Analyse a wall and prove the answer again."""
    model = model_from_labels(labels, mu).model
    ids, pixels = np.unique(labels[labels > 0], return_counts=True)
    assert [(b.id, b.area) for b in model.blocks] == list(zip(ids, pixels, strict=True))
    both = lateral_resistance(model, mechanism=True)
    if not model.blocks:
        assert both.left.status is both.right.status is LimitStatus.UNBOUNDED
        return both
    assert both.left.status is both.right.status
    for result, sign in ((both.left, -1.0), (both.right, 1.0)):
        assert result.status in (LimitStatus.OPTIMAL, LimitStatus.UNSTABLE)
        assert result.certificate.holds
        down, along = work_of_weight(model, result.mechanism, sign)
        if result.status is LimitStatus.UNSTABLE:
            assert result.alpha is None
            assert down > ALLOWED
            continue
        bounds = sign * result.certificate.lower, sign * result.certificate.upper
        assert bounds[0] <= bounds[1] + 1e-8 * max(1.0, bounds[1])
        assert unbalanced(model, result, sign) <= ALLOWED
        assert along > 0
        assert -down / along == pytest.approx(result.alpha, abs=1e-6)
    return both


@given(strategies.label_images() | strategies.floating_labels(), FRICTIONS)
@strategies.repeatable(120)
def test_answers_are_proved(labels, mu):
    """Bricks, stacks, single pixels, ids in pieces, holes, stones that hang or float."""
    assert_proved(labels, mu)


@given(strategies.label_images(), FRICTIONS)
@strategies.repeatable(12)
def test_without_dilatancy_random_walls_carry_no_more(labels, mu):
    model = model_from_labels(labels, mu).model
    associative, both = lateral_resistance(model), nonassociative_resistance(model)
    pairs = ((associative.left, both.left, -1.0), (associative.right, both.right, 1.0))
    for upper, result, sign in pairs:
        if not upper.success:
            assert result.status is upper.status
            assert result.alpha is None
        elif result.success:
            assert 0 <= result.alpha <= upper.alpha + 1e-9
            assert unbalanced(model, result, sign) <= ALLOWED
        else:
            assert result.status in (LimitStatus.UNSTABLE, LimitStatus.FAILED)


HELD = picture([7] * 5, [7, 0, 0, 0, 7], [7, 0, 0, 0, 7], [7, 0, 3, 0, 7], [7] * 5)
PIECES = picture([5, 5, 0], [0, 0, 0], [5, 0, 0])


@pytest.mark.parametrize(
    ("labels", "mu", "alphas"),
    [
        (picture([1]), 0.58, (0.58, 0.58)),  # one pixel slides
        (picture(*[[1]] * 9), 0.58, (1 / 9, 1 / 9)),  # one pixel wide: a needle
        (picture([1, 2, 3]), 0.0, (0.0, 0.0)),
        (picture(*[[2**32 - 1] * 2] * 4), 0.9, (0.5, 0.5)),
        (HELD, 0.3, (0.3, 0.3)),
        (PIECES, 50.0, (5 / 11, 1 / 11)),  # the piece in the air is a part of the other
        (picture([2, 1, 3], [2, 0, 3]), 0.0, (None, None)),  # between pillars, without friction
        (stacked((20, 20, 0), (20, 20, 10)), 0.9, (0.75, 0.0)),  # just balanced
        (picture([0, 1], [2, 0]), 50.0, (None, None)),  # corner on corner
    ],
)
def test_walls_of_a_few_pixels(labels, mu, alphas):
    both = assert_proved(labels, mu)
    assert (both.left.alpha, both.right.alpha) == pytest.approx(alphas, abs=1e-9)
    assert both.right.alpha is None or both.right.alpha >= 0.0
