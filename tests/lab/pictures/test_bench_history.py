"""Figures of a benchmark by version."""

import numpy as np

from drystone.drawing.palette import rgb
from drystone_lab.pictures.charts import LOOKS, plot_history


def test_versions_without_a_value_have_no_point():
    ax = plot_history(["1", "2", "3"], {"paper": [0.5, None, 0.7]}, figure="F_SF")
    (line,) = ax.lines
    assert line.get_xdata().tolist() == [0, 2]
    assert line.get_ydata().tolist() == [0.5, 0.7]
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["1", "2", "3"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("version", "F_SF")


def test_methods_look_different():
    lines = {str(number): [float(number)] for number in range(len(LOOKS) + 2)}
    drawn = plot_history(["1"], lines).lines
    looks = {(line.get_color(), line.get_marker(), line.get_linestyle()) for line in drawn}
    assert len(looks) == len(lines)
    colours = [np.array(rgb(colour)) for colour, _ in LOOKS]
    gaps = [np.abs(a - b).max() for i, a in enumerate(colours) for b in colours[:i]]
    assert min(gaps) > 0.1
