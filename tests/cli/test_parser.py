"""Help, version, settings, and commands of other packages by their entry points."""

import argparse
import subprocess
import sys
from importlib import metadata
from importlib.metadata import EntryPoint, EntryPoints, version

import pytest

from drystone.cli.parser import GROUP, STUDIES, build_parser, found_commands
from drystone.kernels.backend import describe

HIDDEN = argparse.SUPPRESS
TASKS = ("first", "build", "judge", "study")
COMMANDS = (
    "demo", "stones", "markers", "segment", "trace", "plan", "settings", "export", "check",
    "analyse", "measure", "craft", "rehearse", "reproduce", "bench", "fetch", "generate", "cite",
)  # fmt: skip


def test_help_loads_nothing_heavy():
    code = (
        "import sys\n"
        "from drystone.cli import main\n"
        "try:\n"
        "    main(['--help'])\n"
        "finally:\n"
        "    heavy = {'numpy', 'scipy', 'matplotlib', 'rich', 'PIL', 'shapely', 'highspy'}\n"
        "    assert not heavy & set(sys.modules)\n"
    )
    done = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert all(command in done.stdout for command in COMMANDS)


def test_all_commands_are_listed_by_tasks_on_one_screen():
    help_text = build_parser().format_help()
    table = help_text.split("\n\n")[2]
    assert tuple(line.split()[line[0] != " "] for line in table.splitlines()) == COMMANDS
    assert [word for word in table.split() if word in TASKS] == list(TASKS)
    lines = help_text.splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80


def listed(*command):
    """Options that the help of a command lists."""
    parser = build_parser(command)
    (commands,) = (one for one in parser._actions if isinstance(one.choices, dict))
    actions = commands.choices[command[0]]._actions
    return [one.option_strings[0] for one in actions if one.option_strings and one.help != HIDDEN]


def test_help_lists_what_most_people_need():
    assert len(listed("plan")) <= 20
    assert {"--wall", "--set", "--budget", "--ban"} < {*listed("plan")}
    assert listed("demo") == ["-h", "-o", "--seed", "--time", "--json"]
    reading = {"--skip", "--min-area", "--unit"}
    assert reading < {*listed("stones")}
    assert not reading & {*listed("plan"), *listed("analyse"), *listed("measure"), *listed("craft")}


def test_an_area_is_read_in_the_same_way_everywhere(rubble, run):
    half = round(run("stones", rubble, "--json").json()["median_area_px"]) + 1
    asked = ("stones", rubble, "--px-per-m", "100", "--json", "--min-area")
    kept = {run(*asked, f"{half}{unit}").json()["total_area_px"] for unit in ("", "px", "cm2")}
    assert len(kept) == 1
    assert 0 < kept.pop() < run("stones", rubble, "--json").json()["total_area_px"]
    assert "E131" in run("stones", rubble, "--min-area", "60cm2").err


def test_settings_are_listed_with_value_range_and_meaning(run):
    every = run("settings", "--json").json()
    assert every["mu"] == {"value": 0.58, "range": "in (0, 1e+06]",
                           "meaning": "Coefficient of friction."}  # fmt: skip
    assert run("settings", "mu").out == "mu = 0.58  (in (0, 1e+06])\n    Coefficient of friction.\n"
    some = run("settings", "search", "--method", "paper", "--json").json()
    assert some["search.budget"]["value"] == 1
    assert {*some} == {name for name in every if name.startswith("search.")}
    assert "Did you mean `search`?" in run("settings", "serach").err


def test_version_says_which_kernels_run(run, monkeypatch):
    said = f"drystone {version('drystone')} (kernels: {describe()})\n"
    assert run("--version").out == said
    monkeypatch.setenv("DRYSTONE_KERNELS", "fortran")
    run("--version").refused("E143", "fortran")
    monkeypatch.setenv("DRYSTONE_KERNELS", "")
    assert run("--version").code == 0


def test_without_a_command_help_is_printed_and_every_command_has_its_own(run):
    told = run()
    assert (told.code, told.err, told.out) == (0, "", run("--help").out)
    for command in COMMANDS:
        ran = run(command, "--help")
        assert (ran.code, ran.err) == (0, "")
        assert f"usage: drystone {command}" in ran.out


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
