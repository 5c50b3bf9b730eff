"""The programs of docs/for-robotics.md that read what was exported run and find it."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.robot_plans import assembly

PAGE = Path(__file__).resolve().parents[3] / "docs" / "for-robotics.md"


def test_the_programs_of_the_page_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    wall = assembly("exact")
    for name in ("poses", "compas"):
        FORMATS[name].write(wall, tmp_path / "out", ExportSettings())
    monkeypatch.chdir(tmp_path)
    programs = re.findall(r"^```py\n(.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    assert len(programs) == 2
    names: dict[str, Any] = {}
    for program in programs:
        exec(compile(program, PAGE.name, "exec"), names)  # noqa: S102 - our own document
    printed = capsys.readouterr().out.split()
    assert [word for word in printed if "_" in word] == [part.name for part in wall.stones]
    standing = names["standing"]
    last = np.array([standing.vertex_coordinates(key) for key in standing.vertices()])
    count = len(wall.parts[-1].corners)
    assert last[:count, [0, 2]] == pytest.approx(wall.parts[-1].corners, abs=1e-9)
