import numpy as np
import pytest

from drystone.planner.profile import StepTime
from drystone_lab.pictures.growth import (
    LINES,
    PART_COLOURS,
    REST,
    Claim,
    PowerLaw,
    Series,
    plot_growth,
    plot_step_times,
    step_time_panels,
)

STEPS = [
    StepTime(0, 4, 0.010, {"placement": 0.004, "limit analysis": 0.005}),
    StepTime(1, 4, 0.020, {"placement": 0.006, "indices": 0.014}),
]
SERIES = (
    Series("wall", ((10.0, 1.0), (100.0, 10.0)), PowerLaw(0.1, 1.0)),
    Series("step", ((10.0, 0.5), (100.0, 0.7))),
)
CLAIMS = (Claim("paper: wall", 20.0, 9.0), Claim("paper: step", 90.0, 25.0, at_most=True))


def test_parts_stand_on_top_of_each_other_and_reach_the_time_of_the_step():
    ax = plot_step_times(STEPS, title="variant")
    by_part = {bars.get_label(): bars.patches for bars in ax.containers}
    assert list(by_part) == [*PART_COLOURS, REST]
    for k, step in enumerate(STEPS):
        foot = 0.0
        for part, bars in by_part.items():
            assert bars[k].get_y() == pytest.approx(foot)
            if part != REST:
                assert bars[k].get_height() == pytest.approx(1e3 * step.parts.get(part, 0.0))
            foot += bars[k].get_height()
        assert foot == pytest.approx(1e3 * step.seconds)
    assert ax.get_title() == "variant"


def test_panels_have_the_walls_beside_each_other_and_one_legend():
    figure = step_time_panels({"variant": STEPS, "full": STEPS[:1]})
    left, right = figure.axes
    assert (left.get_title(), right.get_title()) == ("variant", "full")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [*PART_COLOURS, REST]
    assert left.get_legend() is right.get_legend() is None


def test_points_laws_and_claims_are_drawn_where_they_are():
    ax = plot_growth(SERIES, CLAIMS, size="pixels")
    points, line, bare, wall, step = ax.get_lines()
    assert points.get_xydata().tolist() == [[10.0, 1.0], [100.0, 10.0]]
    np.testing.assert_allclose(line.get_xydata(), [[10.0, 1.0], [100.0, 10.0]])
    assert bare.get_xydata().tolist() == [[10.0, 0.5], [100.0, 0.7]]
    assert [wall.get_marker(), step.get_marker()] == ["x", "v"]
    assert step.get_xydata().tolist() == [[90.0, 25.0]]
    assert [points.get_color(), bare.get_color()] == [colour for colour, _ in LINES[:2]]
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert words == ["wall", "exponent 1.00", "step", "paper: wall", "paper: step"]
    assert (ax.get_xscale(), ax.get_yscale(), ax.get_xlabel()) == ("log", "log", "pixels")
