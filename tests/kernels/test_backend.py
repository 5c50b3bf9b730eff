"""Which kernels run, and that the choice can be made and is told."""

import subprocess
import sys

import pytest

from drystone.kernels import backend

FILES = """
from importlib import import_module
from drystone.kernels.backend import kernel_names
for name in kernel_names():
    if not name.startswith(("compiled.", "memory")):
        print(import_module(f"drystone.kernels.{name}").__file__)
"""


def test_nothing_compiled_is_used_where_python_is_asked_for(monkeypatch):
    for name in ("python", "numpy"):
        monkeypatch.setenv(backend.VARIABLE, name)
        assert backend.compiled("bits") is None
        assert backend.describe() == "Python"
    # What they do: `tests/planner/test_same_bytes.py` plans walls by them, and all tests of this
    # folder hold for them.
    ran = subprocess.run(  # noqa: S603 - our own code
        [sys.executable, "-c", FILES], check=True, stdout=subprocess.PIPE, text=True
    )
    assert len(ran.stdout.split()) > 15
    assert all(file.endswith(".py") for file in ran.stdout.split())


def test_what_was_not_built_or_is_unknown_is_an_error_only_when_it_must_be_there(monkeypatch):
    monkeypatch.setenv(backend.VARIABLE, "auto")
    assert backend.compiled("no_such_kernel") is None
    for choice, kernel in (("compiled", "no_such_kernel"), ("fortran", "bits")):
        monkeypatch.setenv(backend.VARIABLE, choice)
        with pytest.raises(ImportError, match=r"no_such_kernel|fortran"):
            backend.compiled(kernel)


def test_the_description_names_what_is_missing(monkeypatch):
    monkeypatch.setenv(backend.VARIABLE, "auto")
    monkeypatch.setattr(backend, "kernel_names", lambda: ["here", "gone"])
    monkeypatch.setattr(backend, "_is_compiled", lambda name: name == "here")
    assert backend.describe() == "compiled, Python: gone"
    monkeypatch.setenv(backend.VARIABLE, "compiled")
    assert backend.fault() == "gone: not compiled here"
    with pytest.raises(ImportError, match="not compiled here"):
        backend.require_nothing_compiled()
    monkeypatch.setattr(backend, "kernel_names", lambda: ["gone"])
    assert backend.fault() == "nothing is compiled here"
    monkeypatch.setattr(backend, "kernel_names", lambda: ["here"])
    assert backend.describe() == "compiled"
    assert backend.fault() is None
