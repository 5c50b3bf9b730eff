"""Every item of the paper that is there is an item; nothing is run."""

import subprocess
import sys

import pytest

from drystone.errors import UsageError
from drystone.io.published import SETS
from drystone_lab.reproduce.item import PaperItem
from drystone_lab.reproduce.items import ALSO, ITEMS, item_named, item_names

PUBLISHED = {file.name for published in SETS.values() for file in published.files}


@pytest.mark.parametrize("name", ITEMS)
def test_an_item_says_what_it_is(name):
    item = item_named(name)
    assert isinstance(item, PaperItem)
    assert item.words is ITEMS[name]
    assert item.words["title"].strip() == item.words["title"] != ""
    assert item.words["section"].removeprefix("§")[0] in "23456B"
    assert item.words["paper"]
    assert {*item.needs} <= PUBLISHED
    assert {*item.tables} == {*item.words.get("tables", {})}
    assert {*item.times} == {*item.words.get("times", {})} - {"claims"}
    # Times have files of their own, whose names no table has.
    assert not any(table.endswith("_times") for table in (*item.tables, *item.times))


def test_names():
    assert item_names("all") == tuple(ITEMS)
    assert {*ALSO.values()} <= {*ITEMS}
    assert not {*ALSO} & {*ITEMS}
    assert item_names("fig23") == ("fig22-24",)
    with pytest.raises(UsageError, match="E138"):
        item_names("fig99")


def test_names_are_there_without_waiting():
    code = (
        "import sys\n"
        "from drystone.cli import main\n"
        "main(['reproduce', '--list'])\n"
        "heavy = {'numpy', 'scipy', 'matplotlib', 'jinja2'} & set(sys.modules)\n"
        "sys.exit(f'loaded: {heavy}' if heavy else 0)\n"
    )
    done = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert [line.split()[0] for line in done.stdout.splitlines()] == list(ITEMS)
