"""Runs of searches: none is done twice, however many processes there are; their table."""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from drystone.errors import DrystoneError, UsageError
from drystone.planner.settings import method_settings
from drystone_lab import search_runs
from drystone_lab.search_runs import (
    COLUMNS,
    FIGURES,
    SPENT,
    WAYS,
    SearchResult,
    SearchRun,
    SearchTask,
    SearchWay,
    append_results,
    chosen_ways,
    in_words,
    read_results,
    searched,
)
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS

TARGET = BRICKS
STONES = BRICKS.stones(None)
ONE_WAY = BenchSettings(quick=True, policies=("restarts",))


@pytest.fixture
def done(monkeypatch: pytest.MonkeyPatch) -> list[SearchTask]:
    """Tasks that were done; their walls have as many stones as their seed says."""
    tasks: list[SearchTask] = []

    def do(task: SearchTask) -> list[SearchResult]:
        tasks.append(task)
        figures = dict.fromkeys((*FIGURES, *SPENT), 0.5) | {"placed": task.seed}
        return [{**figures, "CPU s": seconds} for seconds in task.times]

    monkeypatch.setattr(search_runs, "do", do)
    return tasks


def test_what_the_table_holds_is_not_done_again(done: list[SearchTask], tmp_path: Path) -> None:
    said: list[str] = []
    kept = replace(ONE_WAY, runs=tmp_path / "runs.csv", say=said.append)
    walls = [(TARGET, STONES)]
    first = searched(walls, [1, 2], (1.0, 3.0), kept)
    assert [(task.seed, task.times) for task in done] == [(1, (1.0, 3.0)), (2, (1.0, 3.0))]
    assert first.keys() == {
        SearchRun(TARGET.name, "restarts", seed, seconds)
        for seed in (1, 2)
        for seconds in (1.0, 3.0)
    }
    again = searched(walls, [2, 1], (3.0,), kept)
    assert len(done) == 2
    assert [(run.seed, one["placed"]) for run, one in again.items()] == [(2, 2), (1, 1)]
    # A time that is not there is looked for anew; what was there stays.
    searched(walls, [1], (2.0, 3.0), kept)
    assert done[2:] == [SearchTask(TARGET.name, "restarts", 1, (2.0, 3.0), None, True)]
    assert len(read_results(tmp_path / "runs.csv")) == len(said) == 5
    assert said[-1].startswith("bricks, restarts, seed 1, 2 s: 1 of 9 stones, ")


def test_seeds_are_outermost_and_ways_take_turns(done: list[SearchTask]) -> None:
    both = replace(ONE_WAY, policies=("restarts", "search"))
    searched([(TARGET, STONES)], [5, 6], (1.0,), both)
    assert [(task.seed, task.way) for task in done] == [
        (5, "restarts"), (5, "search"), (6, "restarts"), (6, "search")
    ]  # fmt: skip


def test_runs_with_other_settings_are_others(done: list[SearchTask], tmp_path: Path) -> None:
    plain = replace(ONE_WAY, runs=tmp_path / "runs.csv")
    aimed = replace(plain, changes=(("goal.F_AH", 1.5), ("goal.F_AV", 40)))
    walls = [(TARGET, STONES)]
    searched(walls, [1], (1.0,), plain)
    (run,) = searched(walls, [1], (1.0,), aimed)
    assert run == SearchRun(TARGET.name, "restarts, goal.F_AH = 1.5, goal.F_AV = 40", 1, 1.0)
    assert [task.changes for task in done] == [(), aimed.changes]
    searched(walls, [1], (1.0,), aimed)
    assert len(done) == 2
    assert len(read_results(tmp_path / "runs.csv")) == 2


def test_settings_are_what_a_way_goes_by() -> None:
    task = SearchTask(TARGET.name, "restarts", 1, (1e-6,), None, True)
    (plain,) = search_runs.do(task)
    (halved,) = search_runs.do(replace(task, changes=(("goal.filling", 0.0),)))
    weight = method_settings("best").goal.filling
    lost = weight * plain["F_SF"] / plain["possible F_SF"]
    assert halved["merit"] == pytest.approx(plain["merit"] - lost)


def test_processes_do_what_one_does(tmp_path: Path) -> None:
    walls, settings = [(TARGET, STONES)], replace(ONE_WAY, runs=tmp_path / "runs.csv", jobs=2)
    # The first wall is always finished, and here none is begun after it.
    two = searched(walls, [1, 2], (1e-6,), settings)
    one = searched(walls, [1, 2], (1e-6,), ONE_WAY)
    assert [run.seed for run in two] == [1, 2]
    timeless = [{run: {**r, "CPU s": 0} for run, r in found.items()} for found in (one, two)]
    assert timeless[0] == timeless[1]
    assert two == read_results(tmp_path / "runs.csv")


class Deadly(str):
    """The name of a way at which its process dies, as soon as it hears of it."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Callable[[int], object], tuple[int]]:
        return os._exit, (1,)


@pytest.mark.parametrize("death", [True, False])
def test_what_ended_is_kept_when_a_task_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, death: bool
) -> None:
    # In another process the unknown way is nobody's.
    last = SearchWay(Deadly("unknown") if death else "unknown", WAYS[0].states)
    monkeypatch.setattr(search_runs, "chosen_ways", lambda _: (WAYS[0], last))
    settings = replace(ONE_WAY, runs=tmp_path / "runs.csv", jobs=2)
    error, words = (DrystoneError, "E402") if death else (ValueError, "unpack")
    with pytest.raises(error, match=words) as caught:
        searched([(TARGET, STONES)], [1], (1e-6,), settings)
    if death:
        assert caught.value.where == "bricks, unknown, seed 1"
    assert {run.way for run in read_results(tmp_path / "runs.csv")} == {"restarts"}


def test_ways_are_chosen_by_name() -> None:
    assert chosen_ways(()) == WAYS
    chosen = chosen_ways(("search", "restarts with wedges"))
    assert [way.name for way in chosen] == ["restarts with wedges", "search"]
    with pytest.raises(UsageError, match="E138"):
        chosen_ways(("search", "annealing"))


def result(*values: float | None) -> dict[str, float | None]:
    return dict(zip((*FIGURES, *SPENT), values, strict=True))


RUNS = {
    SearchRun("rubble, 60, exact", "restarts with wedges", 3, 60.0): result(
        58, 0.1 + 0.2, None, 1e-7, 1.0, 2.5, 3.0, 0.0, 0.5, -1.25, 0.8, 17, 60.123
    ),
    SearchRun("R, raster", "search", 4, 0.5): result(34, *[0.25] * 9, 1, 1, 1.5),
}


def test_what_is_read_is_what_was_written(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    assert read_results(path) == {}
    for one in RUNS.items():
        append_results(path, [one])
    assert read_results(path) == RUNS
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0] == ",".join(COLUMNS)
    assert len(lines) == 3


def test_the_last_of_two_equal_runs_counts(tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    (run, first), (_, second) = RUNS.items()
    append_results(path, [(run, first), (run, second)])
    assert read_results(path)[run] == second


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda text: text.replace("wall,", "stone,", 1), 1),
        (lambda _: "", 1),
        (lambda text: text[:-20], 3),
        (lambda text: text.replace(",60.0,", ",long,"), 2),
    ],
)
def test_other_files_are_not_taken_for_tables(change, line: int, tmp_path: Path) -> None:
    path = tmp_path / "runs.csv"
    append_results(path, RUNS.items())
    path.write_text(change(path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(UsageError, match="E148") as caught:
        read_results(path)
    assert caught.value.where == f"{path}:{line}"


def test_a_result_in_words() -> None:
    words = in_words(next(iter(RUNS.values())), 60)
    assert words.startswith("58 of 60 stones, F_SF 0.3, F_AV -, F_AH 1e-07, ")
    assert words.endswith("merit -1.25, 17 walls")
