"""The way from a photograph to a wall, as docs/tutorial.md prints it."""

import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tutorial.md"


def printed(kind):
    """The lines of the blocks of a kind."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return "".join(found).splitlines()


def test_the_photograph_becomes_a_wall_that_holds(tmp_path, monkeypatch, run):
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    lines = [line for line in printed("sh") if line.startswith("drystone")]
    segment, plan, check, *others = (shlex.split(line)[1:] for line in lines)
    assert [segment[0], plan[0], check[0]] == ["segment", "plan", "check"]
    assert [words[0] for words in others] == ["analyse", "craft", "export"]  # of what plan wrote
    plan += ["--budget", "1"]  # one wall shows that the way leads on; it may be a little low
    told = [run(*words) for words in (segment, plan, check)]
    assert [told[0].code, told[1].code in (0, 4), told[2].code] == [0, True, 0]
    text = printed("text")
    found = text[: next(k for k, line in enumerate(text) if line.startswith("complete"))]
    assert len(found) > 4
    assert set(found) <= set(told[0].out.splitlines())
    assert told[2].out.startswith("OK: wall/plan.json is valid")
