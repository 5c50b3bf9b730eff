"""Items are made, kept, reported; walls that were planned are not planned again."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from drystone.errors import InputError, UsageError
from drystone_lab.reproduce.driver import EVERY_S, ItemProgress, Options, reproduce
from drystone_lab.runs.outcome import one_by_one
from tests.lab.reproduce import fakes

OPTIONS = Options(now=lambda: datetime(2026, 1, 2, 3, 4, tzinfo=UTC))


def make(folder, *names, options=OPTIONS, items=fakes.ITEMS):
    return list(reproduce(names, folder, options, items))


def names_in(folder):
    return {path.name for path in folder.iterdir()}


def page_of(folder):
    return (folder / "index.html").read_text("utf-8")


def test_an_item_has_its_files(tmp_path):
    (made,) = make(tmp_path, "fig5")
    assert (made.status, made.error) == ("made", None)
    assert made.page == tmp_path / "fig5" / "index.html"
    files = {"walls.csv", "walls_times.csv", "filling.png", "filling.svg"}
    assert names_in(tmp_path / "fig5") == {"fig5.json", "index.html", *files}
    assert names_in(tmp_path) == {"fig5", "index.html", "reproduce.json", "runs"}
    assert len(names_in(tmp_path / "runs")) == 2
    # Equal seeds give equal tables and pictures.
    again = tmp_path / "again"
    make(again, "fig5")
    for name in files - {"walls_times.csv"}:
        assert (tmp_path / "fig5" / name).read_bytes() == (again / "fig5" / name).read_bytes()


def test_the_json_says_what_was_run_with_what(tmp_path):
    (made,) = make(tmp_path, "fig5", options=replace(OPTIONS, seed=7))
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


def test_what_is_finished_is_not_made_again(tmp_path):
    item, contexts = fakes.counted(fakes.FILLING)
    items = {"fig5": item}
    (first,), (made,) = (make(tmp_path, "fig5", items=items) for _ in range(2))
    assert (made.status, len(contexts)) == ("kept", 1)
    assert made.record == first.record
    for count, changed in enumerate(({}, {"quick": True}, {"quick": True, "again": True}), 2):
        options = replace(OPTIONS, seed=2, **changed)
        assert make(tmp_path, "fig5", items=items, options=options)[0].status == "made"
        assert len(contexts) == count


def test_a_file_that_is_gone_is_made_again(tmp_path):
    make(tmp_path, "fig5")
    (tmp_path / "fig5" / "filling.svg").unlink()
    assert make(tmp_path, "fig5")[0].status == "made"
    (tmp_path / "fig5" / "fig5.json").write_text('{"schema": "drystone-item/1", "cut sh')
    assert make(tmp_path, "fig5")[0].status == "made"
    assert make(tmp_path, "fig5")[0].status == "kept"


def test_planned_walls_are_taken_from_the_folder(tmp_path):
    planned = []

    def noted(specs, data):
        planned.extend(spec.seed for spec in specs)
        yield from one_by_one(specs, data)

    noting, tables = replace(OPTIONS, work=noted, again=True), set()
    for _ in range(2):
        make(tmp_path, "fig5", options=noting)
        tables.add((tmp_path / "fig5" / "walls.csv").read_bytes())
    assert planned == [1, 2]
    assert len(tables) == 1
    make(tmp_path, "fig5", options=replace(noting, seed=2))
    assert planned == [1, 2, 3]


def test_files_of_an_earlier_version_go(tmp_path):
    make(tmp_path, "fig5")
    make(tmp_path, "fig5", items={"fig5": fakes.WORDS})
    (tmp_path / "mine.txt").write_text("mine")
    make(tmp_path, "fig5", items={"fig5": fakes.WORDS}, options=replace(OPTIONS, again=True))
    assert names_in(tmp_path / "fig5") == {"fig5.json", "index.html"}
    assert (tmp_path / "mine.txt").is_file()


def test_items_add_up_in_the_order_of_the_paper(tmp_path):
    make(tmp_path, "beta")
    make(tmp_path, "fig5", options=replace(OPTIONS, quick=True))
    page, alone = page_of(tmp_path), page_of(tmp_path / "fig5")
    assert page.index('<h2 id="fig5">') < page.index('<h2 id="beta">')
    assert 'src="fig5/filling.png"' in page
    assert 'src="filling.png"' in alone
    assert "beta" not in alone


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
    assert make(out, "fig13", options=replace(OPTIONS, data=data))[0].status == "made"
    assert "Not made" not in page_of(out)
    # What was made with them stays when they are gone, unless something else is asked for.
    assert make(out, "fig13")[0].status == "kept"
    assert make(out, "fig13", options=replace(OPTIONS, seed=3))[0].error is not None
    assert "Not made" in page_of(out)
    assert "Only words" in page_of(out)
    make(out, "fig13")
    assert "Not made" not in page_of(out)


def test_an_error_stops_one_item(tmp_path):
    failed, after = make(tmp_path, "figB33", "beta")
    assert (failed.status, after.status) == ("failed", "made")
    assert failed.error.code == "E104"
    assert "E104 broken: there are no stones. Look for some." in page_of(tmp_path)
    assert "Appendix B.1" in page_of(tmp_path)
    assert len(names_in(tmp_path / "runs")) == 2


def test_an_interrupt_keeps_what_is_finished(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        make(tmp_path, "beta", "fig17")
    assert '<h2 id="beta">' in page_of(tmp_path)
    assert len(names_in(tmp_path / "runs")) == 2


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
    progress = ItemProgress(said.append, 1, lambda: now[0])
    progress.begin("fig5")
    for text, step in (("1", 0.0), ("2", EVERY_S / 2), ("3", EVERY_S), ("4", 3661.0)):
        now[0] += step
        progress.walls(text)
    assert [line.split(": ")[-1] for line in said[1:]] == ["1", "3", "4"]
    assert said[-1].startswith("[1:01:04] ")
