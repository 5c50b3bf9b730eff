"""Memory of kernels that are not compiled: lists to read from, and views of arrays to write into.

Python reads a list faster than an array.  What is compiled has pointers of the same names
(``memory.pyx``).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.backend import require_nothing_compiled

require_nothing_compiled()


def doubles(array: NDArray[Any]) -> list[Any]:
    """Return the numbers of an array, one after the other, to be read."""
    numbers: list[Any] = np.ravel(array).tolist()
    return numbers


ints = longs = flags = doubles


def doubles_out(array: NDArray[Any]) -> memoryview:
    """Return the numbers of an array, one after the other, to be written."""
    return array.reshape(-1).data


def pixels(array: NDArray[Any]) -> memoryview:
    """Return the numbers of any view, of which only a few are read."""
    return np.ascontiguousarray(array).reshape(-1).data


def stride(array: NDArray[Any], axis: int) -> int:
    """Return how far the numbers of :func:`pixels` are apart: from row to row (0), or in them."""
    return 1 if axis else int(array.shape[1])


labels_in = pixels
ints_out = longs_out = flags_out = doubles_out


def new_doubles(count: int) -> list[Any]:
    """Return room for so many numbers."""
    return [0] * count


def more_doubles(numbers: list[Any], count: int) -> list[Any]:
    """Return more room, with the same numbers."""
    return numbers + [0] * (count - len(numbers))


def kept_doubles(_room: list[Any], count: int) -> list[Any]:
    """Return room for so many numbers, which is given back with a list."""
    return [0] * count


def move_ints(to: list[Any], at: int, source: list[Any], start: int, count: int) -> None:
    """Write numbers over others, which they may overlap."""
    to[at : at + count] = source[start : start + count]


move_doubles = move_ints
new_longs = new_doubles
kept_ints = kept_flags = kept_doubles
more_longs = more_doubles


def release(_numbers: list[Any]) -> None:
    """Leave it to Python."""
