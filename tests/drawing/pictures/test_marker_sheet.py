import os

import pytest

from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.errors import PlanError, UsageError


def test_sheets_are_whole_or_as_they_were(tmp_path, monkeypatch):
    path = tmp_path / "sheets.pdf"
    write_marker_sheets(MarkerSheets((0, 1, 2, 3), 0.05), path)
    before = path.read_bytes()
    assert before.startswith(b"%PDF")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(PlanError, match="No space left") as caught:
        write_marker_sheets(MarkerSheets((4, 5, 6, 7), 0.05), path)
    assert caught.value.where == str(path)
    with pytest.raises(UsageError, match="E174"):
        write_marker_sheets(MarkerSheets((0, 1, 2, 3), 0.5), path)
    assert [(one.name, one.read_bytes()) for one in tmp_path.iterdir()] == [(path.name, before)]
