import numpy as np

from drystone.contacts.blocks import model_from_labels
from drystone_lab.reproduce.fig12 import NORMAL_PX, plot_blocks, plot_boundary_edges

LABELS = np.repeat(np.array([[0, 7, 7], [3, 3, 5]], np.uint32), 4, axis=0).repeat(4, axis=1)


def test_normals_are_to_the_left_of_the_way():
    starts, ends = np.array([[4.0, 4.0], [8.0, 0.0]]), np.array([[5.0, 4.0], [8.0, 1.0]])
    ax = plot_boundary_edges(LABELS, starts, ends)
    lines = {one.get_gid(): one.get_segments() for one in ax.collections}
    np.testing.assert_allclose(lines["edges"], np.stack([starts, ends], axis=1))
    ups = [[[4.5, 4.0], [4.5, 4.0 + NORMAL_PX]], [[8.0, 0.5], [8.0 - NORMAL_PX, 0.5]]]
    np.testing.assert_allclose(lines["normals"], ups)


def test_triangles_are_centres_of_mass():
    model = model_from_labels(LABELS).model
    ax = plot_blocks(LABELS, model)
    centres = {
        line.get_gid(): line.get_xydata().tolist()[0]
        for line in ax.lines if str(line.get_gid()).startswith("centre-")
    }  # fmt: skip
    assert centres == {"centre-3": [4, 2], "centre-5": [10, 2], "centre-7": [8, 6]}
