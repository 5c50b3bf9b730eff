"""Help, version and wrong options: quick, short, and with a code."""

import subprocess
import sys
from importlib.metadata import version

import pytest

from drystone.cli.parser import build_parser
from drystone.kernels.backend import describe
from tests.cli.conftest import Run

COMMANDS = (
    "plan", "demo", "stones", "analyse", "measure", "check", "export", "craft", "markers",
    "segment", "generate", "bench", "reproduce", "fetch",
)  # fmt: skip


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys\n"
        "from drystone.cli import main\n"
        "try:\n"
        "    main(['--help'])\n"
        "except SystemExit as stopped:\n"
        "    heavy = {'numpy', 'scipy', 'matplotlib', 'rich', 'PIL', 'shapely', 'highspy'}\n"
        "    sys.exit(f'loaded: {heavy & set(sys.modules)}' if heavy & set(sys.modules) else 0)\n"
        "sys.exit('help did not end the program')\n"
    )
    done = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert all(command in done.stdout for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command: str, run: Run) -> None:
    ran = run(command, "--help")
    assert ran.code == 0
    assert f"usage: drystone {command}" in ran.out
    assert ran.err == ""


def test_an_image_is_named_in_all_that_has_several(run: Run) -> None:
    for command in ("plan", "stones"):
        assert "annotations of several (COCO, masks of SAM)" in " ".join(
            run(command, "--help").out.split()
        )


def test_all_commands_are_tested() -> None:
    assert all(f"    {command} " in build_parser().format_help() for command in COMMANDS)
    listed = build_parser().format_help().split("COMMAND\n")[1].split("\n\n")[0]
    names = [line.split()[0] for line in listed.splitlines() if line.startswith("    ")]
    assert [name for name in names if name in COMMANDS] == list(COMMANDS)


def test_version(run: Run) -> None:
    out = run("--version").out
    assert out == f"drystone {version('drystone')} (kernels: {describe()})\n"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "COMMAND"),
        (["build"], "'build'"),
        (["plan", "stones.png", "-o", "x"], "--wall"),
        (["plan", "stones.png", "--wall", "5x5"], "-o"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--scale", "big"], "--scale: 'big'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--scale", "0"], "--scale: '0'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--scale", "1.5"], "--scale: '1.5'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--px-per-m", "-5"], "--px-per-m: '-5'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--px-per-m", "nan"], "--px-per-m: 'nan'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--px-per-m", "inf"], "--px-per-m: 'inf'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--seed", "-1"], "--seed: '-1'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--jobs", "0"], "--jobs: '0'"),
        (["plan", "s", "--wall", "5x5", "-o", "x", "--sampling", "some"], "'some'"),
        (["generate", "rubble", "-o", "x.png", "--count", "0"], "--count: '0'"),
        (["generate", "rubble", "-o", "x.png", "--seed", "1.5"], "--seed: '1.5'"),
        (["measure", "wall.png", "--scale", "0"], "--scale: '0'"),
    ],
)
def test_wrong_options_end_with_one_line(arguments: list[str], said: str, run: Run) -> None:
    ran = run(*arguments)
    assert ran.code == 2
    assert ran.out == ""
    assert ran.err.startswith("drystone: E138 ")
    assert said in ran.err
    assert ran.err.endswith("--help` explains.\n")
    assert ran.err.count("\n") == 1


def test_kernels_that_are_not_there_are_a_coded_error(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DRYSTONE_KERNELS", "fortran")
    told = run("--version")
    assert told.code == 2
    assert "E143" in told.err
    assert "fortran" in told.err
    monkeypatch.setenv("DRYSTONE_KERNELS", "")
    assert run("--version").code == 0
