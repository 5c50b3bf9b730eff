import numpy as np
import pytest
from scipy.stats import binom

from drystone_lab.cells import median_difference
from drystone_lab.table import Table


def test_cells_of_all_kinds_and_zero_without_a_sign():
    table = Table("Differences", ("case", "difference"), (("one", -0.0), ("two", -0.5)))
    assert table.text().splitlines()[2:] == ["one            0", "two         -0.5"]
    assert "| one | 0 |" in table.markdown()
    np_float = type("float64", (float,), {"__repr__": lambda _: "np.float64(1.5)"})
    table = Table("x", ("a", "b"), ((True, np_float(1.5)), ('say "a, b"', 0.1 + 0.2), (None, 3)))
    assert table.csv() == 'a,b\nyes,1.5\n"say ""a, b""",0.30000000000000004\n,3\n'


def test_pairs_are_kept_together_and_left_out_without_a_value():
    some, others = [10.0, 200.0, 3000.0], [9.0, 198.0, 2997.0]
    assert median_difference(some, others) == "+2 (+1 to +3)"
    assert median_difference(others, some) == "-2 (-3 to -1)"
    found = median_difference([1.0, None, 4.0], [0.0, 1.0, None])
    assert found == "+1 (+1 to +1)"
    assert median_difference([None], [1.0]) is None
    assert median_difference([], []) is None


@pytest.mark.parametrize("count", [5, 9, 15])
def test_the_interval_is_that_of_all_draws(count):
    """The median of n draws is at most the k-th value when more than half of them are."""
    at_most = binom.sf(count // 2, count, np.arange(1, count + 1) / count)
    low, high = np.searchsorted(at_most, [0.025, 0.975])
    found = median_difference(list(range(count)), [0.0] * count)
    assert found == f"+{count // 2} ({low:+} to {high:+})"
