"""Which kernels run: compiled ones where they were built, otherwise the same in Python.

A kernel is one source that Cython compiles in place; Python takes what is compiled first.  A few
are written in Cython and, for where that is not compiled, in NumPy.  Both ways give the same
results, bit by bit, but for the simplex, which exists compiled only.  The environment variable
``DRYSTONE_KERNELS`` chooses: ``auto`` (the default), ``python`` (``numpy`` in older scripts), or
``compiled``, which fails when they were not built.
"""

import os
import sys
from importlib import import_module
from importlib.machinery import SOURCE_SUFFIXES, FileFinder, SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

VARIABLE = "DRYSTONE_KERNELS"
CHOICES = ("auto", "python", "compiled")
FOLDER = Path(__file__).parent


def choice() -> str:
    """Return what the environment chooses, by its present name; ImportError when unknown."""
    chosen = os.environ.get(VARIABLE) or "auto"
    if chosen not in (*CHOICES, "numpy"):
        raise ImportError(f"{VARIABLE} must be one of {', '.join(CHOICES)}, not {chosen!r}")
    return "python" if chosen == "numpy" else chosen


def take_sources(folder: str) -> None:
    """Let Python import sources of a folder where they are asked for, even if compiled."""
    if os.environ.get(VARIABLE) in ("python", "numpy"):
        sys.path_importer_cache[folder] = FileFinder(folder, (SourceFileLoader, SOURCE_SUFFIXES))


def require_nothing_compiled() -> None:
    """Raise ImportError where a kernel runs in Python and compiled ones were asked for."""
    if choice() == "compiled":
        raise ImportError(f"{VARIABLE} is 'compiled', and kernels were not compiled here")


def compiled(name: str) -> ModuleType | None:
    """Return a module of :mod:`drystone.kernels.compiled`; None when NumPy is to be used instead.

    ImportError when compiled kernels are asked for and were not built, or the choice is unknown.
    """
    chosen = choice()
    if chosen == "python":
        return None
    try:
        return import_module(f"drystone.kernels.compiled.{name}")
    except ImportError:
        if chosen == "compiled":
            raise
        return None


def fault() -> str | None:
    """Say what is wrong with the choice that the environment makes; None when nothing is."""
    try:
        missing = missing_kernels() if choice() == "compiled" else []
    except ImportError as error:
        return str(error)
    if missing and missing == kernel_names():
        return "nothing is compiled here"
    return f"{', '.join(missing)}: not compiled here" if missing else None


def kernel_names() -> list[str]:
    """Return the names of all kernels that can be compiled, as they are in the package."""
    sources = [
        *FOLDER.rglob("*.pyx"),
        *(path for path in FOLDER.rglob("*.py") if b"import cython\n" in path.read_bytes()),
    ]
    return sorted(".".join(path.relative_to(FOLDER).with_suffix("").parts) for path in sources)


def missing_kernels() -> list[str]:
    """Return the names of those that do not run compiled."""
    if choice() == "python":
        return kernel_names()
    return [name for name in kernel_names() if not _is_compiled(name)]


def _is_compiled(name: str) -> bool:
    spec = find_spec(f"drystone.kernels.{name}")
    return spec is not None and not (spec.origin or "").endswith(tuple(SOURCE_SUFFIXES))


def describe() -> str:
    """Say which kernels run: ``"compiled"``, ``"Python"``, or ``"compiled, Python: ..."``."""
    missing = missing_kernels()
    if len(missing) == len(kernel_names()):
        return "Python"
    return "compiled" if not missing else f"compiled, Python: {', '.join(missing)}"
