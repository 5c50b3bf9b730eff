import numpy as np

from drystone.drawing import plot_joint_paths
from tests.drawing import examples
from tests.drawing.pictures.test_stones import patches


def test_paths_run_through_the_centres_of_their_pixels():
    labels = examples.wall().labels
    down = np.array([[-1, 13], [0, 13], [1, 14], [19, 14]])
    across = np.array([[11, 0], [11, 43]])
    ax = plot_joint_paths(labels, [down, across])
    lines = {line.get_gid(): line.get_segments()[0] for line in ax.collections}
    np.testing.assert_allclose(
        lines["path-1"], [[13.5, 20.5], [13.5, 19.5], [14.5, 18.5], [14.5, 0.5]]
    )
    np.testing.assert_allclose(lines["path-2"], [[0.5, 8.5], [43.5, 8.5]])
    assert set(patches(ax)) == {f"block-{i}" for i in np.unique(labels) if i}


def test_no_path_leaves_the_stones():
    ax = plot_joint_paths(examples.wall().labels, [])
    assert not ax.collections
    assert len(ax.patches) == 6
