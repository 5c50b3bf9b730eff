"""What masons' rules find, and what fails."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image

from drystone.craft import RULES, Masonry, look
from drystone.drawing import save
from drystone.drawing.palette import PALE
from drystone.drawing.pictures import check
from drystone.drawing.pictures.craft import BESIDE, FAULT, plot_craft, plot_finding
from tests.craft.walls import box, courses, stack_bond
from tests.drawing.pictures.test_forces import lines
from tests.drawing.pictures.test_stones import numbers, patches
from tests.polygons import box_of


def hatched(ax):
    """Stones that are found, by hatch."""
    found = [patch for patch in ax.patches if (patch.get_gid() or "").startswith("found-")]
    return {int(patch.get_gid().split("-")[1]): patch.get_hatch() for patch in found}


def test_stones_at_fault_have_colour_and_hatch_and_lines_their_place():
    ax = plot_finding(look(Masonry(courses([[2.0] * 4]) | {9: box(2, 1, 1, 2)})), "on_end")
    assert hatched(ax) == {9: FAULT.hatch}
    assert to_hex(patches(ax)["stone-9"].get_facecolor()) == FAULT.fill
    (mark,) = lines(ax, "mark-on_end")
    assert np.ptp(mark[:, 0]) == pytest.approx(0.0, abs=1e-9)
    report = look(Masonry(stack_bond(2, 3), steps={i: 40 + i for i in range(1, 7)}))
    ax = plot_finding(report, "running_joints")
    assert hatched(ax) == dict.fromkeys(range(1, 7), BESIDE.hatch)
    (mark,) = lines(ax, "mark-running_joints")
    assert mark[:, 0] == pytest.approx(2.0)
    assert (mark[:, 1].min(), mark[:, 1].max()) == pytest.approx((0.0, 3.0), abs=0.05)
    said = "running joints: broken, 3 courses   (good ≤ 1, fair ≤ 2)"
    assert said in ax.get_title("left")
    # Numbers are the steps of a plan.
    assert sorted(numbers(ax)) == ["41", "42", "43", "44", "45", "46"]
    assert "not judged" in plot_finding(report, "laps").get_title("left")


def test_the_sheet_has_a_panel_for_every_rule(tmp_path):
    # Next to nothing can be drawn too.
    for loops in ({}, {1: box(0, 0, 1, 20), 4: box(0, 20, 1, 10)}):
        figure = plot_craft(look(Masonry(loops, wedge_ids={4} & loops.keys())))
        titles = [ax.get_title("left") for ax in figure.axes]
        assert len(titles) == len(RULES)
        for rule, title in zip(RULES.values(), titles, strict=True):
            assert rule.title in title
        save(figure, tmp_path / "sheet.png", dpi=20)
        with Image.open(tmp_path / "sheet.png") as drawn:
            assert drawn.width == pytest.approx(20 * 12.45, abs=15)


PLANNED_BLOCKS = {3: box_of(0, 0, 20), 5: box_of(20, 0, 20), 8: box_of(10, 20, 20)}
FALLEN = {3: box_of(0, -0.05, 20), 5: box_of(21, 0, 20), 8: box_of(55, 0, 20)}
VIEW = check.FailureView("8 falls", PLANNED_BLOCKS, (60.0, 50.0), (8,), FALLEN)


def test_blocks_are_drawn_where_they_ended_with_dashes_where_they_were_planned():
    ax = check.plot_failure(VIEW)
    drawn, written = patches(ax), numbers(ax)
    assert ax.get_title(loc="left") == "8 falls"
    low, high = np.transpose([ax.get_xlim(), ax.get_ylim()])
    for block, corners in FALLEN.items():
        np.testing.assert_allclose(drawn[f"block-{block}"].get_path().vertices[:4], corners)
        assert ((low < corners) & (corners < high)).all()
    colours = {b: to_hex(drawn[f"block-{b}"].get_facecolor()) for b in FALLEN}
    assert colours == {3: PALE, 5: PALE, 8: check.CONCERNED}
    # Block 3 has hardly moved.
    planned = {gid: patch for gid, patch in drawn.items() if gid.startswith("planned-")}
    edges = {gid: to_hex(patch.get_edgecolor()) for gid, patch in planned.items()}
    assert edges == {"planned-5": check.PLANNED_PALE, "planned-8": check.PLANNED}
    np.testing.assert_allclose(planned["planned-8"].get_path().vertices[:4], PLANNED_BLOCKS[8])
    # What fails lies over the others and hides their numbers.
    over = drawn["block-8"].get_zorder()
    assert over > max(drawn["block-3"].get_zorder(), drawn["block-5"].get_zorder())
    assert written["3"].get_zorder() < over < written["8"].get_zorder()


def test_areas_claimed_by_two_are_shown_what_is_there_explained_and_views_one_under_another():
    area = np.array([[5, 5], [9, 5], [9, 9]], float)
    view = check.FailureView("", PLANNED_BLOCKS, (60.0, 50.0), (3,), common=[area, area + 20])
    ax = check.plot_failure(view)
    drawn = patches(ax)
    assert to_hex(drawn["common-0"].get_facecolor()) == check.COMMON
    np.testing.assert_allclose(drawn["common-1"].get_path().vertices[:3], area + 20)
    assert drawn["common-0"].get_zorder() > drawn["block-3"].get_zorder()
    # Those without an end are where they were planned.
    np.testing.assert_allclose(drawn["block-8"].get_path().vertices[:4], PLANNED_BLOCKS[8])
    explained = [text.get_text() for text in ax.get_legend().get_texts()]
    assert explained == ["fails", "claimed by two", "wall that was to be built"]
    asked = ["fails", "where it was planned", "wall that was to be built"]
    legend = check.plot_failure(VIEW).get_legend()
    assert [text.get_text() for text in legend.get_texts()] == asked
    for count in (1, 3):
        places = [ax.get_position() for ax in check.plot_failures([VIEW] * count).axes]
        assert len(places) == count
        heights = [1.0, *(y for place in places for y in (place.y1, place.y0)), 0.0]
        assert all(above > below for above, below in pairwise(heights))
