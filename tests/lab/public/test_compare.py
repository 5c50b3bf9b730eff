"""Tables of the public benchmark."""

from statistics import fmean, stdev

import pytest

from drystone_lab.public.tables import SHAKE, BenchResults, comparison
from tests.lab.public.test_pairs import WALLS, result


def made(**columns):
    return BenchResults(
        tuple(
            result(wall, "one", seed, **{name: column[wall.name][seed]
                                         for name, column in columns.items()})
            for wall in WALLS
            for seed in range(3)
        )
    )  # fmt: skip


VALUES = {WALLS[0].name: [0.7, 0.8, 0.9], WALLS[1].name: [0.5, 0.5, 0.53]}


def test_mean_spread_and_best():
    walls, everything, times = comparison(made(F_SF=VALUES, F_AH=VALUES))
    first, second = walls.records()
    assert first["F_SF"] == pytest.approx(0.8)
    assert first["±F_SF"] == pytest.approx(0.1)
    assert (first["best F_SF"], first["best F_AH"]) == (0.9, 0.7)
    assert second["±F_SF"] == pytest.approx(stdev([0.5, 0.5, 0.53]), rel=1e-3)
    (row,) = everything.records()
    assert row["F_SF"] == pytest.approx(fmean([0.8, 0.51]))
    assert row["±F_SF"] == pytest.approx(
        ((0.1**2 + stdev([0.5, 0.5, 0.53]) ** 2) / 2) ** 0.5, rel=1e-3
    )
    assert row["best F_SF"] == pytest.approx(fmean([0.9, 0.53]))
    assert [row["s"] for row in times.records()] == [1.0, 1.0]


def test_what_is_not_defined_is_counted_and_never_zero():
    values = {WALLS[0].name: [None, 0.4, 0.6], WALLS[1].name: [None, None, None]}
    walls, everything, _ = comparison(made(F_LR=values))
    first, second = walls.records()
    assert first["F_LR"] == pytest.approx(0.5)
    assert second["F_LR"] is second["best F_LR"] is second["±F_LR"] is None
    assert everything.records()[0]["F_LR"] == pytest.approx(0.5)
    assert any(
        note.startswith("F_LR is not defined for walls of one 4 of 6") for note in walls.notes
    )


def test_amplitudes_are_there_when_walls_were_shaken():
    values = {WALLS[0].name: [0.2, None, 0.3], WALLS[1].name: [0.1, 0.1, 0.1]}
    walls, _, _ = comparison(made(**{SHAKE: values}))
    assert walls.records()[0]["PGA, g"] == pytest.approx(0.25)
    # Of the yardstick nothing was built, and so it is of walls in which no stone found a place.
    assert any(
        "walls of one 1 of 6: nothing was built, or it does not stand at rest in the engine; left"
        in note
        for note in walls.notes
    )
    assert "PGA, g" not in comparison(made(F_SF=VALUES))[0].columns
