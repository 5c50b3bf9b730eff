import numpy as np
from matplotlib.figure import Figure

from drystone.model.pose import PosedStone
from drystone.model.stone import Stone
from drystone_lab.reproduce.fig8 import plot_position_layers, plot_position_values

LABELS = np.zeros((6, 10), np.uint32)
LABELS[4:, :5] = 1
MASK = np.ones((2, 4), bool)
POSED = PosedStone(Stone(9, MASK), 0.0, 1.0, MASK, (2.0, 1.0))


def test_a_position_is_drawn_where_the_centroid_is():
    at = np.zeros((5, 7), bool)
    at[2, 3] = True
    ax = Figure().add_subplot()
    plot_position_layers(ax, LABELS, POSED, [("here", "#d55e00", at)])
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
    plot_position_values(ax, LABELS, POSED, positions, np.array([1.0, 0.9, 0.5]), (2, 0))
    (dots,) = [one for one in ax.collections if one.get_gid() == "values"]
    np.testing.assert_allclose(dots.get_offsets(), [[2, 3], [3, 3], [7, 1]])
    np.testing.assert_allclose(dots.get_array(), [1.0, 0.9, 0.5])
    (stone,) = [patch for patch in ax.patches if patch.get_gid() == "chosen"]
    box = stone.get_path().get_extents()
    assert (box.x0, box.y0, box.x1, box.y1) == (0, 2, 4, 4)
    (best,) = [line for line in ax.lines if line.get_gid() == "best"]
    assert best.get_xydata().tolist() == [[2, 3]]
