"""Everything that is benchmarked runs, once, on small inputs."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_every_benchmark_runs_once():
    words = "-m pytest benchmarks -q -p no:xdist -p no:cacheprovider --sizes smoke"
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, *words.split(), "--benchmark-disable"],
        check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=ROOT,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    assert " passed" in ran.stdout
