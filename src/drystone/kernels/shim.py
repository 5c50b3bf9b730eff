"""What kernels use of Cython's pure-Python mode, for where they run as they are without Cython.

Kernels import `cython`, and this module where that is not installed.  It types nothing, and what
decorates leaves things as they are.
"""

from collections.abc import Callable
from typing import Any

compiled = False


def declare(_type: object, value: Any = None) -> Any:
    """Return the value of what is declared."""
    return value


def cast(_type: object, value: float) -> int:
    """Return the whole number that C would."""
    return int(value)


def exceptval(*_values: object, **_options: bool) -> Callable[[Any], Any]:
    """Decorate by nothing."""
    return cfunc


def cfunc(item: Any) -> Any:
    """Return what is decorated."""
    return item


cclass = inline = cfunc


class _Nogil:
    """Decorator and context: threads are Python's matter where nothing is compiled."""

    __call__ = staticmethod(cfunc)

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_error: object) -> None:
        pass


nogil = _Nogil()


def __getattr__(name: str) -> None:
    """Types have no meaning here: annotations are not evaluated, and `declare` ignores them."""
    if name.startswith("__"):
        raise AttributeError(name)
