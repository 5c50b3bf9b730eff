import subprocess
import sys

import numpy as np
import pytest

from drystone.errors import UsageError
from drystone.io.published import SETS
from drystone_lab.cells import COLUMNS, figures_of, summary, trend, wins
from drystone_lab.reproduce.item import PaperItem, sentences
from drystone_lab.reproduce.items import ALSO, ITEMS, item_named, item_names
from tests.lab.reproduce.small_walls import outcome


@pytest.mark.parametrize("name", ITEMS)
def test_an_item_says_what_it_is(name):
    item = item_named(name)
    assert isinstance(item, PaperItem)
    assert item.words is ITEMS[name]
    assert item.words["title"].strip() == item.words["title"] != ""
    assert item.words["section"].removeprefix("§")[0] in "23456B"
    assert item.words["paper"]
    published = {file.name for one in SETS.values() for file in one.files}
    assert {*item.words.get("needs", ())} <= published
    tables = item.words.get("tables", {})
    worded = {name for name in tables if {*tables[name]} & {"medians", "walls", "pairs"}}
    assert {*item.tables} | worded == {*tables}
    assert not {*item.tables} & worded
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
    lines = done.stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(ITEMS)
    assert all(ITEMS[line.split()[0]]["listed"] in line for line in lines)


def test_medians_and_ranges():
    walls = [
        outcome(placed=8, F_SF=0.7, F_LR=None),
        outcome(placed=10, F_SF=0.9, F_LR=0.25),
        outcome(placed=9, F_SF=0.7500049, F_LR=0.75),
    ]
    cells = dict(zip(COLUMNS, summary(walls), strict=True))
    assert (cells["walls"], cells["stones"], cells["F_AV median"]) == (3, 10, 1.0)
    none = dict(zip(COLUMNS, summary([outcome(F_LR=None)] * 2), strict=True))
    for found, name, middle, span in (
        (cells, "placed", 9, "8 to 10"),
        (cells, "F_SF", 0.75, "0.700 to 0.900"),
        (cells, "F_LR", 0.5, "0.25 to 0.75"),
        (none, "F_LR", None, None),
    ):
        assert (found[f"{name} median"], found[f"{name} range"]) == (middle, span)
    assert figures_of(walls, "F_LR") == [0.25, 0.75]


@pytest.mark.parametrize("figure", ["F_SF", "F_AH"])
def test_counts_are_those_of_all_pairs(figure):
    rng = np.random.default_rng(4)
    first, second = rng.integers(0, 4, (2, 40)).astype(float)
    more, less = int((first > second).sum()), int((first < second).sum())
    found = wins(list(first), list(second), figure)
    better, worse = (less, more) if figure == "F_AH" else (more, less)
    assert found == (figure, better, 40 - better - worse, worse, np.median(first - second))
    # What is missing makes no pair.
    assert wins([None, 1.0], [2.0, None], "F_LR") == ("F_LR", 0, 0, 0, None)
    assert wins([0.5, 0.5], [0.5 + 1e-12, None], "F_LR")[2] == 1


def test_a_trend_is_the_correlation_of_the_ranks():
    rng = np.random.default_rng(3)
    x = np.repeat([10, 20, 30, 40], 3)
    y = np.round(x / 40 + rng.normal(0, 0.3, 12), 1)
    ranks = [(v[:, None] > v).sum(axis=1) + ((v[:, None] == v).sum(axis=1) + 1) / 2 for v in (x, y)]
    found = trend(list(zip(x.tolist(), y.tolist(), strict=True)))
    assert found.rho == pytest.approx(np.corrcoef(*ranks)[0, 1], abs=1e-6)
    falling = trend([(n, -n) for n in range(8)])
    mixed = trend(list(enumerate([3.0, 1.0, 4.0, 1.0, 5.0, 2.0, 6.0, 0.0])))
    assert (falling.rho, falling.clear, mixed.clear) == (-1, True, False)
    # There is none of few or equal values.
    assert trend([(1, 1.0), (2, 2.0), (3, 3.0), (4, None)]) is None
    assert trend([(n, 1.0) for n in range(9)]) is None
    assert trend([(1, float(n)) for n in range(9)]) is None


def test_claims_that_cannot_be_told_do_not_count():
    found = [("A.", "one", True), ("B.", "two", False), ("C.", "three", None)]
    told = sentences(found)
    assert told[0] == "Of 2 claims of the paper that can be told, 1 agree."
    assert [one.split(":")[0] for one in told[1:]] == ["Agrees", "Differs", "Cannot be told"]
