"""Equal runs give equal bytes: in one process, in another one, and with any number of jobs."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from drystone.generate import RubbleSettings, rubble_stones
from drystone.io.plan_json import write_plan
from drystone.io.wall_image import write_wall_image
from drystone.planner.settings import method_settings
from drystone.search.plan_wall import plan_wall

SCRIPT = """
import sys
from pathlib import Path
from tests.regression.test_same_plan import planned
sys.stdout.buffer.write(b"|".join(planned(sys.argv[1], Path(sys.argv[2]))))
"""


def planned(method, folder, n_jobs=1):
    """The bytes of plan.json and wall.png of a small wall."""
    size = RubbleSettings(count=10, width_px=100, height_px=36, courses=2)
    stones = rubble_stones(size, np.random.default_rng(5))
    settings = method_settings(method)
    settings = settings.updated({"search": {"budget": min(2, settings.search.budget)}})
    result = plan_wall(
        stones, 100, 36, scale=1.0, seed=7, method=method, settings=settings, n_jobs=n_jobs
    )
    folder.mkdir()
    write_plan(result.plan, folder / "plan.json")
    image = write_wall_image(result.wall.labels, folder)
    return (folder / "plan.json").read_bytes(), image.read_bytes()


@pytest.mark.parametrize("method", ["paper", "best"])
def test_equal_runs_give_equal_bytes(method, tmp_path):
    first = planned(method, tmp_path / "first")
    assert planned(method, tmp_path / "two jobs", n_jobs=2) == first
    if method == "best":
        # Another seed of Python's hashes: the order of a set must not shape a plan.
        there = subprocess.run(  # noqa: S603 - our own code
            [sys.executable, "-c", SCRIPT, method, str(tmp_path / "there")],
            capture_output=True,
            check=True,
            cwd=Path(__file__).parents[2],
            env={"PYTHONHASHSEED": "123", "PYTHONPATH": "src"},
        )
        assert there.stdout == b"|".join(first)
