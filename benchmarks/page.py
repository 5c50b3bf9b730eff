"""Write measured tables into a page of the documents."""

import re
from collections.abc import Mapping
from pathlib import Path

from benchmarks import growth
from drystone_lab.table import Table

TABLE = re.compile(r"<!-- table (\w+) -->\n(.*?)<!-- end -->", re.DOTALL)


def rewritten(text: str, tables: Mapping[str, Table]) -> str:
    r"""Return a page with every marked table as it was measured.

    Examples
    --------
    >>> page = "<!-- table one -->\nold\n<!-- end -->"
    >>> print(rewritten(page, {"one": Table("One", ("a",), ((1,),))}))
    <!-- table one -->
    **One**
    <BLANKLINE>
    | a |
    | --- |
    | 1 |
    <!-- end -->
    """
    return TABLE.sub(
        lambda m: f"<!-- table {m[1]} -->\n{tables[m[1]].markdown()}\n<!-- end -->", text
    )


def write_page(page: Path, tables: Mapping[str, Table]) -> None:
    """Write all tables of a page anew."""
    every = {**tables, "larger": growth.larger_walls(seed=1)}
    text = page.read_text(encoding="utf-8")
    page.write_text(rewritten(text, every), encoding="utf-8")
