"""What stones cannot fill, against all combinations."""

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.sums import unfillable
from tests.naive import planner as naive
from tests.strategies import repeatable

lengths = st.lists(st.lists(st.integers(1, 12), min_size=1, max_size=2).map(tuple), max_size=5)
few_kinds = st.lists(st.sampled_from([(3,), (2, 7), (4, 5)]), max_size=7)


@repeatable(200)
@given(st.one_of(lengths, few_kinds), st.integers(0, 40))
def test_tries_all_combinations(stones, limit):
    assert unfillable(Counter(stones), limit).tolist() == naive.unfillable(stones, limit)


def test_very_many_stones_are_as_many_as_fit_and_none_fill_nothing():
    assert unfillable({(7,): 10**9}, 15).tolist() == unfillable({(7,): 2}, 15).tolist()
    assert unfillable({(2,): 0}, 3).tolist() == [0, 1, 2, 3]
