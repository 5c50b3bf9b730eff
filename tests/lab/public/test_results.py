import csv
import math
from dataclasses import astuple, replace
from itertools import product
from statistics import fmean, stdev

import numpy as np
import pytest
from scipy.stats import norm, rankdata, wilcoxon

from drystone.errors import InputError, UsageError
from drystone.io.folder_lock import locked
from drystone_lab.public import tables
from drystone_lab.public.store import KINDS, KeptRun, keep, kept_runs
from drystone_lab.public.tables import BenchResults

RUN = KeptRun(
    run_key="a", suite="bricks", suite_version=1, wall="bricks 2:1", method="paper", settings="{}",
    seed=0, version="0.9.0", placed=30, stones=40, F_SF=0.8, F_AV=7.0, F_AH=1.3, F_LR=None,
    T_LEVEL=0.0, E_FLUSH=0.0, wedge_area=0.0, seconds=0.5, pga_g=None, shaken="no",
    made_at="2026-01-01T00:00:00+00:00", platform="Linux x86_64",
)  # fmt: skip


def test_runs_come_back_as_they_were_in_order_unless_another_run_writes(tmp_path):
    store = tmp_path / "new"
    assert kept_runs(store) == ()
    later = replace(RUN, run_key="b", version="0.10.0", F_LR=0.1 + 0.2, pga_g=0.25, shaken="yes")
    keep(store, [RUN, later])
    assert kept_runs(store) == (later, RUN)
    keep(store, [replace(RUN, seconds=9.0)])
    assert [run.seconds for run in kept_runs(store)] == [0.5, 9.0]
    with (store / "runs.csv").open(newline="") as file:
        columns, first, second = csv.reader(file)
    assert columns == list(KINDS)
    assert first == [str(value) for value in astuple(later)]
    assert second[columns.index("F_LR")] == ""
    keep(tmp_path, [RUN])
    with locked(tmp_path), pytest.raises(UsageError, match="E149"):
        keep(tmp_path, [replace(RUN, run_key="b")])
    assert kept_runs(tmp_path) == (RUN,)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda text: text.replace("run_key,", "key,"), 1),
        (lambda text: text.replace(",0.8,", ",much,"), 2),
        (lambda text: text.replace(",0.5,", ",,"), 2),
        (lambda text: text[:-40], 2),
        (lambda _: "", 1),
    ],
)
def test_other_files_are_not_taken_for_tables(tmp_path, change, line):
    keep(tmp_path, [RUN])
    path = tmp_path / "runs.csv"
    path.write_text(change(path.read_text()))
    for read in (kept_runs, lambda folder: keep(folder, [RUN])):
        with pytest.raises(InputError, match=f"^E401 {path}:{line}: "):
            read(tmp_path)


HISTORY = [
    replace(RUN, run_key=f"{version}{seed}", version=version, seed=seed, F_SF=start + 0.1 * seed)
    for version, start in (("0.10.0", 0.6), ("0.9.0", 0.5), ("0.10.0rc1", 0.4))
    for seed in range(3)
]


def test_a_history_has_medians_by_version_oldest_first():
    rows = tables.history_table(tables.medians_of(HISTORY)).records()
    assert [row["version"] for row in rows] == ["0.9.0", "0.10.0rc1", "0.10.0"]
    assert [row["F_SF"] for row in rows] == pytest.approx([0.6, 0.5, 0.7])
    assert [rows[0][name] for name in ("placed share", "F_LR", "runs")] == [0.75, None, 3]
    # Versions with other runs are not compared, and settings make another method.
    assert len(tables.history_table(tables.medians_of(HISTORY)).notes) == 1
    (_, warning) = tables.history_table(tables.medians_of(HISTORY[1:])).notes
    assert "bricks/1 paper" in warning
    other = replace(RUN, run_key="c", version="0.10.0", settings='{"sampling": "full"}')
    methods = [one.method for one in tables.medians_of([RUN, other])]
    assert methods == ["paper", 'paper {"sampling": "full"}']
    # A picture has a panel for each figure that is there.
    axes = tables.drawn_history(tables.medians_of([*HISTORY, other])).axes
    labels = ["placed share", "F_SF", "F_AV", "F_AH", "wall, s"]
    assert [(ax.get_xlabel(), ax.get_ylabel()) for ax in axes] == [("version", y) for y in labels]
    assert axes[1].lines[0].get_ydata().tolist() == pytest.approx([0.6, 0.5, 0.7])
    # A version without a value has no point.
    assert axes[1].lines[1].get_xydata().tolist() == [[2, 0.8]]
    assert axes[1].get_xticklabels()[0].get_text() == "0.9.0"


def f_sf_table(found):
    """The one pair of F_SF by row, or all, and the notes below."""
    return next(table for table in tables.pair_tables(found) if table.title.startswith("F_SF"))


def results(values, *figures, shaken="no"):
    """Results by method: F_SF, or other figures that are equal; half of them are of each wall."""
    runs, walls = [], ("bricks 2:1", "bricks 3:1")
    for method, column in values.items():
        for place, value in enumerate(column):
            second, seed = divmod(place, len(column) // 2)
            known = {"F_LR": 0.5, "shaken": shaken, **dict.fromkeys(figures or ("F_SF",), value)}
            runs.append(replace(RUN, wall=walls[second], method=method, seed=seed, **known))
    return BenchResults(tuple(runs))


def test_the_interval_is_that_of_a_mean():
    """For many pairs it is that of the normal distribution, within what 10 000 draws give."""
    noise = np.random.default_rng(1).normal(0.3, 2.0, 400)
    found = tables.compared(noise.tolist(), [0.0] * 400)
    half = norm.ppf(0.975) * noise.std() / math.sqrt(400)
    assert found.mean == pytest.approx(noise.mean())
    assert found.low == pytest.approx(noise.mean() - half, abs=0.03 * half)
    assert found.high == pytest.approx(noise.mean() + half, abs=0.03 * half)
    assert found == tables.compared(noise.tolist(), [0.0] * 400)


@pytest.mark.parametrize(
    "moved", [[1.0, 1.0, 2.0, -1.0, 3.0, 3.0], [1, 1, 1, 1, 1], [-1.0, 2, 2, 2, 3, -4, 5, 5]]
)
@pytest.mark.parametrize("equal", [0, 15])
def test_signed_ranks_are_exact_with_ties_and_equal_pairs(moved, equal):
    """By all signs that the differences could have; equal pairs say nothing."""
    ranks = rankdata(np.abs(moved))
    sums = [
        sum(rank for rank, up in zip(ranks, signs, strict=True) if up)
        for signs in product((True, False), repeat=len(moved))
    ]
    half, found = ranks.sum() / 2, ranks[np.array(moved) > 0].sum()
    expected = np.mean([abs(one - half) >= abs(found - half) for one in sums])
    assert tables.compared([*moved, *[0.0] * equal], [0.0] * (len(moved) + equal)).p == expected


def test_many_signed_ranks_go_by_the_normal_distribution():
    noise = np.random.default_rng(4).normal(0.3, 1.0, 50)
    exact = tables.compared(noise.tolist(), [0.0] * 50).p
    assert exact == pytest.approx(wilcoxon(noise, method="exact").pvalue)
    more = tables.compared([*noise.tolist(), 0.1], [0.0] * 51).p
    assert more == pytest.approx(wilcoxon([*noise.tolist(), 0.1], method="asymptotic").pvalue)


@pytest.mark.parametrize(
    ("first", "second", "higher", "won", "mean", "pairs"),
    [
        # Rounding errors are no differences.
        ([0.1 + 0.2, 0.5], [0.3, 0.5], True, 0.5, 0.0, 2),
        ([1.0, 2.0, 2.0, 5.0], [2.0, 3.0, 2.0, 4.0], False, 0.625, -0.25, 4),
        ([1.0, 2.0, 2.0, 5.0], [2.0, 3.0, 2.0, 4.0], True, 0.375, -0.25, 4),
        # Pairs without a value are counted, and are not zero.
        ([0.75, None, 0.7, None], [0.5, 0.5, None, None], True, 1.0, 0.25, 1),
    ],
)
def test_pairs_are_won_and_have_a_mean(first, second, higher, won, mean, pairs):
    found = tables.compared(first, second, higher=higher)
    assert (found.won, found.mean, found.pairs) == (won, mean, pairs)
    assert found.left_out == len(first) - pairs
    assert found.p == 1.0
    assert tables.compared([None], [1.0]) is None


def test_a_clear_winner_is_shown_and_ranked_first():
    rng = np.random.default_rng(3)
    low = rng.uniform(0.5, 0.6, 24)
    found = results({"weak": low.tolist(), "strong": (low + rng.uniform(0.1, 0.2, 24)).tolist()})
    row = f_sf_table(found).records()[0]
    assert (row["shows"], row["won"], row["pairs"]) == ("strong", 0.0, 24)
    first, second = tables.pair_tables(found)[-1].records()
    assert (first["method"], first["F_SF"], second["F_SF"]) == ("strong", 1.0, 2.0)
    assert first["mean rank"] == pytest.approx((1.0 + 4 * 1.5) / 5)
    assert first["not told apart from the next in"] == "placed, F_AV, F_AH, F_LR"
    assert second["not told apart from the next in"] is None
    # Few pairs show nothing, and it is said.
    found = results({"weak": [0.1, 0.2, 0.1, 0.2], "strong": [0.5] * 4})
    table, (first, _) = f_sf_table(found), tables.pair_tables(found)[-1].records()
    assert table.records()[0]["shows"] == "strong?"
    assert any("no p can be below 0.62" in note for note in table.notes)
    assert first["not told apart from the next in"] == "placed, F_SF, F_AV, F_AH, F_LR"


def test_copies_are_no_evidence():
    """Five seeds that change nothing on either of two walls are two pairs, not ten."""
    found = results({"a": [0.70] * 5 + [0.80] * 5, "b": [0.71] * 5 + [0.82] * 5})
    table = f_sf_table(found)
    (row,) = table.records()
    assert (row["pairs"], row["mean"], row["shows"]) == (2, -0.015, "b?")
    assert row["p"] == 1.0
    assert any("do not depend on the seed count once" in note for note in table.notes)
    assert "With 2 pairs and 5 tests no p can be below 1: use more walls" in table.notes[-1]
    assert not any("lack a value" in note for note in table.notes)
    # Walls count for those two methods that depend on the seed in any figure.
    still, moved = [0.7, 0.7, 0.7, 0.8, 0.8, 0.8], [0.7, 0.6, 0.7, 0.8, 0.8, 0.8]
    rows = f_sf_table(results({"a": still, "b": still, "c": moved})).records()
    # Of the third method one wall depends on it.
    assert {(row["first"], row["second"]): row["pairs"] for row in rows} == {
        ("a", "b"): 2, ("a", "c"): 4, ("b", "c"): 4,
    }  # fmt: skip
    table = f_sf_table(results({"a": [7.0, 8.0] * 2, "b": [8.0, 9.0] * 2}, "F_AV"))
    assert table.records()[0]["pairs"] == 4
    assert not any("depend on the seed" in note for note in table.notes)


@pytest.mark.parametrize(
    ("values", "ranks"),
    [
        ({"a": [0.1 + 0.2, 0.5], "b": [0.3, 0.5]}, {"a": 1.5, "b": 1.5}),
        ({"a": [None, 0.2], "b": [0.1, 0.1]}, {"a": 1.5, "b": 1.5}),
        ({"a": [None, None], "b": [0.1, 0.1], "c": [0.0, 0.0]}, {"b": 1.0, "c": 2.0, "a": 3.0}),
    ],
)
def test_equal_values_share_a_rank_and_undefined_ones_are_last(values, ranks):
    ranking = tables.pair_tables(results(values))[-1].records()
    assert {row["method"]: row["F_SF"] for row in ranking} == ranks


def test_mean_spread_and_best():
    found = results({"one": [0.7, 0.8, 0.9, 0.5, 0.5, 0.53]}, "F_SF", "F_AH")
    walls, everything, times = tables.comparison(found)
    first, second = walls.records()
    assert (first["F_SF"], first["±F_SF"]) == (pytest.approx(0.8), pytest.approx(0.1))
    assert (first["best F_SF"], first["best F_AH"]) == (0.9, 0.7)
    spread = stdev([0.5, 0.5, 0.53])
    assert second["±F_SF"] == pytest.approx(spread, rel=1e-3)
    (row,) = everything.records()
    assert row["F_SF"] == pytest.approx(fmean([0.8, 0.51]))
    assert row["±F_SF"] == pytest.approx(math.hypot(0.1, spread) / 2**0.5, rel=1e-3)
    assert row["best F_SF"] == pytest.approx(fmean([0.9, 0.53]))
    assert [row["s"] for row in times.records()] == [0.5, 0.5]


def test_what_is_not_defined_is_counted_and_never_zero():
    found = results({"one": [None, 0.4, 0.6, None, None, None]}, "F_LR")
    walls, everything, _ = tables.comparison(found)
    first, second = walls.records()
    assert first["F_LR"] == everything.records()[0]["F_LR"] == pytest.approx(0.5)
    assert second["F_LR"] is second["best F_LR"] is second["±F_LR"] is None
    assert any("F_LR is not defined for walls of one 4 of 6" in note for note in walls.notes)
    # Amplitudes are there when walls were shaken.
    assert "PGA, g" not in walls.columns
    shaken = results({"one": [0.2, None, 0.3, 0.1, 0.1, 0.1]}, "pga_g", shaken="yes")
    walls, *_ = tables.comparison(shaken)
    assert walls.records()[0]["PGA, g"] == pytest.approx(0.25)
    # Of the yardstick nothing was built, and so it is of walls in which no stone found a place.
    said = "one 1 of 6: nothing was built, or it does not stand at rest in the engine; left"
    assert any(f"walls of {said}" in note for note in walls.notes)
