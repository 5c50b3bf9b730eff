"""Help, version and wrong options: quick, short, and with a code."""

import subprocess
import sys
from importlib.metadata import version

from drystone.cli.parser import build_parser
from drystone.kernels.backend import describe

COMMANDS = (
    "plan", "demo", "stones", "analyse", "measure", "check", "export", "craft", "markers",
    "segment", "generate", "bench", "reproduce", "fetch",
)  # fmt: skip


def test_help_loads_nothing_heavy():
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


def test_every_command_explains_itself(run):
    for command in COMMANDS:
        ran = run(command, "--help")
        assert (ran.code, ran.err) == (0, "")
        assert f"usage: drystone {command}" in ran.out


def test_all_commands_are_tested():
    listed = build_parser().format_help().split("COMMAND\n")[1].split("\n\n")[0]
    names = [line.split()[0] for line in listed.splitlines() if line.startswith("    ")]
    assert [name for name in names if name in COMMANDS] == list(COMMANDS)


def test_version(run):
    out = run("--version").out
    assert out == f"drystone {version('drystone')} (kernels: {describe()})\n"


def test_kernels_that_are_not_there_are_a_coded_error(run, monkeypatch):
    monkeypatch.setenv("DRYSTONE_KERNELS", "fortran")
    told = run("--version")
    assert (told.code, "E143" in told.err, "fortran" in told.err) == (2, True, True)
    monkeypatch.setenv("DRYSTONE_KERNELS", "")
    assert run("--version").code == 0


def test_without_a_command_help_is_printed(run):
    told = run()
    assert (told.code, told.err, told.out) == (0, "", run("--help").out)


def test_a_command_that_is_not_there_is_told_what_was_meant(run):
    for word, meant in (("paln", "plan"), ("Analyze", "analyse"), ("stone", "stones")):
        told = run(word, "x.png")
        assert (told.code, told.out) == (2, "")
        assert f"Did you mean `drystone {meant}`?" in told.err
    assert "Did you mean" not in run("xyzzy").err
