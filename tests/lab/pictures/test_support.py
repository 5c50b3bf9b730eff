import numpy as np
import pytest
from matplotlib.figure import Figure

from drystone.model.placement import Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.stabilise.support import Support
from drystone_lab.reproduce.fig9 import SupportedStone, plot_standing

LABELS = np.zeros((10, 20), np.uint32)
LABELS[6:, :8] = 1
MASK = np.ones((3, 12), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (6.0, 1.5))
TRIAL = SupportedStone((POSED, 3, 4), Support(4, 8, 6, 6), 1, (), 10)
WEDGE = Wedge(10, 9, np.ones((4, 2), bool), 6, 13)
WEDGED = SupportedStone((POSED, 3, 4), Support(4, 15, 6, 6), 0, (WEDGE,), 10)


def lines(ax):
    return {line.get_gid(): line.get_xydata().tolist() for line in ax.lines}


def test_a_is_the_nearer_end_and_the_sign_is_that_of_the_fall():
    assert TRIAL.ends == ((8.0, 4.0), (4.0, 4.0))
    assert TRIAL.mass == (10.0, 5.5)
    # AB = (-4, 0), AC = (2, 1.5): clockwise, to the right.
    assert TRIAL.cross == pytest.approx(-6.0)


def test_points_of_a_stone_that_falls():
    ax = Figure().add_subplot()
    plot_standing(ax, LABELS, TRIAL, (0, 0, 20, 10))
    drawn = lines(ax)
    assert drawn["AB"] == [[8, 4], [4, 4]]
    assert drawn["C"] == [[10, 5.5]]
    assert drawn["C'"] == [[10, 4]]
    gids = [patch.get_gid() for patch in ax.patches]
    assert "turn" in gids
    assert "supported" not in gids


def test_a_wedge_has_its_sizes_and_leaves_the_supported_side_alone():
    ax = Figure().add_subplot()
    plot_standing(ax, LABELS, WEDGED, (0, 0, 20, 10), before=TRIAL)
    patches = {patch.get_gid(): patch for patch in ax.patches}
    assert "turn" not in patches
    box = patches["wedge-10"].get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (13, 0, 15, 4)
    assert patches["supported"].get_bbox().bounds == (4, 4, 4, 3)
    assert "h 4, w 2" in [text.get_text() for text in ax.texts]
