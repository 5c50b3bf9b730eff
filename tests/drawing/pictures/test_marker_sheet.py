import pytest

from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.errors import UsageError


def test_markers_that_do_not_fit_are_refused(tmp_path):
    with pytest.raises(UsageError, match="E174"):
        write_marker_sheets(MarkerSheets((0, 1, 2, 3), 0.5), tmp_path / "sheets.pdf")
    assert not list(tmp_path.iterdir())
