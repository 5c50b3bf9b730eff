"""Plans are the same bytes with any kernels and any number of threads."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from drystone.kernels.backend import VARIABLE, describe
from tests.regression.test_same_plan import planned

METHODS = ("paper", "best")
PLAN, IMAGE = "plan.json", "wall.png"
SCRIPT = """
import sys
from pathlib import Path
from drystone.kernels.backend import describe
from tests.regression.test_same_plan import planned
for method in sys.argv[2:]:
    planned(method, Path(sys.argv[1]) / method)
print(describe())
"""


@pytest.mark.parametrize("method", METHODS)
def test_threads_do_not_shape_the_plan(method: str, tmp_path: Path) -> None:
    one, *more = (planned(method, tmp_path / str(jobs), n_jobs=jobs) for jobs in (1, 2, 4))
    assert more == [one, one]


def test_kernels_do_not_shape_the_plan(tmp_path: Path) -> None:
    if describe() == "NumPy":
        pytest.skip("the kernels here are those in NumPy already")
    there = tmp_path / "there"
    there.mkdir()
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", SCRIPT, str(there), *METHODS],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
        cwd=Path(__file__).parents[2],
        env={**os.environ, VARIABLE: "numpy"},
    )
    assert ran.stdout.strip() == "NumPy"
    for method in METHODS:
        here = planned(method, tmp_path / method)
        assert here == tuple((there / method / name).read_bytes() for name in (PLAN, IMAGE))
