"""Reading the parts of a block model file: numbers, lists, friction, and interfaces."""

from collections.abc import Collection, Mapping, Sequence
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.contacts.blocks import check_mu
from drystone.errors import InputError
from drystone.statics.model import GROUND, Interface

Points = NDArray[np.float64]


LARGEST = 1e50
"""Of numbers: moments, products of three of them, must not overflow."""


def bad(what: str, where: str, cure: str) -> InputError:
    """Return the error (E303) for what is no block model."""
    return InputError("E303", what, where=where, cure=cure)


def read_list(data: Mapping[str, Any], key: str) -> Sequence[Any]:
    """Return a list of the file."""
    value = data[key]
    if not isinstance(value, list | tuple):
        raise bad(f"'{key}' is not a list.", "block model", f"Give a list of {key}.")
    return value


def read_numbers(value: Any, shape: tuple[int, ...], where: str) -> Points:
    """Read finite numbers; -1 in `shape` stands for any length."""
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    fits = array.ndim == len(shape) and all(
        n in (m, -1) for n, m in zip(shape, array.shape, strict=True)
    )
    if not fits or not np.isfinite(array).all():
        raise bad(f"{value!r} is not made of finite numbers as it should be.", where, "Correct it.")
    if np.abs(array).max(initial=0.0) > LARGEST:
        raise bad(f"{value!r} holds a number above {LARGEST:g}.", where, "Use another unit.")
    return array


def read_mu(data: Mapping[str, Any], key: str, default: float) -> float:
    """Read a coefficient of friction."""
    mu = data.get(key, default)
    if not isinstance(mu, int | float) or isinstance(mu, bool):
        raise bad(f"{key} is {mu!r}.", key, "Give a number.")
    try:
        mu = float(mu)
    except OverflowError:  # a whole number of hundreds of digits
        mu = inf
    check_mu(mu)
    return mu


def read_friction(entries: Sequence[Any], ids: Collection[int]) -> dict[tuple[int, int], float]:
    """Read the friction of pairs of blocks."""
    friction = {}
    for place, entry in enumerate(entries):
        where = f"friction, entry {place + 1}"
        pair = _between(entry, ids, where)
        friction[pair] = read_mu(entry, "mu", 0.58)
    return friction


def read_interfaces(entries: Sequence[Any], ids: Collection[int]) -> tuple[Interface, ...]:
    """Read where blocks touch."""
    found = []
    for place, entry in enumerate(entries):
        where = f"interfaces, entry {place + 1}"
        block, other = _between(entry, ids, where)
        if block == GROUND:
            raise bad("the ground is its first block.", where, "Name it second.")
        points = read_numbers(entry.get("points"), (-1, 2), where)
        normal = read_numbers(entry.get("normal"), (2,), where)
        length = float(np.hypot(*normal))
        if len(points) == 0 or length == 0:
            raise bad("it has no points or no normal.", where, "Give both.")
        mu = read_mu(entry, "mu", 0.0) if "mu" in entry else None
        x, y = (normal / length).tolist()
        if len(points) > 2:  # others go by the first and the last one as its ends
            points = points[np.argsort(points @ (y, -x), kind="stable")]
        found.append(Interface(block, other, points, (x, y), mu))
    return tuple(found)


def _between(entry: Any, ids: Collection[int], where: str) -> tuple[int, int]:
    pair = entry.get("between") if isinstance(entry, Mapping) else None
    known = [GROUND, *ids]
    if (
        not isinstance(pair, list | tuple)
        or len(pair) != 2
        or not all(isinstance(one, int) and one in known for one in pair)
    ):
        raise bad(f"it is between {pair!r}.", where, 'Give "between": two ids; 0 is the ground.')
    if pair[0] == pair[1]:
        raise bad(f"it is between {pair[0]} and itself.", where, "Name two blocks.")
    return pair[0], pair[1]
