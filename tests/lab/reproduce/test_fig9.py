import math

import numpy as np
import pytest
from matplotlib.figure import Figure

from drystone.model.placement import Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.stabilise.stabilise import Support
from drystone_lab.reproduce import fig9
from drystone_lab.reproduce.fig9 import unstable_trials
from tests.lab.reproduce.small_walls import SHARP, built, gids, of, rows
from tests.naive.support import rests_stably

MADE = of("fig9", SHARP)


@pytest.fixture(scope="module")
def run(folder):
    return built(folder, SHARP)


@pytest.fixture(scope="module")
def found(run):
    return unstable_trials(run)


def falls(occupied, pose):
    posed, row, col = pose
    under = occupied[row : row + posed.height_px, col : col + posed.width_px]
    assert not np.any(under & posed.mask)
    return not rests_stably(occupied, posed.mask, row, col, col + posed.anchor[0], 0.0)


def test_every_stone_that_is_left_is_tried_and_those_that_fall_are_found(run, found):
    tried = [
        (moment, stone_id, trial)
        for moment in run.moments
        for stone_id in moment.remaining
        if (trial := moment.trial(stone_id)) is not None
    ]
    assert found[0] == len(tried)
    assert [(one.moment.number, one.stone_id) for one in found[1]] == [
        (moment.number, stone_id)
        for moment, stone_id, trial in tried
        if falls(moment.wall.occupied, trial)
    ]


def test_turned_and_wedged_stones_rest(found):
    turned, wedged = 0, 0
    for case in found[1]:
        occupied = case.moment.wall.occupied
        if case.turned is not None:
            assert not falls(occupied, case.turned.pose)
            first, last = (one.pose[0].angle_deg for one in (case.trial, case.turned))
            assert math.remainder(case.turn_deg - (last - first), 360) == 0
            # It turns to the side to which it falls.
            assert (case.turn_deg < 0) == (case.trial.falls > 0)
            turned += 1
        if case.wedged is not None:
            scene = occupied.copy()
            for wedge in case.wedged.wedges:
                assert not np.any(scene[wedge.window] & wedge.mask)
                scene[wedge.window] |= wedge.mask
            assert not falls(scene, case.wedged.pose)
            assert case.wedged.pose == case.trial.pose
            wedged += 1
    assert min(turned, wedged) > 5


def test_counts_add_up(output, found):
    count = {row["what"]: row["count"] for row in rows(output, "counts")}
    trials, unstable = found
    assert (count["tried"], count["not stable"]) == (trials, len(unstable))
    ends = ("stable after turning", "turning fails, a wedge does", "neither")
    assert sum(count[end] for end in ends) == len(unstable)
    wrong = [one for one in unstable if not one.sign_agrees]
    assert count["sign of AB x AC is wrong"] == len(wrong)


def test_the_cases_drawn_are_the_most_turned_and_the_largest_wedge(output, found):
    table = rows(output, "cases")
    assert [row["pose"] for row in table] == ["tried", "turned", "wedged", "tried", "wedged"]
    wide = [
        case for case in found[1]
        if case.turned is not None and case.wedged is not None
        and case.trial.support.right_x - case.trial.support.left_x
        >= fig9.WIDE * case.trial.pose[0].width_px
    ]  # fmt: skip
    assert abs(table[1]["turned deg"]) == max(abs(case.turn_deg) for case in wide)
    for row in table:
        assert (row["wedge height px"] is None) == (row["pose"] != "wedged")
    drawn = gids(output, "fig9")
    assert [drawn.count(gid) for gid in ("stone", "AB", "C", "C'")] == [5, 5, 5, 5]
    assert (drawn.count("turn"), drawn.count("before"), drawn.count("supported")) == (2, 1, 2)
    assert sum(gid.startswith("wedge-") for gid in drawn) >= 2


STEP = np.zeros((10, 20), np.uint32)
STEP[6:, :8] = 1
SLAB = np.ones((3, 12), bool)
LYING = PosedStone(Stone(9, SLAB), 0.0, 1.0, SLAB, (6.0, 1.5))
TRIAL = fig9.SupportedStone((LYING, 3, 4), Support(4, 8, 6, 6), 1, (), 10)
WEDGE = Wedge(10, 9, np.ones((4, 2), bool), 6, 13)
WEDGED = fig9.SupportedStone((LYING, 3, 4), Support(4, 15, 6, 6), 0, (WEDGE,), 10)


def test_points_of_a_stone_that_falls_and_sizes_of_the_wedge_that_holds_it():
    ax, held = Figure().subplots(1, 2)
    fig9.plot_standing(ax, STEP, TRIAL, (0, 0, 20, 10))
    drawn = {line.get_gid(): line.get_xydata().tolist() for line in ax.lines}
    assert (drawn["AB"], drawn["C"], drawn["C'"]) == ([[8, 4], [4, 4]], [[10, 5.5]], [[10, 4]])
    # AB = (-4, 0), AC = (2, 1.5): clockwise, to the right.
    assert TRIAL.cross == pytest.approx(-6.0)
    gids = {patch.get_gid() for patch in ax.patches}
    assert ("turn" in gids, "supported" in gids) == (True, False)
    fig9.plot_standing(held, STEP, WEDGED, (0, 0, 20, 10), before=TRIAL)
    patches = {patch.get_gid(): patch for patch in held.patches}
    assert "turn" not in patches
    box = patches["wedge-10"].get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (13, 0, 15, 4)
    assert patches["supported"].get_bbox().bounds == (4, 4, 4, 3)
    assert "h 4, w 2" in [text.get_text() for text in held.texts]
