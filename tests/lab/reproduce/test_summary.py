"""Medians and ranges as cells."""

from drystone_lab.reproduce.summary import (
    COLUMNS,
    METRICS,
    figures_of,
    median_of,
    metric_cells,
    summary,
)
from tests.lab.reproduce.made_outcomes import outcome


def test_medians_and_ranges() -> None:
    walls = [
        outcome(placed=8, F_SF=0.7, F_LR=None),
        outcome(placed=10, F_SF=0.9, F_LR=0.25),
        outcome(placed=9, F_SF=0.7500049, F_LR=0.75),
    ]
    cells = dict(zip(COLUMNS, summary(walls), strict=True))
    assert cells["walls"] == 3
    assert cells["stones"] == 10
    assert (cells["placed median"], cells["placed range"]) == (9, "8 to 10")
    assert (cells["F_SF median"], cells["F_SF range"]) == (0.75, "0.700 to 0.900")
    assert (cells["F_LR median"], cells["F_LR range"]) == (0.5, "0.25 to 0.75")
    assert cells["F_AV median"] == 1.0


def test_a_figure_that_no_wall_has() -> None:
    cells = dict(zip(COLUMNS, summary([outcome(F_LR=None)] * 2), strict=True))
    assert (cells["F_LR median"], cells["F_LR range"]) == (None, None)
    assert median_of([outcome(F_LR=None)], "F_LR") is None
    assert figures_of([outcome(F_LR=None), outcome(F_LR=0.5)], "F_LR") == [0.5]


def test_figures_of_one_wall() -> None:
    wall = outcome(F_SF=0.123456, F_AV=None, F_AH=2.0, F_LR=0.5)
    assert dict(zip(METRICS, metric_cells(wall), strict=True)) == {
        "F_SF": 0.1235, "F_AV": None, "F_AH": 2.0, "F_LR": 0.5,
    }  # fmt: skip
