from dataclasses import replace
from statistics import median

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.drawing.palette import PLAIN_COLOUR, cluster_colour
from drystone.planner.profile import StepTime
from drystone_lab import pictures
from drystone_lab.pictures import Prediction, group_panels
from drystone_lab.reproduce.masons import TracedWall
from drystone_lab.walls import PR
from tests.drawing.examples import CLUSTERS, WEDGE, wall

VALUES = {"both": [0.8, 0.7, 0.9, 0.75, 0.72, 0.71], "none": [0.5, None, 0.4], "empty": [None]}


def _line(ax, gid):
    (line,) = [line for line in ax.lines if line.get_gid() == gid]
    return line


def test_points_are_the_values_lines_their_medians_and_crosses_claims():
    figure = group_panels({"F_SF": VALUES, "F_LR": VALUES}, claims={"F_SF": {"none": 0.6}})
    ax, other = figure.axes
    assert list(_line(ax, "group-both").get_ydata()) == VALUES["both"]
    assert list(_line(ax, "group-none").get_ydata()) == [0.5, 0.4]
    assert set(_line(ax, "median-both").get_ydata()) == {median(VALUES["both"])}
    assert set(_line(ax, "median-none").get_ydata()) == {0.45}
    assert "median-empty" not in [line.get_gid() for line in ax.lines]
    assert [text.get_text() for text in ax.get_xticklabels()] == list(VALUES)
    assert ax.get_ylabel() == "F_SF"
    assert _line(ax, "claim-none").get_xydata().tolist() == [[1, 0.6]]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["the paper"]
    assert other.get_legend() is None


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (4, 4), (5, 3), (8, 4), (12, 4)])
def test_panels_fill_rows(count, columns):
    figure = group_panels({f"figure {k}": VALUES for k in range(count)}, title="t")
    assert [ax.get_ylabel() for ax in figure.axes] == [f"figure {k}" for k in range(count)]
    assert {ax.get_subplotspec().get_gridspec().ncols for ax in figure.axes} == {columns}


def test_one_figure_over_another():
    some = {"rotation": ([1.0, 3.0, 2.0], [0.5, 0.7, 0.1]), "wedge": ([None, 4.0], [0.5, 0.6])}
    ax = pictures.plot_two_figures(some, across="area", up="F_SF")
    assert [value[0] for value in _line(ax, "median-rotation").get_data()] == [2.0, 0.5]
    assert [list(value) for value in _line(ax, "group-wedge").get_data()] == [[4.0], [0.6]]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("area", "F_SF")


def test_parts_stand_on_top_of_each_other_and_reach_the_time_of_the_step():
    steps = [
        StepTime(0, 4, 0.010, {"placement": 0.004, "limit analysis": 0.005}),
        StepTime(1, 4, 0.020, {"placement": 0.006, "indices": 0.014}),
    ]
    figure = pictures.step_time_panels({"variant": steps, "full": steps[:1]})
    ax, right = figure.axes
    assert (ax.get_title(), right.get_title()) == ("variant", "full")
    parts = [*pictures.PART_COLOURS, pictures.REST]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == parts
    assert [bars.get_label() for bars in ax.containers] == parts
    assert ax.get_legend() is right.get_legend() is None
    for k, step in enumerate(steps):
        foot = 0.0
        for part, bars in zip(parts, ax.containers, strict=True):
            assert bars[k].get_y() == pytest.approx(foot)
            if part != pictures.REST:
                assert bars[k].get_height() == pytest.approx(1e3 * step.parts.get(part, 0.0))
            foot += bars[k].get_height()
        assert foot == pytest.approx(1e3 * step.seconds)


def test_points_laws_and_claims_are_drawn_where_they_are():
    series = {"wall": [(10.0, 1.0), (100.0, 10.0)], "step": [(10.0, 0.5)]}
    claims = [("paper: wall", "x", 20.0, 9.0), ("paper: step", "v", 90.0, 25.0)]
    ax = Figure().add_subplot()
    pictures.plot_growth(ax, series, claims)
    points, line, bare, *paper = ax.get_lines()
    assert points.get_xydata().tolist() == [[10.0, 1.0], [100.0, 10.0]]
    np.testing.assert_allclose(line.get_xydata(), points.get_xydata())
    assert bare.get_xydata().tolist() == [[10.0, 0.5]]
    assert [claim.get_marker() for claim in paper] == ["x", "v"]
    assert paper[1].get_xydata().tolist() == [[90.0, 25.0]]
    assert [points.get_color(), bare.get_color()] == [colour for colour, _ in pictures.LOOKS[:2]]
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert words == ["wall", "exponent 1.00", "step", "paper: wall", "paper: step"]
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_xlabel() == "pixels of the wall"


def test_points_bands_looks_and_legend():
    points = [
        Prediction("granite", "turns", 40.0, 30.0, 35.0, 50.0),
        Prediction("granite", "level", 40.0, 55.0, 60.0, 80.0),
        Prediction("sandstone", "turns", 10.0, 12.0, 12.0, 12.0),
    ]
    ax = pictures.plot_predictions(points, "friction")
    for (line, _, (bar,)), point in zip(ax.containers, points, strict=True):
        assert line.get_xydata().tolist() == [[point.measured, point.predicted]]
        ends = [[point.measured, point.low], [point.measured, point.high]]
        assert bar.get_segments()[0].tolist() == ends
    looks = [(bars[0].get_color(), bars[0].get_marker()) for bars in ax.containers]
    assert looks == [
        (pictures.LOOKS[c][0], pictures.LOOKS[m][1]) for c, m in ((0, 0), (1, 0), (0, 1))
    ]
    assert ax.get_xlim() == ax.get_ylim() == (0.0, pytest.approx(84.0))
    np.testing.assert_array_equal(*_line(ax, "equal").get_xydata().T)
    words = [text.get_text() for text in ax.get_legend().get_texts()]
    assert words == ["turns", "level", "granite", "sandstone", "friction", "equal", "20 % off"]


def test_panels_go_from_left_to_right_and_down_as_high_as_the_tallest_of_their_row():
    def panel(title, aspect):
        return pictures.Panel(title, aspect, lambda ax: ax.plot([0, 1], [0, 1], label="line"))

    panels = [panel("a", 0.2), panel("b\nsecond", 0.5), pictures.EMPTY, panel("d", 0.3)]
    figure = pictures.sheet_of(panels, 2)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["a", "b\nsecond", "d"]
    boxes = [ax.get_position(original=True) for ax in figure.axes]
    assert boxes[0].x1 < boxes[1].x0 < 1
    assert boxes[2].x0 == pytest.approx(boxes[1].x0)
    assert boxes[2].y1 < boxes[1].y0
    assert min(box.y0 for box in boxes) > 0
    assert max(box.y1 for box in boxes) < 1
    figure = pictures.sheet_of([panel("", aspect) for aspect in (0.2, 0.5, 0.3)], 2)
    inches = figure.get_size_inches()
    sizes = [ax.get_position(original=True).size * inches for ax in figure.axes]
    assert [high / wide for wide, high in sizes] == pytest.approx([0.5, 0.5, 0.3])
    assert {round(wide, 6) for wide, _ in sizes} == {round(sizes[0][0], 6)}


def test_every_wall_is_drawn_whole_under_its_title():
    walls = [("one", wall(), CLUSTERS), ("two\nlines", wall(), None)]
    figure = pictures.sheet_of([pictures.wall_panel(*one) for one in walls], 2)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["one", "two\nlines"]
    for ax in figure.axes:
        gids = {patch.get_gid() for patch in ax.patches}
        assert {f"stone-{p.stone_id}" for p in wall().placements} | {f"wedge-{WEDGE}"} <= gids
        assert ax.get_xlabel() == "px"
        assert ax.get_legend() is None
    site, (x0, x1), (y0, y1) = wall().site, ax.get_xlim(), ax.get_ylim()
    assert pictures.wall_aspect(site.height_px / site.width_px) == pytest.approx(
        (y1 - y0) / (x1 - x0)
    )


def test_masonry_is_coloured_by_cluster_and_in_source_px():
    labels = np.kron([[1, 2], [7, 7]], np.ones((4, 10), int)).astype(np.uint32)
    panel = TracedWall(replace(PR, scale=0.2), labels, {1: 2, 7: 1}).panel("masons", labels)
    (ax,) = pictures.sheet_of([panel], 1).axes
    colours = {p.get_gid(): p.get_facecolor() for p in ax.patches if p.get_gid() != "ground"}
    expected = {"stone-1": cluster_colour(2), "stone-2": PLAIN_COLOUR, "stone-7": cluster_colour(1)}
    assert {gid: to_hex(colour) for gid, colour in colours.items()} == expected
    seven = next(p for p in ax.patches if p.get_gid() == "stone-7").get_path().vertices
    assert seven.max(axis=0).tolist() == [100.0, 20.0]
