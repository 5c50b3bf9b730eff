import numpy as np
import pytest
from matplotlib.colors import to_hex

from drystone.model.landscape import Box
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone_lab.reproduce import fig6_7 as drawing
from drystone_lab.reproduce.fig6_7 import ActionView, plot_action

LABELS = np.zeros((10, 20), np.uint32)
LABELS[6:, :6] = 1
LABELS[6:, 6:12] = 2
LABELS[2:6, :5] = 3
MASK = np.ones((3, 4), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (2.0, 1.5))
SWEPT = np.zeros((10, 20), bool)
SWEPT[3:6, :5] = SWEPT[6:, 5:9] = True


@pytest.fixture
def action():
    return ActionView(
        LABELS, POSED, 3, 5, SWEPT, 8, (3, Box(0, 5, 4, 8)),
        ((1, Box(0, 6, 0, 4)), (2, Box(6, 12, 0, 4))), (0, 3),
    )  # fmt: skip


def fills(ax):
    return {patch.get_gid(): to_hex(patch.get_facecolor()) for patch in ax.patches}


def drawn(ax, gid):
    return [line.get_xydata().tolist() for line in ax.lines if line.get_gid() == gid]


def test_only_what_is_asked_for_is_marked(action):
    ax = plot_action(action, {"neighbour"})
    assert fills(ax)["block-3"] == drawing.NEIGHBOUR
    assert fills(ax)["block-1"] == fills(ax)["block-2"] == drawing.BUILT
    assert fills(ax)["stone"] == drawing.STONE
    assert not ax.images
    # Tops at 7 and at 8, over both stones; the difference between them.
    assert drawn(ax, "top") == [[[0, 7], [9, 7]], [[0, 8], [9, 8]]]
    assert drawn(ax, "difference") == [[[4.5, 7], [4.5, 8]]]


def test_joints_are_the_top_corners_of_the_stones_below(action):
    ax = plot_action(action, {"joints"})
    assert fills(ax)["block-1"] == fills(ax)["block-2"] == drawing.BELOW
    assert drawn(ax, "joint") == [[[6, 4]], [[6, 4]]]
    assert drawn(ax, "offset") == [[[5, 4], [6, 4]], [[9, 4], [6, 4]]]


def test_rays_box_and_slope(action):
    ax = plot_action(action, {"rays", "box", "begun", "slope"})
    (rays,) = ax.images
    np.testing.assert_array_equal(rays.get_array()[..., 3] > 0, SWEPT)
    patches = {patch.get_gid(): patch for patch in ax.patches}
    assert patches["box"].get_bbox().bounds == (5, 4, 4, 3)
    assert patches["begun"].get_bbox().bounds == (0, 0, 20, 8)
    assert drawn(ax, "slope") == [[[5.5, 7], [8.5, 7]]]
