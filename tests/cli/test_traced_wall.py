"""The way of an engineer as docs/for-engineers.md prints it: photograph, trace, analysis."""

import re
import shlex
from pathlib import Path

import pytest

from tests.cli.traced import labelme, photograph

PAGE = Path(__file__).parents[2] / "docs" / "for-engineers.md"
SECTION = "## From a photograph of a wall\n"


def printed(kind):
    """The lines of the blocks of a kind in the section."""
    section = PAGE.read_text(encoding="utf-8").split(SECTION)[1].split("\n## ")[0]
    blocks = re.findall(rf"^ *```{kind}\n(.*?)^ *```$", section, re.MULTILINE | re.DOTALL)
    return "".join(blocks).splitlines()


@pytest.fixture
def traced(tmp_path, monkeypatch):
    """A folder, worked in, with wall.jpg and outlines.json."""
    photograph(tmp_path / "wall.jpg")
    labelme(tmp_path / "outlines.json")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_command_of_the_page_gives_what_it_says(traced, run):
    commands = [shlex.split(line)[1:] for line in printed("sh")]
    assert [words[0] for words in commands] == [
        "trace", "stones", "analyse", "analyse", "stones", "measure",
    ]  # fmt: skip
    told = [run(*words) for words in commands]
    assert [one.code for one in told] == [0] * len(told), [one.err for one in told]
    assert (traced / "trace" / "outlines.html").exists()
    assert "13 stones" in told[1].out
    assert "own weight           stands" in told[2].out
    assert set(printed("text")) <= set(told[2].out.splitlines())
    assert "m wide" in told[2].out
    values = [re.search(r"^F_LR +(0\.\d+)", one.out, re.MULTILINE) for one in told[2:4]]
    assert values[0][1] == values[1][1]
    assert (traced / "traced-analysis" / "report.html").exists()
    photo = run("analyse", "wall.jpg")
    assert (photo.code, "for-engineers.md#from-a-photograph-of-a-wall" in photo.err) == (3, True)


def test_following_the_hints_ends_with_a_number(traced, run):
    follow(traced / "outlines.json", run)


def test_the_hints_lead_through_a_published_wall(data_dir, run):
    follow(data_dir / "almeida" / "PR.png", run)


def follow(wall, run):
    """Do what each hint says, as it is printed, from the bare command on."""
    asked, seen = ["analyse", str(wall), "--associative-only"], []
    ran = run(*asked)
    while ran.code == 5:
        hint = re.search(r"--close-gaps \w+", ran.err)
        assert hint is not None, ran.err
        assert hint[0] not in seen, "in a circle"
        seen.append(hint[0])
        ran = run(*asked, *hint[0].split())
    assert ran.code == 0
    value = re.search(r"^F_LR +([01]\.\d+)", ran.out, re.MULTILINE)
    again = re.search(r"the same again: (--close-gaps \d+px)", ran.out)
    assert f" {value[1]} " in run(*asked, *again[1].split()).out


@pytest.mark.usefixtures("traced")
def test_what_was_traced_is_measured_and_looked_at_too(run):
    for command in ("measure", "craft"):
        ran = run(command, "outlines.json", "--json")
        assert ran.code == 0
        assert ran.json()
    assert "13 stones" in run("craft", "outlines.json").out
