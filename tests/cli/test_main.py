"""What the shell gets to know: exit codes, and no traceback that was not asked for."""

import io
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from drystone.cli import main
from drystone.cli.commands import generate
from drystone.cli.commands import stones as command
from drystone.errors import ExitCode, UsageError
from tests.statics.walls import stacked


@pytest.mark.parametrize(
    ("raised", "code", "said"),
    [
        (UsageError("E999", "is odd.", where="--x", cure="Do y."), 2, "E999 --x: is odd. Do y."),
        (PermissionError(13, "Permission denied", "/there"), 3, "E141 /there: the system refuses"),
        (OSError("odd"), 3, "E141 the system refuses this: odd."),
        (OSError(28, "No space left on device", "a.png"), 3, "E206 a.png: the file cannot be"),
        (MemoryError(), 3, "E142 the memory is not large enough."),
        (KeyboardInterrupt(), 130, "interrupted"),
    ],
)
def test_errors_become_exit_codes(raised, code, said, run, monkeypatch):
    def fail(_):
        raise raised

    monkeypatch.setattr(command, "run", fail)
    ran = run("stones", "x.png")
    assert (ran.code, ran.out) == (code, "")
    assert ran.err.startswith(f"drystone: {said}")
    assert ran.err.count("\n") == 1


@pytest.mark.parametrize("left", [True, False])
def test_termination_ends_with_its_own_code_whatever_becomes_of_the_interrupt(
    left, run, monkeypatch
):
    before = signal.getsignal(signal.SIGTERM)

    def stop(_):
        try:
            signal.raise_signal(signal.SIGTERM)
        except KeyboardInterrupt:
            if left:
                raise
        return ExitCode.INTERRUPTED

    monkeypatch.setattr(command, "run", stop)
    ran = run("stones", "x.png")
    assert (ran.code, ran.err) == (143, "drystone: terminated\n" if left else "")
    assert signal.getsignal(signal.SIGTERM) == before


def test_a_cure_names_options_that_the_command_has(run, monkeypatch, tmp_path):
    def fail(_):
        raise MemoryError

    monkeypatch.setattr(generate, "run", fail)
    monkeypatch.setattr(command, "run", fail)
    for asked, smaller in (
        (("generate", "brick", "-o", tmp_path / "x.png"), "--count or number in --set."),
        (("stones", "x.png"), "wall or picture."),
    ):
        said = f"E142 the memory is not large enough. Use a smaller {smaller}"
        assert said in run(*asked).err


def test_a_fault_of_drystone_says_so_in_one_line(run, monkeypatch):
    def fail(_):
        raise ZeroDivisionError("by\nnought")

    monkeypatch.setattr(command, "run", fail)
    ran = run("stones", "x.png")
    assert (ran.code, ran.out) == (70, "")
    assert ran.err == (
        "drystone: E155 stones: this is a fault of drystone (ZeroDivisionError: by nought). "
        "Please report it with the input; --debug shows the traceback.\n"
    )
    with pytest.raises(ZeroDivisionError):
        run("stones", "x.png", "--debug")


@pytest.mark.parametrize(
    ("words", "closed", "code"),
    [("settings mu", ">&- 2>&-", 0), ("settings m", "2>&-", 2), ("settings m", ">&-", 2)],
)
def test_a_closed_output_is_no_error(words, closed, code):
    shell = f"exec {sys.executable} -m drystone {words} {closed}"
    done = subprocess.run(["sh", "-c", shell], capture_output=True, text=True, check=False)  # noqa: S603, S607
    assert (done.returncode, done.stdout) == (code, "")
    assert done.stderr.count("\n") == ("2>" not in closed)


def test_names_are_printed_where_there_are_no_such_letters(rubble, monkeypatch, tmp_path):
    named = tmp_path / "Stäine 石.png"
    named.write_bytes(rubble.read_bytes())
    out = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(out, encoding="cp1252"))
    assert main(["stones", str(named)]) == 0
    assert "Stäine \\u77f3.png".encode("cp1252") in out.getvalue()


def drystone(*words, stdout):
    """Run a command in a process of its own."""
    command = [sys.executable, "-m", "drystone", *map(str, words)]
    return subprocess.run(command, stdout=stdout, stderr=subprocess.PIPE, text=True, check=False)  # noqa: S603 - our own code


def test_a_reader_that_goes_away_is_no_error():
    read, write = os.pipe()
    os.close(read)
    done = drystone("settings", stdout=write)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")


def test_libraries_that_print_by_themselves_are_silent(tmp_path):
    wall = tmp_path / "wall.npy"
    np.save(wall, stacked((20, 8, 0), (20, 8, 5), (20, 8, 2)))
    done = drystone("analyse", wall, "--json", stdout=subprocess.PIPE)
    assert json.loads(done.stdout)["F_LR"] is not None


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(
    ("sent", "code", "said"),
    [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")],
)
def test_a_signal_that_a_module_turns_into_an_error_is_still_a_signal(
    sent, code, said, run, monkeypatch
):
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
