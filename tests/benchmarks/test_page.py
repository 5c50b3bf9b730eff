"""The page of measured tables."""

import doctest
from pathlib import Path

import pytest

from benchmarks import page
from drystone_lab.table import Table

SPEED = Path(__file__).parents[2] / "docs" / "evidence" / "speed.md"
ONE = Table("One", ("a",), ((1,),))


def test_the_examples_run():
    assert doctest.testmod(page).failed == 0


def test_what_is_not_marked_stays():
    text = "before\n<!-- table one -->\nold\n<!-- end -->\nafter\n"
    written = page.rewritten(text, {"one": ONE})
    assert written.startswith("before\n<!-- table one -->\n**One**")
    assert written.endswith("\n<!-- end -->\nafter\n")
    assert "old" not in written
    assert page.rewritten(written, {"one": ONE}) == written
    with pytest.raises(KeyError, match="two"):  # it was not measured
        page.rewritten(text.replace("one", "two"), {"one": ONE})


def test_every_table_has_its_place():
    names = [name for name, _ in page.TABLE.findall(SPEED.read_text(encoding="utf-8"))]
    assert sorted(names) == sorted(["functions", "walls", "parts", "limits", "memory", "larger"])
