"""Selecting the best action (§3.8, Algorithm 2, DESIGN 4.7)."""

import dataclasses
import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.indices import Indices
from drystone.selection.algorithm2 import Action, SelectionSettings, select_action, weighted_sum
from tests.naive.selection import algorithm2
from tests.strategies import repeatable

EVEN = Indices(SF=1, LFR=0.5, GDS=0.5, NHR=0.5, IWR=0.5, IS=0.5, LLC=0.5, boundary=False)
EIGHTHS = st.integers(0, 8).map(lambda n: n / 8)


def action(stone_id, **changes):
    return Action(stone_id, dataclasses.replace(EVEN, **changes))


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
    # Values a rounding apart pass together.
    selected = select_action([action(1, LLC=0.3), action(2, LLC=0.1 + 0.2, GDS=0.6)])
    assert (selected.survivors[1], selected.position) == ((0, 1), 1)


def test_boundary_and_inner_stones_are_compared_among_their_own_kind():
    inner = [action(1, IWR=0.9), action(2, IWR=0.7)]
    boundary = [action(3, IS=0.2, boundary=True), action(4, IS=0.1, boundary=True)]
    selected = select_action([*inner, *boundary])
    # Against a common mean of .475 both inner ones would pass and no boundary stone.
    assert selected.survivors == ((0, 1, 2, 3),) * 3 + ((0, 2),) * 3
    # A better boundary stone survives for the later filters.
    better = action(3, IS=0.2, GDS=0.9, boundary=True)
    selected = select_action([*inner, better])
    assert selected.position == 2
