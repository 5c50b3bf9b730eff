"""Kernels as they run where nothing was compiled: the same sources, in Python.

Briefly: `tests/planner/test_same_bytes.py` plans walls by them, and all tests of this folder hold
for them (``DRYSTONE_KERNELS=python``).
"""

import os
import subprocess
import sys

import pytest

from drystone.kernels.backend import VARIABLE, describe

SCRIPT = """
import doctest, importlib, sys
from drystone.kernels import backend
for name in backend.kernel_names():
    if not name.startswith(("compiled.", "memory")):
        module = importlib.import_module(f"drystone.kernels.{name}")
        assert module.__file__.endswith(".py"), module.__file__
        tried = doctest.testmod(module)
        assert tried.failed == 0
        print(name, tried.attempted)
"""


@pytest.mark.skipif(describe() == "Python", reason="nothing is compiled here")
def test_the_examples_of_kernels_run_in_python_too() -> None:
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", SCRIPT],
        check=False,
        capture_output=True,
        text=True,
        env={**os.environ, VARIABLE: "python"},
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "seidel 1" in ran.stdout
