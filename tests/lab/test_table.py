"""Tables for a terminal."""

from drystone_lab.table import Table


def test_zero_has_no_sign():
    table = Table("Differences", ("case", "difference"), (("one", -0.0), ("two", -0.5)))
    assert table.text().splitlines()[2:] == ["one            0", "two         -0.5"]
    assert "| one | 0 |" in table.markdown()
