import numpy as np
import pytest

from drystone.drawing.files import save
from drystone_lab.pictures.validation import COLOURS, MARKERS, Prediction, plot_predictions

POINTS = [
    Prediction("granite", "turns", 40.0, 30.0, 35.0, 50.0),
    Prediction("granite", "level", 40.0, 55.0, 60.0, 80.0),
    Prediction("sandstone", "turns", 10.0, 12.0, 12.0, 12.0),
]


def drawn():
    return plot_predictions(POINTS, band="friction")


def test_points_lie_at_measured_and_predicted_with_their_bands():
    ax = drawn()
    for bars, point in zip(ax.containers, POINTS, strict=True):
        line, _, (bar,) = bars
        assert line.get_xydata().tolist() == [[point.measured, point.predicted]]
        assert bar.get_segments()[0].tolist() == [
            [point.measured, point.low],
            [point.measured, point.high],
        ]


def test_colours_tell_models_and_markers_series():
    lines = [bars[0] for bars in drawn().containers]
    assert [line.get_color() for line in lines] == [COLOURS[0], COLOURS[1], COLOURS[0]]
    assert [line.get_marker() for line in lines] == [MARKERS[0], MARKERS[0], MARKERS[1]]


def test_both_axes_begin_at_0_and_hold_everything():
    ax = drawn()
    assert ax.get_xlim() == ax.get_ylim() == (0.0, pytest.approx(84.0))
    (equal,) = [line for line in ax.get_lines() if line.get_gid() == "equal"]
    np.testing.assert_array_equal(*equal.get_xydata().T)


def test_the_legend_explains_everything():
    words = [text.get_text() for text in drawn().get_legend().get_texts()]
    assert words == ["turns", "level", "granite", "sandstone", "friction", "equal", "20 % off"]


def test_the_same_points_give_the_same_bytes(tmp_path):
    for name in ("one.png", "two.png"):
        save(drawn().figure, tmp_path / name, dpi=60)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
