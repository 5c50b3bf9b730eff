"""Whatever this room writes is whole or as it was, and an error names it."""

import os
from pathlib import Path

import pytest

from drystone.drawing import plot_wall, save, save_mechanism_animation, write_report
from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.drawing.report.notebook import Shown
from drystone.errors import PlanError
from tests.drawing import examples
from tests.drawing.report.test_report import example_view

WRITERS = {
    "wall.png": lambda path: save(plot_wall(examples.wall()).figure, path, dpi=20),
    "wall.pdf": lambda path: save(plot_wall(examples.wall()).figure, path),
    "wall.svg": lambda path: save(plot_wall(examples.wall()).figure, path),
    "fall.gif": lambda path: save_mechanism_animation(
        path, examples.wall().labels, examples.mechanism(), None, frames=2
    ),
    "report.html": lambda path: write_report(path, example_view()),
    "view.html": lambda path: Shown(example_view()).write(path),
    "sheets.pdf": lambda path: write_marker_sheets(MarkerSheets((0, 1, 2, 3), 0.05), path),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_file_is_whole_or_as_it_was(name: str, tmp_path: Path, monkeypatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / name
    path.write_bytes(b"good")
    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(PlanError, match=r"E206.*No space left") as caught:
        WRITERS[name](path)
    assert caught.value.where == str(path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [(name, b"good")]
