"""Figures of a benchmark by version."""

from drystone_lab.pictures.charts import plot_history


def test_versions_without_a_value_have_no_point():
    ax = plot_history(["1", "2", "3"], {"paper": [0.5, None, 0.7]}, figure="F_SF")
    (line,) = ax.lines
    assert line.get_xdata().tolist() == [0, 2]
    assert line.get_ydata().tolist() == [0.5, 0.7]
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ["1", "2", "3"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("version", "F_SF")
