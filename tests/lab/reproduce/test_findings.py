"""Trends by rank and the words about claims."""

import numpy as np
import pytest

from drystone_lab.reproduce.findings import (
    Finding,
    Trend,
    agreeing,
    findings_table,
    sentences,
    trend,
)


def by_hand(x, y):
    """Spearman's rho: Pearson's of the ranks, equal values sharing their mean rank."""

    def ranks(values):
        values = np.array(values)
        below = (values[:, None] > values).sum(axis=1)
        equal = (values[:, None] == values).sum(axis=1)
        return below + (equal + 1) / 2

    return np.corrcoef(ranks(x), ranks(y))[0, 1]


def test_a_trend_is_the_correlation_of_the_ranks():
    rng = np.random.default_rng(3)
    x = np.repeat([10, 20, 30, 40], 3)
    y = np.round(x / 40 + rng.normal(0, 0.3, 12), 1)
    found = trend(list(zip(x.tolist(), y.tolist(), strict=True)))
    assert found is not None
    assert found.rho == pytest.approx(by_hand(x, y), abs=1e-6)
    assert found.count == 12


def test_a_fall_of_eight_in_line_is_clear_and_a_mixture_is_not():
    falling = trend([(n, -n) for n in range(8)])
    mixed = trend([(n, value) for n, value in enumerate([3, 1, 4, 1, 5, 2, 6, 0])])
    assert falling is not None
    assert mixed is not None
    assert falling.rho == -1
    assert falling.clear
    assert not mixed.clear


def test_there_is_no_trend_of_few_or_equal_values():
    assert trend([(1, 1.0), (2, 2.0), (3, 3.0), (4, None)]) is None
    assert trend([(n, 1.0) for n in range(9)]) is None
    assert trend([(1, float(n)) for n in range(9)]) is None


def test_claims_that_cannot_be_told_do_not_count():
    found = [
        Finding("A.", "one", True), Finding("B.", "two", False), Finding("C.", "three", None)
    ]  # fmt: skip
    assert agreeing(found) == "Of 2 claims of the paper that can be told, 1 agrees."
    told = sentences(found)
    assert told[0] == agreeing(found)
    assert [one.split(":")[0] for one in told[1:]] == ["Agrees", "Differs", "Cannot be told"]
    assert agreeing(found[2:]) == "None of the paper's claims can be told."
    table = findings_table("Claims", found)
    assert [row["agrees"] for row in table.records()] == [True, False, None]


def test_a_trend_in_words():
    assert Trend(0.5, 0.25, 4).words() == "rho 0.50, p 0.25, n 4"
