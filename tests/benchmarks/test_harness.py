"""The harness of the benchmarks: all runs once, small; its walls, its page, its rehearsals."""

import doctest
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.labels import coursed_labels, irregular_labels

from benchmarks import page, rehearsals
from drystone.contacts.blocks import model_from_labels
from drystone_lab.table import Table
from drystone_lab.walls import BRICKS

ROOT = Path(__file__).parents[2]


def test_of_the_page_what_is_not_marked_stays_and_every_table_has_its_place():
    assert doctest.testmod(page).failed == 0
    text = "before\n<!-- table one -->\nold\n<!-- end -->\nafter\n"
    one = {"one": Table("One", ("a",), ((1,),))}
    written = page.rewritten(text, one)
    assert written.startswith("before\n<!-- table one -->\n**One**")
    assert written.endswith("\n<!-- end -->\nafter\n")
    assert "old" not in written
    assert page.rewritten(written, one) == written
    with pytest.raises(KeyError, match="two"):  # it was not measured
        page.rewritten(text.replace("one", "two"), one)
    speed = (ROOT / "docs" / "evidence" / "speed.md").read_text(encoding="utf-8")
    names = [name for name, _ in page.TABLE.findall(speed)]
    assert sorted(names) == sorted(["functions", "walls", "parts", "limits", "memory", "larger"])


def test_every_benchmark_runs_once():
    words = "-m pytest benchmarks -q -p no:xdist -p no:cacheprovider --sizes smoke"
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, *words.split(), "--benchmark-disable"],
        check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    assert " passed" in ran.stdout


@pytest.mark.parametrize("make", [coursed_labels, irregular_labels])
@pytest.mark.parametrize("count", [10, 60, 300])
def test_there_are_enough_stones_and_no_gaps(make, count):
    labels, again, other = (make(np.random.default_rng(seed), count) for seed in (3, 3, 2))
    assert np.array_equal(labels, again)
    assert not np.array_equal(labels, other)
    assert labels.dtype == np.uint32
    assert labels.min() == 1
    assert count * 1.1 < len(np.unique(labels)) == labels.max() < 2.2 * count + 20
    assert 0.5 < labels.shape[1] / labels.shape[0] < 6


def test_joints_are_level_in_courses_and_tilted_in_irregular_walls():
    def square(make):
        interfaces = model_from_labels(make(np.random.default_rng(0), 30)).model.interfaces
        between = [i for i in interfaces if i.other and len(i.points) > 1]
        return np.mean([max(abs(x) for x in i.normal) == 1.0 for i in between])

    assert square(coursed_labels) == 1.0
    assert square(irregular_labels) < 0.3


def test_what_is_on_disk_is_not_done_again(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(rehearsals, "WALLS", (BRICKS,))
    asked = [str(tmp_path), "--seeds", "1", "--budget", "1", "--tilts", "0"]
    rehearsals.main([*asked, "--runs", "1"])
    rows = tmp_path / "bricks-0" / "rows.jsonl"
    assert len(rows.read_text().splitlines()) == 1 + 2 * 2  # without errors; levels x loops
    first = capsys.readouterr().out.splitlines()
    assert first[1].startswith("bricks | 100%, 0.0 | 100%, 0.0 | 100%, 0.0 (0.0) | ")
    # Rows that are there are believed, missing ones added, the plan is not made again.
    monkeypatch.setattr(rehearsals.subprocess, "run", None)
    lost = [line.replace('"fallen": 0', '"fallen": 2') for line in rows.read_text().splitlines()]
    rows.write_text("\n".join(lost) + "\n")
    rehearsals.main([*asked, "--runs", "2", "--against", str(tmp_path)])
    assert len(rows.read_text().splitlines()) == 1 + 2 * 2 * 2
    mine, other = capsys.readouterr().out.splitlines()[1:]
    assert mine == other
    assert " | 50%, 1.0 | 50%, 1.0 | 50%, 1.0 (0.0) | " in mine
