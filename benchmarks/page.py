"""Write measured tables into a page of the documents."""

import re
from collections.abc import Mapping
from pathlib import Path

from benchmarks import growth
from benchmarks.scenes import data_folder
from drystone_lab.table import BenchSettings, Table

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


def growth_tables(images: Path) -> dict[str, Table]:
    """Plan walls by the clock, with pictures; return the tables by their names in the page."""
    found = growth.run(BenchSettings(data=data_folder(), output=images, seed=1))
    return dict(zip(("pixels", "steps", "larger"), found, strict=True))


def write_page(page: Path, tables: Mapping[str, Table]) -> None:
    """Write all tables of a page anew, and the pictures beside it."""
    every = {**tables, **growth_tables(page.parent / "images")}
    text = page.read_text(encoding="utf-8")
    page.write_text(rewritten(text, every), encoding="utf-8")
