"""Equal runs give equal bytes: with any number of jobs, in another process, with any kernels."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from drystone import method_settings, plan_wall, write_plan
from drystone.io.wall_image import write_wall_image
from drystone.kernels.backend import VARIABLE
from tests.planner.scenes import WITH_WEDGES, few_stones, greedy, rubble

FEW = {"scale": 0.5, "seed": 3, "px_per_m": 437.3}
PIVOT = {**WITH_WEDGES, "settle": {"method": "pivot"}, "mu": 0.4}
WALLS = {
    "paper": (rubble(5, 6), (100, 36), {"scale": 1.0, "seed": 7}, method_settings("paper")),
    "best": (few_stones(), (84, 34), FEW, greedy({"search": {"budget": 2}})),
    "pivot": (few_stones(), (84, 34), FEW, greedy(PIVOT)),
}
"""Stones, size, options and settings; the last two are on outlines, in metres, at half size."""

PLAN, IMAGE = "plan.json", "wall.png"
SCRIPT = """
import sys
from pathlib import Path
from drystone.kernels.backend import describe
from tests.planner.test_same_bytes import planned
for name in sys.argv[2:]:
    planned(name, Path(sys.argv[1]) / name)
print(describe())
"""


def planned(name, folder, n_jobs=1):
    """The bytes of plan.json and wall.png of a small wall."""
    stones, size, options, settings = WALLS[name]
    result = plan_wall(stones, *size, settings=settings, n_jobs=n_jobs, **options)
    assert len(result.wall.groups) >= 3
    assert result.wall.wedges or name != "pivot"
    folder.mkdir()
    write_plan(result.plan, folder / PLAN)
    image = write_wall_image(result.wall.labels, folder)
    return (folder / PLAN).read_bytes(), image.read_bytes()


LOADS = {"LLC", "F_LR", "F_LR_coulomb", "F_LR_no_setback", "alpha_left", "alpha_right"}
"""What the linear programs say: without a compiler HiGHS solves them, to other last bits."""


def parted(text):
    """A plan without its load factors, and the load factors."""
    loads = []

    def without(part):
        told = [key for key in part if key in LOADS and part[key] is not None]
        loads.extend(part.pop(key) for key in told)
        return part

    return json.loads(text, object_hook=without), loads


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The bytes of every wall as one thread plans it, with the kernels that are here."""
    folder = tmp_path_factory.mktemp("alone")
    return {name: planned(name, folder / name) for name in WALLS}


@pytest.mark.parametrize("name", WALLS)
def test_threads_and_processes_do_not_shape_walls(name, alone, tmp_path):
    n_jobs = 3 if name == "pivot" else 2
    assert planned(name, tmp_path / "jobs", n_jobs=n_jobs) == alone[name]


def test_neither_kernels_nor_the_order_of_sets_shape_the_plan(alone, tmp_path):
    """Another process has kernels in Python, and another seed of Python's hashes."""
    changes = {"PYTHONPATH": "src", VARIABLE: "python", "PYTHONHASHSEED": "123"}
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", SCRIPT, str(tmp_path), *WALLS],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
        env={**os.environ, **changes},
    )
    assert ran.stdout.strip() == "Python"
    for name in WALLS:
        plan, image = ((tmp_path / name / file).read_bytes() for file in (PLAN, IMAGE))
        assert alone[name][1] == image
        (poses, loads), (same, near) = parted(alone[name][0]), parted(plan)
        assert poses == same
        assert len(loads) >= 9
        assert loads == pytest.approx(near, abs=1e-12)
