"""Pictures of what masons' rules find."""

import numpy as np
import pytest
from matplotlib.patches import PathPatch
from PIL import Image

from drystone.craft import RULES, Masonry, look
from drystone.drawing.files import save
from drystone.drawing.pictures.craft import BESIDE, FAULT, plot_craft, plot_finding
from tests.craft.walls import box, courses, stack_bond
from tests.drawing.pictures.test_contacts import lines


def hatched(ax):
    """Stones that are found, by hatch."""
    found = [patch for patch in ax.patches if (patch.get_gid() or "").startswith("found-")]
    return {int(patch.get_gid().split("-")[1]): patch.get_hatch() for patch in found}


def test_stones_at_fault_have_colour_and_hatch():
    loops = courses([[2.0] * 4]) | {9: box(2, 1, 1, 2)}
    ax = plot_finding(look(Masonry(loops)), "on_end")
    assert hatched(ax) == {9: FAULT.hatch}
    stone = next(patch for patch in ax.patches if patch.get_gid() == "stone-9")
    assert isinstance(stone, PathPatch)
    assert stone.get_facecolor()[:3] == pytest.approx(
        tuple(int(FAULT.fill[k : k + 2], 16) / 255 for k in (1, 3, 5))
    )
    (mark,) = lines(ax, "mark-on_end")
    assert np.ptp(mark[:, 0]) == pytest.approx(0.0, abs=1e-9)


def test_a_running_joint_is_a_line_between_hatched_stones():
    ax = plot_finding(look(Masonry(stack_bond(2, 3))), "running_joints")
    assert hatched(ax) == dict.fromkeys(range(1, 7), BESIDE.hatch)
    (mark,) = lines(ax, "mark-running_joints")
    assert mark[:, 0] == pytest.approx(2.0)
    assert (mark[:, 1].min(), mark[:, 1].max()) == pytest.approx((0.0, 3.0), abs=0.05)


def test_numbers_are_steps_of_a_plan():
    steps = {i: 40 + i for i in stack_bond(2, 2)}
    ax = plot_finding(look(Masonry(stack_bond(2, 2), steps=steps)), "laps")
    assert sorted(text.get_text() for text in ax.texts) == ["41", "42", "43", "44"]
    assert "not judged" in ax.get_title("left")


def test_the_title_has_number_verdict_and_limits():
    ax = plot_finding(look(Masonry(stack_bond(2, 3))), "running_joints")
    title = ax.get_title("left")
    assert "running joints: broken, 3 courses" in title
    assert "good ≤ 1, fair ≤ 2" in title


def test_the_sheet_has_a_panel_for_every_rule(tmp_path):
    figure = plot_craft(look(Masonry(stack_bond(2, 2), wedge_ids={4})))
    titles = [ax.get_title("left") for ax in figure.axes]
    assert len(titles) == len(RULES)
    for rule, title in zip(RULES.values(), titles, strict=True):
        assert rule.title in title
    save(figure, tmp_path / "sheet.png", dpi=40)
    with Image.open(tmp_path / "sheet.png") as sheet:
        assert sheet.width == pytest.approx(40 * 12.45, abs=20)


@pytest.mark.parametrize("loops", [{}, {1: box(0, 0, 1, 30)}])
def test_next_to_nothing_can_be_drawn(loops, tmp_path):
    save(plot_craft(look(Masonry(loops))), tmp_path / "sheet.png", dpi=40)
