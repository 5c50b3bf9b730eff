"""Results of searches are kept as they are, and other files are told from their tables."""

from pathlib import Path

import pytest

from drystone.errors import UsageError
from drystone_lab.search_runs import (
    COLUMNS,
    FIGURES,
    SPENT,
    SearchRun,
    append_results,
    in_words,
    read_results,
)


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
