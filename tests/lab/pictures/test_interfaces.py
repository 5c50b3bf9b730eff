import numpy as np
from matplotlib.figure import Figure

from drystone_lab.reproduce.fig12 import NORMAL_PX, plot_boundary_edges

LABELS = np.repeat(np.array([[0, 7, 7], [3, 3, 5]], np.uint32), 4, axis=0).repeat(4, axis=1)


def test_normals_are_to_the_left_of_the_way():
    starts, ends = np.array([[4.0, 4.0], [8.0, 0.0]]), np.array([[5.0, 4.0], [8.0, 1.0]])
    ax = Figure().add_subplot()
    plot_boundary_edges(ax, LABELS, starts, ends)
    lines = {one.get_gid(): one.get_segments() for one in ax.collections}
    np.testing.assert_allclose(lines["edges"], np.stack([starts, ends], axis=1))
    ups = [[[4.5, 4.0], [4.5, 4.0 + NORMAL_PX]], [[8.0, 0.5], [8.0 - NORMAL_PX, 0.5]]]
    np.testing.assert_allclose(lines["normals"], ups)
