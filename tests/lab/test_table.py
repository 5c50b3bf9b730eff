"""Tables for a terminal and for other programs."""

from drystone_lab.table import Table


def test_cells_of_all_kinds_and_zero_without_a_sign():
    table = Table("Differences", ("case", "difference"), (("one", -0.0), ("two", -0.5)))
    assert table.text().splitlines()[2:] == ["one            0", "two         -0.5"]
    assert "| one | 0 |" in table.markdown()
    np_float = type("float64", (float,), {"__repr__": lambda _: "np.float64(1.5)"})
    table = Table("x", ("a", "b"), ((True, np_float(1.5)), ('say "a, b"', 0.1 + 0.2), (None, 3)))
    assert table.csv() == 'a,b\nyes,1.5\n"say ""a, b""",0.30000000000000004\n,3\n'
