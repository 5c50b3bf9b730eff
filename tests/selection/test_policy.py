"""What a policy sees, and what it may return."""

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.selection.policy import choice_of
from tests.selection.offers import offered

RNG = np.random.default_rng(0)
OFFERS = [offered(1), offered(2), offered(3)]


class _Says:
    """Returns something, or raises it."""

    def __init__(self, what):
        self.what = what

    def choose(self, candidates, rng):
        assert isinstance(candidates, tuple)
        assert rng is RNG
        if isinstance(self.what, BaseException):
            raise self.what
        return self.what


@pytest.mark.parametrize("said", [0, 2, np.int64(1), np.uint8(2)])
def test_a_position_is_taken(said):
    found = choice_of("x", _Says(said), OFFERS, RNG)
    assert type(found) is int
    assert found == said


def test_none_is_none_and_nobody_is_asked_when_there_is_nothing():
    assert choice_of("x", _Says(None), OFFERS, RNG) is None
    assert choice_of("x", _Says(KeyError()), [], RNG) is None


@pytest.mark.parametrize(
    "said", [3, -1, True, False, np.True_, 1.0, "1", [0], OFFERS[0], np.array([0, 1])]
)
def test_nonsense_is_named(said):
    with pytest.raises(UsageError, match=r"E147 --policy: the policy 'x' returned .* 0 to 2\."):
        choice_of("x", _Says(said), OFFERS, RNG)


def test_errors_are_named_but_an_interrupt_is_none_of_its_errors():
    for error in (KeyError("area"), RuntimeError("no"), AssertionError()):
        with pytest.raises(UsageError, match="E147 .*'x' raised " + type(error).__name__) as caught:
            choice_of("x", _Says(error), OFFERS, RNG)
        assert caught.value.__cause__ is error
    with pytest.raises(KeyboardInterrupt):
        choice_of("x", _Says(KeyboardInterrupt()), OFFERS, RNG)
