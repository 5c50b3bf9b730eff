"""Walls to choose from in one picture."""

import pytest

from drystone.drawing import plot_choice
from drystone.drawing.pictures.wall import COLUMNS
from drystone.model.wall import Wall
from drystone.planner.planner import Planner
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, rubble

FIGURES = {"F_SF": 0.8, "F_AV": 20.0, "F_AH": 2.0, "F_LR": 0.5}


@pytest.fixture(scope="module")
def wall() -> Wall:
    return finish(Planner(rubble(), RUBBLE_SITE, seed=1, settings=greedy())).build.wall


@pytest.mark.parametrize("count", [1, COLUMNS, COLUMNS + 1])
def test_every_wall_has_its_picture_and_its_points(wall: Wall, count: int) -> None:
    values = [{**FIGURES, "F_SF": 0.8 + 0.01 * k} for k in range(count)]
    figure = plot_choice([wall] * count, values)
    *walls, one, two = figure.axes
    assert len(walls) == count
    blocks = len(wall.placements) + len(wall.wedges)
    assert [len(ax.patches) for ax in walls] == [blocks + 1] * count
    assert walls[0].get_title(loc="left") == "01  F_SF 0.800  F_AV 20.0  F_AH 2.00  F_LR 0.50"
    assert (one.get_xlabel(), one.get_ylabel()) == ("F_SF", "F_LR")
    assert (two.get_xlabel(), two.get_ylabel()) == ("F_AV", "F_AH")
    assert [line.get_xdata()[0] for line in one.lines] == [v["F_SF"] for v in values]
    assert [text.get_text() for text in one.texts] == [f"{k:02}" for k in range(1, count + 1)]


def test_what_is_not_defined_is_left_out(wall: Wall) -> None:
    figure = plot_choice([wall, wall], [{**FIGURES, "F_AV": None}, FIGURES])
    assert "F_AV -" in figure.axes[0].get_title(loc="left")
    assert [len(ax.lines) for ax in figure.axes[-2:]] == [2, 1]
