"""Pairs of walls from the same seeds."""

import numpy as np
import pytest

from drystone_lab.reproduce.base import PR, R
from drystone_lab.reproduce.trials import Trials
from drystone_lab.reproduce.wins import Wins, by_way, wins, wins_of, wins_rows
from tests.lab.reproduce.made_outcomes import outcome


@pytest.mark.parametrize("figure", ["F_SF", "F_AV", "F_LR", "F_AH", "E_FLUSH"])
def test_counts_are_those_of_all_pairs(figure: str) -> None:
    rng = np.random.default_rng(4)
    first, second = rng.integers(0, 4, (2, 40)).astype(float)
    more, less = int((first > second).sum()), int((first < second).sum())
    found = wins(list(first), list(second), figure)
    lower_is_better = figure in ("F_AH", "E_FLUSH")
    assert (found.better, found.worse) == ((less, more) if lower_is_better else (more, less))
    assert found.pairs == 40
    assert found.median_difference == np.median(first - second)


def test_what_is_missing_makes_no_pair() -> None:
    assert wins([None, 1.0], [2.0, None], "F_LR") == Wins(0, 0, 0, None)
    assert wins([0.5, 0.5], [0.5 + 1e-12, None], "F_LR").equal == 1


def test_a_majority_is_of_all_pairs() -> None:
    assert Wins(3, 0, 2, 0.0).is_majority
    assert not Wins(3, 3, 0, 0.0).is_majority
    assert not Wins(0, 0, 0, None).is_majority


def test_sets_are_compared_with_themselves() -> None:
    def trials(way: str, wall: object, filled: float) -> Trials:
        return Trials(wall, way, (), (outcome(F_SF=filled),))  # type: ignore[arg-type]

    every = [trials("a", R, 0.8), trials("b", R, 0.7), trials("a", PR, 0.5), trials("b", PR, 0.6)]
    assert [each.wall for each in by_way(every, "a")] == [R, PR]
    found = wins_of(by_way(every, "a"), by_way(every, "b"), "F_SF")
    assert (found.better, found.worse, found.median_difference) == (1, 1, 0.0)
    rows = wins_rows(every, "a", ("b",))
    assert rows[0] == ("b", "F_SF", 1, 0, 1, 0.0)
    assert [row[1] for row in rows] == ["F_SF", "F_AV", "F_AH", "F_LR"]
