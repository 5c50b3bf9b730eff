"""Figures of many walls by group."""

from statistics import median

import pytest
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from drystone_lab.pictures.charts import group_panels, plot_groups, plot_two_figures

VALUES = {"both": [0.8, 0.7, 0.9, 0.75, 0.72, 0.71], "none": [0.5, None, 0.4], "empty": [None]}


def _line(ax: Axes, gid: str) -> Line2D:
    (line,) = [line for line in ax.lines if line.get_gid() == gid]
    return line


def test_points_are_the_values_and_lines_their_medians() -> None:
    ax = plot_groups(VALUES, figure="F_SF")
    assert list(_line(ax, "group-both").get_ydata()) == VALUES["both"]
    assert list(_line(ax, "group-none").get_ydata()) == [0.5, 0.4]
    assert set(_line(ax, "median-both").get_ydata()) == {median(VALUES["both"])}
    assert set(_line(ax, "median-none").get_ydata()) == {0.45}
    assert [line for line in ax.lines if line.get_gid() == "median-empty"] == []
    assert [text.get_text() for text in ax.get_xticklabels()] == list(VALUES)
    assert ax.get_ylabel() == "F_SF"


def test_claims_stand_in_their_groups() -> None:
    ax = plot_groups(VALUES, claims={"none": 0.6}, claim="the paper")
    cross = _line(ax, "claim-none")
    assert (list(cross.get_xdata()), list(cross.get_ydata())) == ([1], [0.6])
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["the paper"]
    assert plot_groups(VALUES).get_legend() is None


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (4, 4), (5, 3), (8, 4), (12, 4)])
def test_panels_fill_rows(count: int, columns: int) -> None:
    figure = group_panels({f"figure {k}": VALUES for k in range(count)}, title="t")
    assert [ax.get_ylabel() for ax in figure.axes] == [f"figure {k}" for k in range(count)]
    specs = [ax.get_subplotspec() for ax in figure.axes]
    assert {spec.get_gridspec().ncols for spec in specs if spec is not None} == {columns}


def test_one_figure_over_another() -> None:
    pairs = {"rotation": [(1.0, 0.5), (3.0, 0.7), (2.0, 0.1)], "wedge": [(None, 0.5), (4.0, 0.6)]}
    ax = plot_two_figures(pairs, across="area", up="F_SF")
    assert [value[0] for value in _line(ax, "median-rotation").get_data()] == [2.0, 0.5]
    assert [list(value) for value in _line(ax, "group-wedge").get_data()] == [[4.0], [0.6]]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("area", "F_SF")
