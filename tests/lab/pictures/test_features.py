import numpy as np
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drystone.drawing.palette import cluster_colour
from drystone_lab.reproduce.fig5 import plot_features

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
