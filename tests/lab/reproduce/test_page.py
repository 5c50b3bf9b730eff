"""The report of the paper's tables and figures."""

import pytest

from drystone_lab.reproduce.page import LONG, duration, heading, write_item_page, write_page
from drystone_lab.table import written
from tests.drawing.report.test_report import Page

ORDER = ("fig5", "fig13", "table2")


def table(name, rows):
    return {
        "name": name, "file": f"{name}.csv", "title": f"Table of {name}",
        "columns": ["wall", "F_SF <share>"], "rows": [["R", 0.123456789 + k] for k in range(rows)],
        "notes": ["A note & more."],
    }  # fmt: skip


def record(name, *, quick=False, seed=1):
    return {
        "name": name, "title": "walls <of> stones", "section": "§5.1",
        "request": {"version": "9.8", "quick": quick, "seed": seed},
        "made": {
            "date": f"2026-01-0{seed} 10:00 UTC", "machine": "Linux x86_64, 2 cores",
            "python": "3.11.7", "kernels": "compiled", "packages": {"numpy": "2.4"},
        },
        "taken": {"seconds": 1.0, "walls": 20, "wall_seconds": 90.0},
        "paper": ["F_SF is .88 & more."], "ours": ["It is .89 here."],
        "tables": [table("short", 2), table("long", LONG + 1)], "times": [table("t_times", 1)],
        "pictures": [
            {"name": "p", "png": "p.png", "svg": "p.svg", "width_px": 1000, "height_px": 500,
             "caption": "Walls of 'R'."},
        ],
    }  # fmt: skip


@pytest.fixture
def page(tmp_path):
    records = [record("table2", quick=True, seed=3), record("fig5")]
    misses = {"fig13": {"title": "masons", "section": "§5.1", "error": "E100 R.png: is not there."}}
    path = write_page(tmp_path / "index.html", records, misses, ORDER)
    return Page(path.read_text(encoding="utf-8"))


def test_it_reads_in_the_order_of_the_paper(page):
    heads = [attributes["id"] for attributes in page.all("h2") if "id" in attributes]
    assert heads == ["contents", *ORDER]
    links = [attributes["href"] for attributes in page.all("a")]
    assert links[:3] == [f"#{name}" for name in ORDER]
    assert "Fig. 5: walls <of> stones" in page.text
    assert "F_SF is .88 & more." in page.text
    assert page.text.index("In the paper") < page.text.index("It is .89 here.")


def test_it_says_what_it_was_made_with(page):
    assert (
        "2 of 3 were made, 1 as quick versions and 1 in full, with drystone 9.8, "
        "2026-01-01 to 2026-01-03, on Linux x86_64, 2 cores." in page.text
    )
    assert "20 walls planned in 1 min 30 s" in page.text
    assert "40 in 3 min 0 s" in page.text
    assert "E100 R.png: is not there." in page.text


def test_files_are_linked_where_they_are_and_pictures_have_texts(page, tmp_path):
    assert [image["src"] for image in page.all("img")] == ["fig5/p.png", "table2/p.png"]
    for image in page.all("img"):
        assert "Walls of 'R'." in image["alt"]
        assert (image["width"], image["height"]) == ("1000", "500")
    links = {attributes["href"] for attributes in page.all("a")}
    files = ("p.png", "p.svg", "short.csv", "long.csv", "t_times.csv", "fig5.json")
    assert {f"fig5/{file}" for file in files} <= links
    assert not any("://" in link for link in links)
    one = Page(write_item_page(tmp_path / "one.html", record("fig5")).read_text(encoding="utf-8"))
    assert one.all("a")[0]["href"] == "../index.html#fig5"
    assert [image["src"] for image in one.all("img")] == ["p.png"]


def test_long_tables_are_folded(page):
    assert len(page.all("details")) == 1 + 2  # what it was made with, and one an item
    assert f"Table of long ({LONG + 1} rows)" in page.text
    assert "0.12346" in page.text
    assert "0.123456789" not in page.text


def test_words():
    assert heading("table2", "walls") == "Table 2: walls"
    assert heading("figB30-32", "x") == "Fig. B.30\N{EN DASH}32: x"
    assert heading("beta", "the threshold") == "The threshold"
    cells = [written(value) for value in (0.0, False, 1e-4, 123456.7)]
    assert cells == ["0", "no", "1.0e-04", "1.2346e+05"]
    assert [duration(seconds) for seconds in (59.97, 3600)] == ["1 min 0 s", "1 h 0 min"]
