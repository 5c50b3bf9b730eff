"""Check an installed wheel: compiled kernels are there, and plan what they plan in Python.

``python check_wheel.py [compiled|Python]``: which kernels must be in it, compiled ones unless said.
Everything runs in processes of their own, as a user would run it.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

STONES = ("--count", "10", "--set", "width_px=120", "--set", "height_px=40", "--set", "courses=2")
PLAN = ("--wall", "120x40", "--scale", "1", "--seed", "1", "--budget", "1", "--quiet")
COMPLETE, INCOMPLETE = 0, 4
ALIKE = 1e-9  # numbers of plans: without a compiler another solver finds the load multipliers


def drystone(*words: str, kernels: str = "auto") -> str:
    """Run the command line with some kernels; return what it prints."""
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-m", "drystone", *words],
        check=False,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "DRYSTONE_KERNELS": kernels},
    )
    if ran.returncode not in (COMPLETE, INCOMPLETE):
        raise SystemExit(f"drystone {' '.join(words)} ended with {ran.returncode}")
    return ran.stdout


def check(wanted: str, folder: Path) -> None:
    """Plan a small wall by both methods and both kinds of kernels."""
    version = drystone("--version").strip()
    sys.stdout.write(version + "\n")
    if f"kernels: {wanted})" not in version:
        raise SystemExit(f"the kernels should be: {wanted}")
    stones = str(folder / "stones.png")
    drystone("generate", "rubble", "-o", stones, *STONES)
    for method in ("paper", "best"):
        plans = []
        for kernels in ("auto", "python"):
            output = folder / f"{method}-{kernels}"
            words = (stones, *PLAN, "--method", method, "-o", str(output))
            drystone("plan", *words, kernels=kernels)
            wall = (output / "wall.png").read_bytes()
            plans.append((wall, json.loads((output / "plan.json").read_bytes())))
        if plans[0][0] != plans[1][0] or not alike(plans[0][1], plans[1][1]):
            raise SystemExit(f"{method}: the kernels do not plan the same wall")
    sys.stdout.write("both kinds of kernels plan the same walls\n")


def alike(one: Any, other: Any) -> bool:
    """Say whether two plans are the same but for the last digits of numbers."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(alike(one[name], other[name]) for name in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=ALIKE, abs_tol=ALIKE)
    return bool(one == other)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        check(sys.argv[1] if sys.argv[1:] else "compiled", Path(name))
