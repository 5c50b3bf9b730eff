"""Pictures of what fails: the colours, the dashes, and what must be in view."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.drawing import save
from drystone.drawing.palette import PALE
from drystone.drawing.pictures.check import (
    COMMON,
    CONCERNED,
    PLANNED,
    PLANNED_PALE,
    FailureView,
    plot_failure,
    plot_failures,
)
from tests.drawing.pictures.test_stones import numbers, patches

SQUARE = np.array([[0, 0], [20, 0], [20, 20], [0, 20]], float)


def at(x, y):
    """The square, its lower left corner somewhere else."""
    return SQUARE + np.array([x, y])


PLANNED_BLOCKS = {3: SQUARE, 5: at(20, 0), 8: at(10, 20)}
FALLEN = {3: at(0, -0.05), 5: at(21, 0), 8: at(55, 0)}
VIEW = FailureView("8 falls", PLANNED_BLOCKS, (8,), FALLEN, size=(60.0, 50.0))


def vertices(patch):
    return patch.get_path().vertices[:4]


def meanings(ax):
    legend = ax.get_legend()
    return [text.get_text() for text in legend.get_texts()] if legend else []


def test_blocks_are_drawn_where_they_ended():
    ax = plot_failure(VIEW)
    drawn = patches(ax)
    assert ax.get_title(loc="left") == "8 falls"
    for block, corners in FALLEN.items():
        np.testing.assert_allclose(vertices(drawn[f"block-{block}"]), corners)
    colours = {b: to_hex(drawn[f"block-{b}"].get_facecolor()) for b in FALLEN}
    assert colours == {3: PALE, 5: PALE, 8: CONCERNED}


def test_dashes_show_where_those_that_moved_were_planned():
    drawn = patches(plot_failure(VIEW))
    assert "planned-3" not in drawn  # it has hardly moved
    np.testing.assert_allclose(vertices(drawn["planned-8"]), PLANNED_BLOCKS[8])
    assert to_hex(drawn["planned-8"].get_edgecolor()) == PLANNED
    assert to_hex(drawn["planned-5"].get_edgecolor()) == PLANNED_PALE
    assert drawn["planned-8"].get_linestyle() not in ("-", "solid")
    assert not drawn["planned-8"].get_fill() or drawn["planned-8"].get_facecolor()[3] == 0


def test_blocks_without_an_end_are_where_they_were_planned():
    drawn = patches(plot_failure(FailureView("", PLANNED_BLOCKS, (5,))))
    np.testing.assert_allclose(vertices(drawn["block-8"]), PLANNED_BLOCKS[8])
    assert not [gid for gid in drawn if gid.startswith("planned-")]


def test_what_fails_lies_over_the_others_and_hides_their_numbers():
    ax = plot_failure(VIEW)
    drawn, written = patches(ax), numbers(ax)
    assert set(written) == {"3", "5", "8"}
    over = drawn["block-8"].get_zorder()
    assert over > max(drawn["block-3"].get_zorder(), drawn["block-5"].get_zorder())
    assert written["3"].get_zorder() < over < written["8"].get_zorder()


def test_areas_claimed_by_two_are_shown():
    area = np.array([[5, 5], [9, 5], [9, 9]], float)
    ax = plot_failure(FailureView("", PLANNED_BLOCKS, (3,), common=[area, area + 20]))
    drawn = patches(ax)
    assert to_hex(drawn["common-0"].get_facecolor()) == COMMON
    np.testing.assert_allclose(drawn["common-1"].get_path().vertices[:3], area + 20)
    assert drawn["common-0"].get_zorder() > drawn["block-3"].get_zorder()


def test_everything_is_in_view():
    for view in (VIEW, FailureView("", PLANNED_BLOCKS, ended={3: at(0, -9)})):
        x0, y0, x1, y1 = view.box
        for corners in (
            *view.planned.values(),
            *view.ended.values(),
            [(0, 0), view.size or (0, 0)],
        ):
            inside = np.asarray(corners)
            assert (inside > (x0, y0)).all()
            assert (inside < (x1, y1)).all()
        ax = plot_failure(view)
        assert ax.get_xlim() == (x0, x1)
        assert ax.get_ylim() == (y0, y1)


def test_only_what_is_there_is_explained():
    assert meanings(plot_failure(VIEW)) == [
        "fails", "where it was planned", "wall that was to be built"
    ]  # fmt: skip
    plain = FailureView("", PLANNED_BLOCKS)
    assert meanings(plot_failure(plain)) == []
    overlapping = FailureView("", PLANNED_BLOCKS, (3,), common=[SQUARE])
    assert meanings(plot_failure(overlapping)) == ["fails", "claimed by two"]


@pytest.mark.parametrize("count", [1, 3])
def test_views_stand_under_each_other(count, tmp_path):
    figure = plot_failures([VIEW] * count)
    assert len(figure.axes) == count
    places = [ax.get_position() for ax in figure.axes]
    for above, below in pairwise(places):
        assert above.y0 > below.y1
    assert places[0].y1 < 1
    assert places[-1].y0 > 0
    save(figure, tmp_path / "check.png", dpi=40)
    assert (tmp_path / "check.png").stat().st_size > 1000
