import json
from datetime import UTC, datetime

import pytest

from drystone.errors import InputError, UsageError
from drystone_lab.reproduce import driver
from drystone_lab.reproduce.driver import reproduce
from drystone_lab.runs.outcome import one_by_one
from drystone_lab.table import written
from tests.drawing.report.test_report import Page
from tests.lab.reproduce import fakes


def make(folder, *names, items=fakes.ITEMS, **options):
    now = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)
    return list(reproduce(names, folder, items, now=lambda: now, **options))


def names_in(folder):
    return {path.name for path in folder.iterdir()}


def page_of(folder):
    return (folder / "index.html").read_text("utf-8")


def test_an_item_has_its_files_and_its_json_says_what_was_run_with_what(tmp_path):
    (made,) = make(tmp_path, "fig5", seed=7)
    assert (made.status, made.error) == ("made", None)
    files = {"walls.csv", "walls_times.csv", "filling.png", "filling.svg"}
    assert names_in(tmp_path / "fig5") == {"fig5.json", "index.html", *files}
    assert names_in(tmp_path) == {"fig5", "index.html", "reproduce.json", "runs"}
    found = json.loads((tmp_path / "fig5" / "fig5.json").read_text("utf-8"))
    assert found == made.record
    assert (found["title"], found["section"]) == ("filling of bricks", "§3.4")
    assert (found["request"]["seed"], found["request"]["quick"]) == (7, False)
    assert found["seeds"] == [7, 8]
    assert [run["source"]["kind"] for run in found["runs"]] == ["brick", "brick"]
    assert {f"{run['key']}.json" for run in found["runs"]} == names_in(tmp_path / "runs")
    assert found["made"]["date"] == "2026-01-02 03:04 UTC"
    assert {"numpy", "scipy", "highspy"} <= found["made"]["packages"].keys()
    assert found["taken"]["walls"] == 2
    assert 0 < found["taken"]["wall_seconds"] < found["taken"]["seconds"]
    (table,), (times,) = found["tables"], found["times"]
    assert (table["file"], times["file"]) == ("walls.csv", "walls_times.csv")
    assert (table["rows"][0][0], table["rows"][0][2]) == (7, None)
    # Words take what was found; a caption is that of the longest name.
    assert table["notes"] == ["Of bricks."]
    assert [picture["caption"] for picture in found["pictures"]] == ["Filling over 7."]
    # Equal seeds give equal tables and pictures.
    again = tmp_path / "again"
    make(again, "fig5", seed=7)
    for name in files - {"walls_times.csv"}:
        assert (tmp_path / "fig5" / name).read_bytes() == (again / "fig5" / name).read_bytes()


def test_what_is_finished_is_not_made_again_and_planned_walls_not_planned_again(tmp_path):
    planned = []

    def noted(specs, data):
        planned.extend(spec.seed for spec in specs)
        yield from one_by_one(specs, data)

    for status, seeds, options in (
        ("made", [1, 2], {}),
        ("kept", [], {}),
        ("made", [], {"again": True}),
        ("made", [3], {"seed": 2}),
        ("made", [], {"seed": 2, "quick": True}),
        ("made", [], {"seed": 2, "quick": True, "again": True}),
    ):
        planned.clear()
        (made,) = make(tmp_path, "fig5", work=noted, **options)
        assert (made.status, planned) == (status, seeds)
    kept = make(tmp_path, "fig5", seed=2, quick=True)[0]
    assert (kept.status, kept.record) == ("kept", made.record)
    # A file that is gone is made again.
    (tmp_path / "fig5" / "filling.svg").unlink()
    assert make(tmp_path, "fig5", seed=2, quick=True)[0].status == "made"
    (tmp_path / "fig5" / "fig5.json").write_text('{"schema": "drystone-item/1", "cut sh')
    assert make(tmp_path, "fig5", seed=2, quick=True)[0].status == "made"
    # Files of an earlier version go, those of others stay.
    (tmp_path / "mine.txt").write_text("mine")
    make(tmp_path, "fig5", items={"fig5": fakes.WORDS}, again=True)
    assert names_in(tmp_path / "fig5") == {"fig5.json", "index.html"}
    assert (tmp_path / "mine.txt").is_file()


def test_published_stones_that_are_not_there(tmp_path):
    out, data = tmp_path / "out", tmp_path / "data"
    (made,) = make(out, "fig13")
    assert (made.status, made.error.code) == ("missing data", "E100")
    assert isinstance(made.error, InputError)
    assert "almeida/PR.png, ferris/x.json" in str(made.error)
    assert "drystone fetch almeida ferris" in str(made.error)
    assert "almeida/PR.png" in page_of(out)
    assert "published stones" in page_of(out)
    fakes.lay_needed(data)
    assert make(out, "fig13", data=data)[0].status == "made"
    assert "Not made" not in page_of(out)
    # What was made with them stays when they are gone, unless something else is asked for.
    assert make(out, "fig13")[0].status == "kept"
    assert make(out, "fig13", seed=3)[0].error is not None
    assert "Not made" in page_of(out)
    assert "Only words" in page_of(out)
    make(out, "fig13")
    assert "Not made" not in page_of(out)


def test_an_error_stops_one_item_and_an_interrupt_keeps_what_is_finished(tmp_path):
    failed, after = make(tmp_path / "one", "figB33", "beta")
    assert (failed.status, after.status) == ("failed", "made")
    assert failed.error.code == "E104"
    page = page_of(tmp_path / "one")
    assert "E104 broken: there are no stones. Look for some." in page
    assert "Appendix B.1" in page
    with pytest.raises(KeyboardInterrupt):
        make(tmp_path / "other", "beta", "fig17")
    assert '<h2 id="beta">' in page_of(tmp_path / "other")
    assert [len(names_in(tmp_path / name / "runs")) for name in ("one", "other")] == [2, 2]


@pytest.mark.parametrize("mark", [None, "{}", "no json", '{"schema": "drystone-plan/1"}'])
def test_folders_of_others_are_refused(mark, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    if mark is not None:
        (tmp_path / "reproduce.json").write_text(mark)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(UsageError, match="E129"):
        make(tmp_path, "beta")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_walls_are_told_of_now_and_then():
    said, now = [], [0.0]
    progress = driver.ItemProgress(said.append, 1, lambda: now[0])
    progress.begin("fig5")
    for text, step in (("1", 0.0), ("2", driver.EVERY_S / 2), ("3", driver.EVERY_S), ("4", 3661.0)):
        now[0] += step
        progress.walls(text)
    assert [line.split(": ")[-1] for line in said[1:]] == ["1", "3", "4"]
    assert said[-1].startswith("[1:01:04] ")


def test_the_report_of_all_and_of_one(tmp_path):
    make(tmp_path, "beta")
    (made,) = make(tmp_path, "fig5")
    # Items add up in the order of the paper.
    page = page_of(tmp_path)
    assert page.index('<h2 id="fig5">') < page.index('<h2 id="beta">')
    assert 'src="fig5/filling.png"' in page
    one = made.record
    rows = [["R", 0.123456789 + k] for k in range(driver.LONG + 1)]
    long = {"title": "Table of long", "columns": ["<wall>", "F_SF"], "rows": rows}
    first, later = (
        one | {
            "name": name, "title": "walls <of> stones",
            "tables": [*one["tables"], one["tables"][0] | long],
            "request": {"version": "9.8", "quick": quick, "seed": seed},
            "made": one["made"] | {"date": f"2026-01-0{seed} 10:00", "machine": "Linux, 2 cores"},
            "taken": {"seconds": 1.0, "walls": 20, "wall_seconds": 90.0},
        }
        for name, quick, seed in (("fig5", False, 1), ("table2", True, 3))
    )  # fmt: skip
    misses = {"fig13": {"title": "masons", "section": "§5.1", "error": "E100 R.png: is not there."}}
    order = ("fig5", "fig13", "table2")
    path = driver.write_page(tmp_path / "index.html", [later, first], misses, order)
    page = Page(path.read_text(encoding="utf-8"))
    heads = [attributes["id"] for attributes in page.all("h2") if "id" in attributes]
    assert heads == ["contents", *order]
    links = [attributes["href"] for attributes in page.all("a")]
    assert links[:3] == [f"#{name}" for name in order]
    assert "Fig. 5: walls <of> stones" in page.text
    assert "Walls & <joints>." in page.text
    assert page.text.index("In the paper") < page.text.index("Walls of bricks.")
    # What it was made with
    assert (
        "2 of 3 were made, 1 as quick versions and 1 in full, with drystone 9.8, "
        "2026-01-01 to 2026-01-03, on Linux, 2 cores." in page.text
    )
    assert "20 walls planned in 1 min 30 s" in page.text
    assert "40 in 3 min 0 s" in page.text
    assert "E100 R.png: is not there." in page.text
    # Files are linked where they are, and pictures have texts.
    pictures = ["fig5/filling.png", "table2/filling.png"]
    assert [image["src"] for image in page.all("img")] == pictures
    size = [str(one["pictures"][0][side]) for side in ("width_px", "height_px")]
    for image in page.all("img"):
        assert "Filling over 1." in image["alt"]
        assert [image["width"], image["height"]] == size
    files = ("filling.png", "filling.svg", "walls.csv", "walls_times.csv", "fig5.json")
    assert {f"fig5/{file}" for file in files} <= {*links}
    assert not any("://" in link for link in links)
    # Long tables are folded.
    assert len(page.all("details")) == 1 + 2  # what it was made with, and one an item
    assert f"Table of long ({driver.LONG + 1} rows)" in page.text
    assert "0.12346" in page.text
    assert "0.123456789" not in page.text
    alone = driver.write_item_page(tmp_path / "one.html", first)
    page = Page(alone.read_text(encoding="utf-8"))
    assert page.all("a")[0]["href"] == "../index.html#fig5"
    assert [image["src"] for image in page.all("img")] == ["filling.png"]


def test_words():
    assert driver.heading("table2", "walls") == "Table 2: walls"
    cells = [written(value) for value in (0.0, False, 1e-4, 123456.7)]
    assert cells == ["0", "no", "1.0e-04", "1.2346e+05"]
    assert [driver.duration(seconds) for seconds in (59.97, 3600)] == ["1 min 0 s", "1 h 0 min"]
