"""Which kernels run: compiled ones where they were built, otherwise those in NumPy.

Both give the same results, bit by bit; the environment variable ``DRYSTONE_KERNELS`` chooses:
``auto`` (the default), ``numpy``, or ``compiled``, which fails when they were not built.
"""

import os
from importlib import import_module
from pathlib import Path
from types import ModuleType

VARIABLE = "DRYSTONE_KERNELS"
CHOICES = ("auto", "numpy", "compiled")


def compiled(name: str) -> ModuleType | None:
    """Return a compiled kernel module; None when the one in NumPy is to be used.

    Parameters
    ----------
    name : str
        Of a module of :mod:`drystone.kernels.compiled`.

    Raises
    ------
    ImportError
        When compiled kernels are asked for and were not built, or the choice is unknown.
    """
    choice = os.environ.get(VARIABLE) or "auto"
    if choice not in CHOICES:
        raise ImportError(f"{VARIABLE} is {choice!r}; it must be one of {', '.join(CHOICES)}")
    if choice == "numpy":
        return None
    try:
        return import_module(f"drystone.kernels.compiled.{name}")
    except ImportError:
        if choice == "compiled":
            raise
        return None


def fault() -> str | None:
    """Say what is wrong with the choice that the environment makes; None when nothing is."""
    try:
        for name in kernel_names():
            compiled(name)
    except ImportError as error:
        return str(error)
    return None


def kernel_names() -> list[str]:
    """Return the names of all kernels that can be compiled, as they are in the package."""
    folder = Path(__file__).parent / "compiled"
    return sorted(path.stem for path in folder.glob("*.pyx"))


def describe() -> str:
    """Say which kernels run: ``"compiled"``, ``"NumPy"``, or ``"compiled, NumPy: ..."``."""
    names = kernel_names()
    missing = [name for name in names if compiled(name) is None]
    if len(missing) == len(names):
        return "NumPy"
    return "compiled" if not missing else f"compiled, NumPy: {', '.join(missing)}"
