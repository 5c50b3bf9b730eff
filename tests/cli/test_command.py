"""Commands of other packages, by their entry points."""

from importlib import metadata
from importlib.metadata import EntryPoint, EntryPoints

import pytest

from drystone.cli.parser import GROUP, STUDIES, build_parser, found_commands


def offer(monkeypatch, **values):
    """Make these the only entry points."""
    found = EntryPoints(EntryPoint(name, value, GROUP) for name, value in values.items())
    monkeypatch.setattr(metadata, "entry_points", found.select)


def test_the_lab_offers_the_studies():
    commands = found_commands()
    assert list(commands) == list(STUDIES)
    assert all(command.text.endswith(".") for command in commands.values())


def test_commands_of_the_package_come_first_and_look_for_no_others(monkeypatch):
    offer(monkeypatch, plan="drystone_lab.commands:FETCH")
    assert build_parser().parse_args(["plan", "s", "--wall", "5x5", "-o", "x"]).wall == "5x5"

    def fail(**_):
        pytest.fail("all installed packages are looked through")

    monkeypatch.setattr(metadata, "entry_points", fail)
    words = ["stones", "picture.png"]
    assert build_parser(words).parse_args(words).command == "stones"


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({}, "bench: the command cannot be loaded: it is not installed."),
        ({"bench": "gone_lab:BENCH"}, "gone_lab:BENCH: ModuleNotFoundError: No module named"),
        ({"bench": "drystone_lab.commands:NONE"}, "NONE: AttributeError: "),
    ],
)
def test_a_lab_that_is_missing_or_broken(values, said, run, monkeypatch):
    offer(monkeypatch, **values)
    ran = run("bench", "--list", "statics")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("drystone: E154 bench: the command cannot be loaded: ")
    assert said in ran.err
    listed = run("--help")
    assert (listed.code, listed.err) == (0, "")
    assert "bench" in listed.out
