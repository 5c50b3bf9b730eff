"""Candidate sets (§3.4, §5.1), the best of them (§3.8, Algorithm 2), costs, and policies asked."""

import dataclasses
import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import UsageError
from drystone.selection.algorithm2 import Action, SelectionSettings, select_action, weighted_sum
from drystone.selection.policy import choice_of
from drystone.selection.sampling import sample_stones, second_fold
from drystone.selection.scored import Craft, ScoreSettings, craft_cost
from tests.naive.selection import algorithm2
from tests.selection.offers import INDICES, offered
from tests.strategies import repeatable

EIGHTHS = st.integers(0, 8).map(lambda n: n / 8)


def action(stone_id, **changes):
    return Action(stone_id, dataclasses.replace(INDICES, **changes))


@st.composite
def actions(draw):
    # Few values, so that ties and equal means are common.
    return [
        action(
            draw(st.integers(1, 5)),
            LLC=draw(st.one_of(st.none(), st.integers(-1, 4).map(lambda n: n / 4))),
            NHR=draw(EIGHTHS),
            IWR=draw(EIGHTHS),
            IS=draw(EIGHTHS),
            GDS=draw(EIGHTHS),
            LFR=draw(EIGHTHS),
            boundary=draw(st.booleans()),
        )
        for _ in range(draw(st.integers(0, 9)))
    ]


@repeatable(200)
@given(pi=actions(), weights=st.tuples(*[st.sampled_from([0.0, 0.5, 1.0, 2.0])] * 5))
def test_choice_is_that_of_the_appendix(pi, weights):
    w_llc, w_nhr, w_third, w_gds, w_lfr = weights
    settings = SelectionSettings(
        w_llc=w_llc, w_nhr=w_nhr, w_third=w_third, w_gds=w_gds, w_lfr=w_lfr
    )
    selected = select_action(pi, settings)
    expected = algorithm2(pi, weights)
    if expected is None:
        assert selected is None
        return
    assert pi[selected.position] == expected
    assert weighted_sum(expected, settings) == pytest.approx(
        sum(w * t for w, t in zip(weights, expected.terms, strict=True))
    )


@pytest.mark.parametrize("name", ["LLC", "NHR", "IWR", "GDS", "LFR"])
def test_equal_values_do_not_vanish_by_rounding(name):
    for value, count in itertools.product((0.1 + 0.2, 0.7 / 3, 1 / 3, 1e-3), (3, 6, 7, 10)):
        selected = select_action([action(k + 1, **{name: value}) for k in range(count)])
        assert (selected.survivors, selected.position) == ((tuple(range(count)),) * 6, 0)
    # Values a rounding apart pass together, and those that the limit analysis cannot tell apart.
    for more in (0.1 + 0.2, 0.3 + 1e-10):
        selected = select_action([action(1, LLC=more), action(2, LLC=0.3, GDS=0.6)])
        assert (selected.survivors[1], selected.position) == ((0, 1), 1)


CLUSTERS = {1: 1, 2: 1, 3: 1, 5: 2, 8: 2, 9: 3, 70_000: 4}
ALL = tuple(CLUSTERS)


def sampled(sampling, remaining, seed=0):
    return sample_stones(sampling, remaining, CLUSTERS, np.random.default_rng(seed))


@pytest.mark.parametrize("sampling", ["variant", "twofold", "shrinking", "uniform", "full"])
def test_samples_have_a_stone_of_each_cluster_that_is_left_but_for_uniform_ones(sampling):
    """Topped up to the number of clusters at first, as far as there are stones."""
    for remaining in (ALL, (1, 2, 3, 8, 70_000), (2, 3, 70_000), (3, 9), ()):
        samples = [sampled(sampling, remaining, seed) for seed in range(60)]
        clusters = {CLUSTERS[i] for i in remaining}
        sizes = {"shrinking": len(clusters), "full": len(remaining)}
        count = sizes.get(sampling, min(4, len(remaining)))
        assert all(len({*sample}) == count for sample in samples)
        assert all(list(sample) == sorted(sample) for sample in samples)
        assert {i for sample in samples for i in sample} == set(remaining)
        spread = all({CLUSTERS[i] for i in sample} == clusters for sample in samples)
        assert spread == (sampling != "uniform" or len(remaining) < 5)
        # The generator decides.
        assert samples[7] == sampled(sampling, remaining, 7)


def test_full_does_not_draw_and_the_second_fold_is_the_cluster_of_the_winner():
    rng = np.random.default_rng(3)
    sample_stones("full", ALL, CLUSTERS, rng)
    assert rng.random() == np.random.default_rng(3).random()
    assert second_fold(2, (2, 3, 5, 9), CLUSTERS) == (2, 3)
    assert second_fold(9, ALL, CLUSTERS) == (9,)


NOTHING = Craft(**dict.fromkeys((field.name for field in dataclasses.fields(Craft)), 0.0))


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Craft)])
def test_each_cost_has_its_own_weight_and_bulk_is_a_bonus(name):
    weights = ScoreSettings(**{name: 3.0})
    cost = craft_cost(dataclasses.replace(NOTHING, **{name: 2.0}), weights)
    assert cost == (-6.0 if name in ("area", "thickness") else 6.0)


RNG = np.random.default_rng(0)
OFFERS = [offered(1), offered(2), offered(3)]


def asked(said, offers=OFFERS):
    """What is chosen where a policy returns something, or raises it."""

    def choose(candidates, rng):
        assert isinstance(candidates, tuple)
        assert rng is RNG
        if isinstance(said, BaseException):
            raise said
        return said

    return choice_of("x", SimpleNamespace(choose=choose), offers, RNG)


@pytest.mark.parametrize("said", [0, 2, np.int64(1), np.uint8(2)])
def test_a_position_is_taken_and_none_is_none(said):
    found = asked(said)
    assert type(found) is int
    assert found == said
    assert asked(None) is None
    assert asked(KeyError(), []) is None  # nobody is asked when there is nothing


@pytest.mark.parametrize(
    "said", [3, -1, True, False, np.True_, 1.0, "1", [0], OFFERS[0], np.array([0, 1])]
)
def test_nonsense_is_named(said):
    with pytest.raises(UsageError, match=r"E147 --policy: the policy 'x' returned .* 0 to 2\."):
        asked(said)


def test_errors_are_named_but_an_interrupt_is_none_of_its_errors():
    for error in (KeyError("area"), RuntimeError("no"), AssertionError(), SystemExit(3)):
        with pytest.raises(UsageError, match="E147 .*'x' raised " + type(error).__name__) as caught:
            asked(error)
        assert caught.value.__cause__ is error
    with pytest.raises(KeyboardInterrupt):
        asked(KeyboardInterrupt())
