"""Which kernels run, and that the choice can be made and is told."""

import sys
from types import ModuleType

import pytest

from drystone.kernels import backend


def test_numpy_is_used_when_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(backend.VARIABLE, "numpy")
    assert backend.compiled("bits") is None
    assert backend.describe() == "NumPy"


def test_what_was_not_built_is_an_error_only_when_it_must_be_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(backend.VARIABLE, "auto")
    assert backend.compiled("no_such_kernel") is None
    monkeypatch.setenv(backend.VARIABLE, "compiled")
    with pytest.raises(ImportError, match="no_such_kernel"):
        backend.compiled("no_such_kernel")


def test_an_unknown_choice_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(backend.VARIABLE, "fortran")
    with pytest.raises(ImportError, match="fortran"):
        backend.compiled("bits")


def test_the_description_names_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(backend.VARIABLE, "auto")
    monkeypatch.setattr(backend, "kernel_names", lambda: ["here", "gone"])
    monkeypatch.setitem(sys.modules, "drystone.kernels.compiled.here", ModuleType("here"))
    assert backend.describe() == "compiled, NumPy: gone"
    monkeypatch.setattr(backend, "kernel_names", lambda: ["here"])
    assert backend.describe() == "compiled"
