"""The Python of docs/viewer.md runs."""

import re
from pathlib import Path

import numpy as np
import pytest

from drystone.generate import BrickSettings, brick_stones, lay_out
from drystone.io.wall_image import write_labels

PAGE = Path(__file__).resolve().parents[3] / "docs" / "viewer.md"


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The programs of the page, in a folder where they can run."""
    monkeypatch.chdir(tmp_path)
    return re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)


def test_a_wall_that_was_not_planned_is_shown(programs: list[str]) -> None:
    bricks = BrickSettings(count=3, height_px=10, aspect=2)
    write_labels(lay_out(brick_stones(bricks, np.random.default_rng(1))), Path("wall.png"))
    exec(programs[1], {})  # noqa: S102 - our own page
    assert "Wall in the garden" in Path("report.html").read_text("utf-8")
