"""The wall with the highest filling and multiplier, to one decimal."""

import pytest

from drystone_lab.reproduce.best_trial import best_trial, tenths
from drystone_lab.runs.outcome import Outcome
from tests.lab.reproduce.made_outcomes import outcome


def _wall(resistance: float | None, filled: float) -> Outcome:
    return outcome(F_LR=resistance, F_SF=filled)


@pytest.mark.parametrize(
    ("walls", "best"),
    [
        # Filling to one decimal first, however strong the others are.
        ([_wall(0.38, 0.9), _wall(0.98, 0.7)], 0),
        # .78 and .82 are both .8: the multiplier decides.
        ([_wall(0.38, 0.82), _wall(0.46, 0.78)], 1),
        # .42 and .38 are both .4 too: the fuller one.
        ([_wall(0.42, 0.78), _wall(0.38, 0.8)], 1),
        # Equal in filling: the larger multiplier, then the earlier trial.
        ([_wall(0.38, 0.8), _wall(0.42, 0.8), _wall(0.42, 0.8)], 1),
        ([_wall(0.4, 0.8), _wall(0.4, 0.8)], 0),
        # Among equally full walls those without a multiplier are last.
        ([_wall(None, 0.84), _wall(0.01, 0.76)], 1),
        ([_wall(None, 0.76), _wall(None, 0.8)], 1),
    ],
)
def test_the_rule(walls: list[Outcome], best: int) -> None:
    assert best_trial(walls) == best


def test_halves_are_rounded_up_whatever_the_solver_leaves() -> None:
    assert [tenths(value) for value in (0.05, 0.15, 0.25, 0.35, 0.45, 0.55)] == [1, 2, 3, 4, 5, 6]
    assert tenths(0.35 - 1e-12) == tenths(0.35 + 1e-12) == 4
    assert (tenths(0.349999), tenths(0.0)) == (3, 0)
