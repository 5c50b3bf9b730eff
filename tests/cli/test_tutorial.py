"""The way from a photograph to a wall, as docs/tutorial.md prints it."""

import re
import shlex
from pathlib import Path

import pytest

from tests.cli.conftest import Run

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tutorial.md"


def printed(kind: str) -> list[str]:
    """The lines of the blocks of a kind."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return "".join(found).splitlines()


def test_the_commands_lead_from_the_photograph_to_the_build_sheet(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, run: Run
) -> None:
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    lines = [line for line in printed("sh") if line.startswith("drystone")]
    commands = [shlex.split(line)[1:] for line in lines]
    names = ["segment", "plan", "check", "analyse", "craft", "export"]
    assert [words[0] for words in commands] == names
    # The page builds twenty walls. One shows that the way leads on, and stays a bit low (4).
    commands[1][commands[1].index("--budget") + 1] = "1"
    told = dict(zip(names, (run(*words) for words in commands), strict=True))
    assert {name: one.code for name, one in told.items()} == {**dict.fromkeys(names, 0), "plan": 4}
    found = printed("text")
    found = found[: next(k for k, line in enumerate(found) if line.startswith("complete"))]
    assert len(found) > 4
    assert set(found) <= set(told["segment"].out.splitlines())
    assert (tmp_path / "wall" / "build-sheet.pdf").exists()
    assert (tmp_path / "wall" / "report.html").exists()
