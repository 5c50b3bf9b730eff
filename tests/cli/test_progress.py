"""The progress bar: on a terminal only, and on stderr only."""

import pytest

from drystone.cli import progress
from tests.cli.conftest import EXACT, UNTRIED, WALL


def test_a_terminal_sees_stones_and_walls(rubble, tmp_path, run, monkeypatch):
    plan = ("plan", rubble, "--overwrite", "-o", tmp_path / "out")
    monkeypatch.setenv("FORCE_COLOR", "1")  # the terminal that pytest does not have
    ran = run(*plan, *EXACT, *UNTRIED, "--budget", 2)
    assert "filling" in ran.err
    assert "walls; best: " in ran.err
    assert "filling 0" not in ran.out
    for option in ("--quiet", "--json"):
        assert run(*plan, *WALL, option).err == ""


@pytest.mark.parametrize("command", ["check", "measure", "craft"])
def test_what_takes_long_says_so(command, settled, rubble, run, monkeypatch):
    """Nothing is shown of what is soon done; the bar comes when the time is up."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    asked = (command, settled, *(("--stones", rubble) if command == "check" else ()))
    monkeypatch.setattr(progress, "Timer", lambda _, __: _Timer(lambda: None))
    assert run(*asked).err == ""
    monkeypatch.setattr(progress, "Timer", lambda _, start: _Timer(start))
    ran = run(*asked)
    assert "the wall" in ran.err or "every step" in ran.err
    assert run(*asked, "--json").err == ""


class _Timer:
    """A timer whose time is up at once."""

    def __init__(self, start):
        self.start, self.daemon = start, False

    def cancel(self):
        pass

    join = cancel
