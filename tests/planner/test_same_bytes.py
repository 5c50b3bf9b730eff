"""Plans are the same bytes with any number of threads, and the same walls with any kernels."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from drystone.io.plan_json import write_plan
from drystone.io.wall_image import write_wall_image
from drystone.kernels.backend import VARIABLE, describe
from drystone.search.plan_wall import plan_wall
from tests.planner.scenes import WITH_WEDGES, few_stones, greedy
from tests.regression.test_same_plan import planned

WALLS = {
    "energy": {"selection_rule": "score", "search": {"budget": 2}},
    "pivot": {"selection_rule": "algorithm2", "settle": {"method": "pivot"}, "mu": 0.4},
    "wedges": dict(WITH_WEDGES),
}
"""What is changed in the default method, on outlines."""

PLAN, IMAGE = "plan.json", "wall.png"
SCRIPT = """
import sys
from pathlib import Path
from drystone.kernels.backend import describe
from tests.planner.test_same_bytes import WALLS, exact
from tests.regression.test_same_plan import planned
for name in sys.argv[2:]:
    folder = Path(sys.argv[1]) / name
    exact(name, folder) if name in WALLS else planned(name, folder)
print(describe())
"""


def exact(name, folder, n_jobs=1):
    """The bytes of plan.json and wall.png of a few stones on outlines; in metres, at half size."""
    stones, settings = few_stones(), greedy(WALLS[name])
    result = plan_wall(
        stones, 84, 34, scale=0.5, seed=3, settings=settings, n_jobs=n_jobs, px_per_m=437.3
    )
    assert len(result.wall.groups) >= 3
    assert result.wall.wedges or name != "wedges"
    folder.mkdir()
    write_plan(result.plan, folder / PLAN)
    image = write_wall_image(result.wall.labels, folder)
    return (folder / PLAN).read_bytes(), image.read_bytes()


LOADS = {"LLC", "F_LR", "F_LR_coulomb", "F_LR_no_setback", "alpha_left", "alpha_right"}
"""What the linear programs say: without a compiler HiGHS solves them, to other last bits."""


def parted(plan):
    """A plan without its load factors, and the load factors."""
    if isinstance(plan, list):
        parts = [parted(value) for value in plan]
        return [part[0] for part in parts], [load for part in parts for load in part[1]]
    if isinstance(plan, dict):
        loads = [value for key, value in plan.items() if key in LOADS and value is not None]
        rest = {key: value for key, value in plan.items() if key not in LOADS or value is None}
        poses, more = parted(list(rest.values()))
        return dict(zip(rest, poses, strict=True)), loads + more
    return plan, []


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The bytes of every wall as one thread plans it, with the kernels that are here."""
    folder = tmp_path_factory.mktemp("alone")
    return {name: exact(name, folder / name) for name in WALLS}


@pytest.mark.parametrize("name", WALLS)
def test_threads_do_not_shape_walls_of_outlines(name, alone, tmp_path):
    assert exact(name, tmp_path / "3", n_jobs=3) == alone[name]


def test_kernels_do_not_shape_the_plan(alone, tmp_path):
    if describe() == "Python":
        pytest.skip("the kernels here run in Python already")
    there = tmp_path / "there"
    there.mkdir()
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", SCRIPT, str(there), "paper", *WALLS],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
        env={**os.environ, VARIABLE: "python"},
    )
    assert ran.stdout.strip() == "Python"
    for name, here in {"paper": planned("paper", tmp_path / "paper"), **alone}.items():
        plan, image = ((there / name / file).read_bytes() for file in (PLAN, IMAGE))
        assert here[1] == image
        (poses, loads), (same, near) = (parted(json.loads(one)) for one in (here[0], plan))
        assert poses == same
        assert len(loads) >= 9
        assert loads == pytest.approx(near, abs=1e-12)
