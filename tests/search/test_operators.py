"""Which ways of changing a wall a chain takes."""

from collections import Counter

import numpy as np

from drystone.search.operators import (
    NEW,
    OPERATORS,
    RECREATED,
    RELAID,
    REPLANNED,
    Credits,
    shares,
)

OF_PLANNED, OF_OTHERS = shares(planned=True, polish=0.2), shares(planned=False, polish=0.2)


def drawn(known: Credits, usual: tuple[float, ...], count: int = 2000) -> Counter[str]:
    rng = np.random.default_rng(0)
    return Counter(known.drawn(usual, rng) for _ in range(count))


def used(operator: str, times: int, helped: int) -> Credits:
    known = Credits()
    for k in range(times):
        known = known.after(operator, helped=k < helped)
    return known


def test_before_anything_is_known_they_are_drawn_by_their_shares() -> None:
    counts = drawn(Credits(), OF_PLANNED)
    for operator, share in zip(OPERATORS, OF_PLANNED, strict=True):
        assert abs(counts[operator] / 2000 - share / sum(OF_PLANNED)) < 0.04


def test_a_wall_without_a_plan_is_only_built_up_again() -> None:
    assert set(drawn(used(RECREATED, 50, 0), OF_OTHERS)) == {RECREATED}


def test_what_has_helped_is_drawn_more_often_and_nothing_is_given_up() -> None:
    known = used(RELAID, 30, 12) + used(RECREATED, 30, 0)
    counts, before = drawn(known, OF_PLANNED), drawn(Credits(), OF_PLANNED)
    assert counts[RELAID] > 1.5 * before[RELAID]
    assert 0 < counts[RECREATED] < 0.3 * before[RECREATED]
    assert counts[REPLANNED] > 0
    assert counts[NEW] > 0


def test_credits_add_up() -> None:
    both = used(RELAID, 3, 2) + used(NEW, 4, 1)
    assert dict(zip(OPERATORS, both.uses, strict=True)) == {
        RECREATED: 0, RELAID: 3, REPLANNED: 0, NEW: 4,
    }  # fmt: skip
    assert dict(zip(OPERATORS, both.helped, strict=True)) == {
        RECREATED: 0, RELAID: 2, REPLANNED: 0, NEW: 1,
    }  # fmt: skip
