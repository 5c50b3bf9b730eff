"""Medians, ranges, pairs, trends and claims as cells and words."""

import numpy as np
import pytest

from drystone_lab.reproduce.cells import COLUMNS, figures_of, summary, trend, wins
from drystone_lab.reproduce.item import sentences
from tests.lab.reproduce.small_walls import outcome


def test_medians_and_ranges():
    walls = [
        outcome(placed=8, F_SF=0.7, F_LR=None),
        outcome(placed=10, F_SF=0.9, F_LR=0.25),
        outcome(placed=9, F_SF=0.7500049, F_LR=0.75),
    ]
    cells = dict(zip(COLUMNS, summary(walls), strict=True))
    assert (cells["walls"], cells["stones"], cells["F_AV median"]) == (3, 10, 1.0)
    none = dict(zip(COLUMNS, summary([outcome(F_LR=None)] * 2), strict=True))
    for found, name, middle, span in (
        (cells, "placed", 9, "8 to 10"),
        (cells, "F_SF", 0.75, "0.700 to 0.900"),
        (cells, "F_LR", 0.5, "0.25 to 0.75"),
        (none, "F_LR", None, None),
    ):
        assert (found[f"{name} median"], found[f"{name} range"]) == (middle, span)
    assert figures_of(walls, "F_LR") == [0.25, 0.75]


@pytest.mark.parametrize("figure", ["F_SF", "F_AH"])
def test_counts_are_those_of_all_pairs(figure):
    rng = np.random.default_rng(4)
    first, second = rng.integers(0, 4, (2, 40)).astype(float)
    more, less = int((first > second).sum()), int((first < second).sum())
    found = wins(list(first), list(second), figure)
    better, worse = (less, more) if figure == "F_AH" else (more, less)
    assert found == (figure, better, 40 - better - worse, worse, np.median(first - second))
    # What is missing makes no pair.
    assert wins([None, 1.0], [2.0, None], "F_LR") == ("F_LR", 0, 0, 0, None)
    assert wins([0.5, 0.5], [0.5 + 1e-12, None], "F_LR")[2] == 1


def test_a_trend_is_the_correlation_of_the_ranks():
    rng = np.random.default_rng(3)
    x = np.repeat([10, 20, 30, 40], 3)
    y = np.round(x / 40 + rng.normal(0, 0.3, 12), 1)
    ranks = [(v[:, None] > v).sum(axis=1) + ((v[:, None] == v).sum(axis=1) + 1) / 2 for v in (x, y)]
    found = trend(list(zip(x.tolist(), y.tolist(), strict=True)))
    assert found.rho == pytest.approx(np.corrcoef(*ranks)[0, 1], abs=1e-6)
    falling = trend([(n, -n) for n in range(8)])
    mixed = trend(list(enumerate([3.0, 1.0, 4.0, 1.0, 5.0, 2.0, 6.0, 0.0])))
    assert (falling.rho, falling.clear, mixed.clear) == (-1, True, False)
    # There is none of few or equal values.
    assert trend([(1, 1.0), (2, 2.0), (3, 3.0), (4, None)]) is None
    assert trend([(n, 1.0) for n in range(9)]) is None
    assert trend([(1, float(n)) for n in range(9)]) is None


def test_claims_that_cannot_be_told_do_not_count():
    found = [("A.", "one", True), ("B.", "two", False), ("C.", "three", None)]
    told = sentences(found)
    assert told[0] == "Of 2 claims of the paper that can be told, 1 agree."
    assert [one.split(":")[0] for one in told[1:]] == ["Agrees", "Differs", "Cannot be told"]
