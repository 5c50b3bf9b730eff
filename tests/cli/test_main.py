"""What the shell gets to know: help, exit codes, and no traceback that was not asked for."""

import argparse
import io
import json
import os
import signal
import subprocess
import sys
from importlib import metadata
from importlib.metadata import EntryPoint, EntryPoints, version

import numpy as np
import pytest

from drystone.cli import main
from drystone.cli.commands import generate
from drystone.cli.commands import stones as command
from drystone.cli.parser import GROUP, STUDIES, build_parser, found_commands
from drystone.errors import UsageError
from drystone.kernels.backend import describe
from tests.statics.walls import stacked


def failing(monkeypatch, error, module=command):
    def fail(_):
        raise error

    monkeypatch.setattr(module, "run", fail)


@pytest.mark.parametrize(
    ("raised", "code", "said"),
    [
        (UsageError("E999", "is odd.", where="--x", cure="Do y."), 2, "E999 --x: is odd. Do y."),
        (PermissionError(13, "Permission denied", "/there"), 3, "E141 /there: the system refuses"),
        (OSError("odd"), 3, "E141 the system refuses this: odd."),
        (OSError(28, "No space left on device", "a.png"), 3, "E206 a.png: the file cannot be"),
        (MemoryError(), 3, "E142 the memory is not large enough. Use a smaller wall or picture."),
        (KeyboardInterrupt(), 130, "interrupted"),
        (ZeroDivisionError("by\nnought"), 70, "E155 stones: this is a fault of drystone "
         "(ZeroDivisionError: by nought). Please report it with the input; --debug shows the "
         "traceback.\n"),
    ],
)  # fmt: skip
def test_errors_become_exit_codes(raised, code, said, run, monkeypatch):
    failing(monkeypatch, raised)
    ran = run("stones", "x.png")
    assert (ran.code, ran.out) == (code, "")
    assert ran.err.startswith(f"drystone: {said}")
    assert ran.err.count("\n") == 1
    if code == 70:
        with pytest.raises(ZeroDivisionError):
            run("stones", "x.png", "--debug")


def test_a_cure_names_options_that_the_command_has(run, monkeypatch, tmp_path):
    failing(monkeypatch, MemoryError(), generate)
    said = "E142 the memory is not large enough. Use a smaller --count or number in --set."
    assert said in run("generate", "brick", "-o", tmp_path / "x.png").err


def in_a_shell(line, stdout=subprocess.PIPE):
    """Run a command line in a process of its own; what goes to stdout and stderr is kept."""
    line = f"{sys.executable} -m drystone {line}"
    kept = {"stdout": stdout, "stderr": subprocess.PIPE, "text": True}
    return subprocess.run(line, shell=True, check=False, **kept)  # noqa: S602 - our own code


def test_an_output_that_is_closed_or_whose_reader_goes_away_is_no_error():
    for line, code in (("settings mu >&- 2>&-", 0), ("settings m 2>&-", 2), ("settings m >&-", 2)):
        done = in_a_shell(line)
        assert (done.returncode, done.stdout) == (code, "")
        assert done.stderr.count("\n") == ("2>" not in line)
    read, write = os.pipe()
    os.close(read)
    done = in_a_shell("settings", stdout=write)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")


def test_libraries_that_print_by_themselves_are_silent(tmp_path):
    np.save(tmp_path / "wall.npy", stacked((20, 8, 0), (20, 8, 5), (20, 8, 2)))
    done = in_a_shell(f"analyse {tmp_path / 'wall.npy'} --json")
    assert json.loads(done.stdout)["F_LR"] is not None


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(
    ("sent", "code", "said"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")],
)
def test_a_signal_that_becomes_an_error_is_a_signal(sent, code, said, run, monkeypatch):
    """Modules are loaded while a command line is parsed, and while a command runs."""

    def imported(*_):
        try:
            signal.raise_signal(sent)
        except KeyboardInterrupt as interrupt:
            raise ImportError("initialization failed") from interrupt

    for place, name in ((command, "run"), (sys.modules["drystone.cli.main"], "build_parser")):
        with monkeypatch.context() as patch:
            patch.setattr(place, name, imported)
            ran = run("stones", "x.png")
        assert (ran.code, ran.err) == (code, f"drystone: {said}\n")


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
        "    print(sorted(heavy & set(sys.modules)))\n"
    )
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout.endswith("\n[]\n")


def test_all_commands_are_listed_by_tasks_on_one_screen():
    help_text = build_parser().format_help()
    table, lines = help_text.split("\n\n")[2], help_text.splitlines()
    assert tuple(line.split()[line[0] != " "] for line in table.splitlines()) == COMMANDS
    assert [word for word in table.split() if word in TASKS] == list(TASKS)
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80


def listed(*command):
    parser = build_parser(command)
    (commands,) = (one for one in parser._actions if isinstance(one.choices, dict))
    actions = commands.choices[command[0]]._actions
    shown = [one for one in actions if one.help != argparse.SUPPRESS]
    return [one.option_strings[0] for one in shown if one.option_strings]


def test_help_lists_what_most_people_need():
    assert len(listed("plan")) <= 20
    assert {"--wall", "--set", "--budget", "--ban"} < {*listed("plan")}
    assert listed("demo") == ["-h", "-o", "--seed", "--time", "--overwrite", "--json"]
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
    every, meaning = run("settings", "--json").json(), "Coefficient of friction."
    assert every["mu"] == {"value": 0.58, "range": "in (0, 1e+06]", "meaning": meaning}
    assert run("settings", "mu").out == f"mu = 0.58  (in (0, 1e+06])\n    {meaning}\n"
    some = run("settings", "search", "--method", "paper", "--json").json()
    assert some["search.budget"]["value"] == 1
    assert {*some} == {name for name in every if name.startswith("search.")}
    assert "Did you mean `search`?" in run("settings", "serach").err


def test_version_says_which_kernels_run(run, monkeypatch):
    said = f"drystone {version('drystone')} (kernels: {describe()})\n"
    assert run("--version").out == said
    monkeypatch.setenv("DRYSTONE_KERNELS", "fortran")
    run("--version").refused("E143", "compiled, not 'fortran'. Set it to auto or python;")
    monkeypatch.setenv("DRYSTONE_KERNELS", "")
    assert run("--version").code == 0


def test_without_a_command_help_is_printed_and_every_command_has_its_own(run, monkeypatch):
    told = run()
    monkeypatch.setenv("COLUMNS", "40")  # where every usage is wrapped
    assert (told.code, told.err, told.out) == (0, "", run("--help").out)
    for name in COMMANDS:
        ran = run(name, "--help")
        assert (ran.code, ran.err, f"usage: drystone {name}" in ran.out) == (0, "", True)


def offer(monkeypatch, **values):
    """Make these the only entry points."""
    found = EntryPoints(EntryPoint(name, value, GROUP) for name, value in values.items())
    monkeypatch.setattr(metadata, "entry_points", found.select)


def test_commands_of_the_package_come_first_and_look_for_no_others(monkeypatch):
    assert list(found_commands()) == list(STUDIES)
    assert all(command.text.endswith(".") for command in found_commands().values())
    offer(monkeypatch, plan="drystone_lab.commands:FETCH")
    assert build_parser().parse_args(["plan", "s", "--wall", "5x5", "-o", "x"]).wall == "5x5"

    def fail(**_):
        pytest.fail("all installed packages are looked through")

    monkeypatch.setattr(metadata, "entry_points", fail)
    words = ["stones", "picture.png"]
    assert build_parser(words).parse_args(words).command == "stones"


def test_a_lab_that_is_missing_or_broken(run, monkeypatch, tmp_path):
    (tmp_path / "leaves.py").write_text("raise SystemExit(3)")
    monkeypatch.syspath_prepend(tmp_path)
    for values, said in (
        ({"bench": "leaves:BENCH"}, "leaves:BENCH: SystemExit: 3"),
        ({}, "it is not installed."),
        ({"bench": "gone_lab:BENCH"}, "gone_lab:BENCH: ModuleNotFoundError: No module named"),
        ({"bench": "drystone_lab.commands:NONE"}, "NONE: AttributeError: "),
    ):
        offer(monkeypatch, **values)
        run("bench", "--list", "statics").refused("E154 bench: the command cannot be loaded", said)
        told = run("--help")
        assert (told.code, told.err, "bench" in told.out) == (0, "", True)


@pytest.mark.parametrize("encoding", ["cp1252", "utf-8", "ascii", "utf-16"])
def test_names_are_printed_in_any_encoding(encoding, rubble, tmp_path, monkeypatch):
    named = tmp_path / "Stäine 石🪨.png"
    named.write_bytes(rubble.read_bytes())
    printed = []
    for more in ([], ["--json"]):
        out = io.BytesIO()
        monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(out, encoding=encoding))
        assert main(["stones", str(named), *more]) == 0
        printed.append(out.getvalue().decode(encoding))
    assert ("Stäine \\u77f3" in printed[0]) == (encoding == "cp1252")
    assert encoding != "utf-8" or all(named.name in text for text in printed)
    assert json.loads(printed[1])["source"] == named.name
