"""What single pictures of items show: clusters, edges, positions, and stones on supports."""

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.drawing.palette import cluster_colour
from drystone.model.placement import Wedge
from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone.stabilise.support import Support
from drystone_lab.reproduce.fig5 import plot_features
from drystone_lab.reproduce.fig8 import plot_position_layers, plot_position_values
from drystone_lab.reproduce.fig9 import SupportedStone, plot_standing
from drystone_lab.reproduce.fig12 import NORMAL_PX, plot_boundary_edges

FEATURES = np.array([[0.2, 1.0], [0.8, 0.5], [0.81, 0.5]])


def test_stones_are_at_their_features_in_the_colour_of_their_cluster():
    ax = Figure().add_subplot()
    plot_features(ax, FEATURES, [3, 5, 8], {3: 1, 5: 2, 8: 2})
    lines = {line.get_gid(): line for line in ax.lines}
    assert list(lines) == ["stone-3", "stone-5", "stone-8"]
    for line, at, cluster in zip(lines.values(), FEATURES, (1, 2, 2), strict=True):
        np.testing.assert_allclose(line.get_xydata(), [at])
        assert to_hex(line.get_markerfacecolor()) == cluster_colour(cluster)
    assert lines["stone-3"].get_marker() != lines["stone-5"].get_marker()


LABELS = np.repeat(np.array([[0, 7, 7], [3, 3, 5]], np.uint32), 4, axis=0).repeat(4, axis=1)


def test_normals_are_to_the_left_of_the_way():
    starts, ends = np.array([[4.0, 4.0], [8.0, 0.0]]), np.array([[5.0, 4.0], [8.0, 1.0]])
    ax = Figure().add_subplot()
    plot_boundary_edges(ax, LABELS, starts, ends)
    lines = {one.get_gid(): one.get_segments() for one in ax.collections}
    np.testing.assert_allclose(lines["edges"], np.stack([starts, ends], axis=1))
    ups = [[[4.5, 4.0], [4.5, 4.0 + NORMAL_PX]], [[8.0, 0.5], [8.0 - NORMAL_PX, 0.5]]]
    np.testing.assert_allclose(lines["normals"], ups)


SITE = np.zeros((6, 10), np.uint32)
SITE[4:, :5] = 1
MASK = np.ones((2, 4), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (2.0, 1.0))


def test_a_position_is_drawn_where_the_centroid_is():
    at = np.zeros((5, 7), bool)
    at[2, 3] = True
    ax = Figure().add_subplot()
    plot_position_layers(ax, SITE, POSED, [("here", "#d55e00", at)])
    (image,) = ax.images
    rgba, (left, right, bottom, top) = image.get_array(), image.get_extent()
    ((row, col),) = np.argwhere(rgba[..., 3] > 0).tolist()
    x = left + (col + 0.5) * (right - left) / rgba.shape[1]
    y = top - (row + 0.5) * (top - bottom) / rgba.shape[0]
    # Columns 3 to 7, rows 2 and 3 from the top.
    assert (x, y) == (5.0, 3.0)


def test_values_are_at_the_centroids_and_the_stone_at_the_chosen_one():
    positions = np.array([[2, 0], [2, 1], [4, 5]])
    ax = Figure().add_subplot()
    plot_position_values(ax, SITE, POSED, positions, np.array([1.0, 0.9, 0.5]), (2, 0))
    (dots,) = [one for one in ax.collections if one.get_gid() == "values"]
    np.testing.assert_allclose(dots.get_offsets(), [[2, 3], [3, 3], [7, 1]])
    np.testing.assert_allclose(dots.get_array(), [1.0, 0.9, 0.5])
    (stone,) = [patch for patch in ax.patches if patch.get_gid() == "chosen"]
    box = stone.get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (0, 2, 4, 4)
    (best,) = [line for line in ax.lines if line.get_gid() == "best"]
    assert best.get_xydata().tolist() == [[2, 3]]


STEP = np.zeros((10, 20), np.uint32)
STEP[6:, :8] = 1
SLAB = np.ones((3, 12), bool)
LYING = PosedStone(Stone(9, SLAB), 0.0, 1.0, SLAB, (6.0, 1.5))
TRIAL = SupportedStone((LYING, 3, 4), Support(4, 8, 6, 6), 1, (), 10)
WEDGE = Wedge(10, 9, np.ones((4, 2), bool), 6, 13)
WEDGED = SupportedStone((LYING, 3, 4), Support(4, 15, 6, 6), 0, (WEDGE,), 10)


def lines(ax):
    return {line.get_gid(): line.get_xydata().tolist() for line in ax.lines}


def test_a_is_the_nearer_end_and_the_sign_is_that_of_the_fall():
    assert TRIAL.ends == ((8.0, 4.0), (4.0, 4.0))
    assert TRIAL.mass == (10.0, 5.5)
    # AB = (-4, 0), AC = (2, 1.5): clockwise, to the right.
    assert TRIAL.cross == pytest.approx(-6.0)


def test_points_of_a_stone_that_falls():
    ax = Figure().add_subplot()
    plot_standing(ax, STEP, TRIAL, (0, 0, 20, 10))
    drawn = lines(ax)
    assert drawn["AB"] == [[8, 4], [4, 4]]
    assert drawn["C"] == [[10, 5.5]]
    assert drawn["C'"] == [[10, 4]]
    gids = [patch.get_gid() for patch in ax.patches]
    assert "turn" in gids
    assert "supported" not in gids


def test_a_wedge_has_its_sizes_and_leaves_the_supported_side_alone():
    ax = Figure().add_subplot()
    plot_standing(ax, STEP, WEDGED, (0, 0, 20, 10), before=TRIAL)
    patches = {patch.get_gid(): patch for patch in ax.patches}
    assert "turn" not in patches
    box = patches["wedge-10"].get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (13, 0, 15, 4)
    assert patches["supported"].get_bbox().bounds == (4, 4, 4, 3)
    assert "h 4, w 2" in [text.get_text() for text in ax.texts]
