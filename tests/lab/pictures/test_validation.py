import numpy as np
import pytest

from drystone_lab.pictures.validation import COLOURS, MARKERS, Prediction, plot_predictions

POINTS = [
    Prediction("granite", "turns", 40.0, 30.0, 35.0, 50.0),
    Prediction("granite", "level", 40.0, 55.0, 60.0, 80.0),
    Prediction("sandstone", "turns", 10.0, 12.0, 12.0, 12.0),
]


def test_points_bands_looks_and_legend():
    ax = plot_predictions(POINTS, band="friction")
    for bars, point in zip(ax.containers, POINTS, strict=True):
        line, _, (bar,) = bars
        assert line.get_xydata().tolist() == [[point.measured, point.predicted]]
        ends = [[point.measured, point.low], [point.measured, point.high]]
        assert bar.get_segments()[0].tolist() == ends
    lines = [bars[0] for bars in ax.containers]
    assert [line.get_color() for line in lines] == [COLOURS[0], COLOURS[1], COLOURS[0]]
    assert [line.get_marker() for line in lines] == [MARKERS[0], MARKERS[0], MARKERS[1]]
    assert ax.get_xlim() == ax.get_ylim() == (0.0, pytest.approx(84.0))
    (equal,) = [line for line in ax.get_lines() if line.get_gid() == "equal"]
    np.testing.assert_array_equal(*equal.get_xydata().T)
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert words == ["turns", "level", "granite", "sandstone", "friction", "equal", "20 % off"]
