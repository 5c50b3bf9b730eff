"""Frozen settings from nested mappings, as TOML files and options give them; types of values."""

import dataclasses
import functools
import inspect
import math
import os
import re
import reprlib
import types
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from operator import index
from pathlib import Path
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from drystone.errors import UsageError, meant

Settings = TypeVar("Settings")
Called = TypeVar("Called", bound=Callable[..., Any])

_KINDS = {
    bool: "true or false", int: "a whole number", float: "a number", str: "a text",
    tuple: "a list", Iterable: "a list", types.NoneType: "None",
}  # fmt: skip


def of_type(value: Any, hint: Any, name: str) -> Any:
    """Return a value of a type: numbers of NumPy are made Python's, and lists tuples of one type.

    TypeError: it is of another type; ValueError: it is none of the choices.
    """
    kinds = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    for one in kinds:
        kind, of = get_origin(one) or (os.PathLike if one is Path else one), get_args(one)
        if kind in (int, float):
            takes = "__index__" if kind is int else "__float__"
            # A truth value is none, though it is one to Python.
            if hasattr(value, takes) and not isinstance(value, bool | np.bool_):
                return index(value) if kind is int else float(value)
        elif kind is Literal:
            if value not in of:
                raise ValueError(f"{name} must be one of {str(of)[1:-1]}, not {value!r}")
            return value
        elif kind is tuple and isinstance(value, Collection) and not isinstance(value, str):
            return tuple(of_type(each, of[0], f"each of {name}") for each in value)
        elif kind is Any or isinstance(value, kind):
            return value
        elif kind is np.ndarray:
            with suppress(ValueError):  # rows of several lengths are no array
                if np.ndim(value):
                    return value
    said = " or ".join(_KINDS.get(get_origin(one) or one) or one.__name__ for one in kinds)
    raise TypeError(f"{name} must be {said}, not {reprlib.repr(value)}")


def typed(called: Called) -> Called:
    """Let a function, or a class, have its arguments as :func:`of_type` returns them."""
    if isinstance(called, type):
        called.__init__ = typed(called.__init__)  # type: ignore[misc]
        return called
    signature, hints = inspect.signature(called), functools.cache(get_type_hints)

    @functools.wraps(called)
    def checked(*args: Any, **kwargs: Any) -> Any:
        given = signature.bind(*args, **kwargs)
        for name, value in given.arguments.items():
            hint = hints(called).get(name, Any)
            if get_origin(hint) is not Literal:  # what is none of the choices has a code
                given.arguments[name] = of_type(value, hint, name)
        return called(*given.args, **given.kwargs)

    return checked  # type: ignore[return-value]


_MOST = 2**63 - 1
"""What arrays hold; Python reads longer ones from files and options."""


def updated(settings: Settings, changes: Mapping[str, Any], prefix: str = "") -> Settings:
    """Return settings with some values replaced, checked against the declared types.

    Frozen settings may contain settings; `changes` is nested in the same way, and missing keys stay
    as they are.  `prefix` says where the settings stand in larger ones.  UsageError (E123): an
    unknown name, a wrong type, or a value out of range.
    """
    hints = get_type_hints(type(settings))
    values = {}
    for name, value in changes.items():
        where = f"{prefix}{name}"
        if name not in hints:
            near = meant(name, _names(settings), prefix).strip()
            cure = near or f"Known here: {', '.join(hints)}."
            raise _refused(f"there is no setting {where!r}.", cure)
        current = getattr(settings, name)
        if dataclasses.is_dataclass(current):
            if not isinstance(value, Mapping):
                inside = ", ".join(get_type_hints(type(current)))
                raise _refused(f"{where!r} is a table of settings.", f"It holds {inside}.")
            values[name] = updated(current, value, f"{where}.")
        else:
            values[name] = _checked(value, hints[name], where)
    try:
        return dataclasses.replace(settings, **values)  # type: ignore[type-var]
    except ValueError as error:
        where = f"settings {prefix.removesuffix('.')}".rstrip()
        # The values that the message speaks of, or the few that were given.
        spoken_of = [name for name in values if re.search(rf"\b{name}\b", str(error))]
        names = [f"{prefix}{name}" for name in spoken_of or values]
        cure = f"Change {' or '.join(names)}." if len(names) <= 3 else "Change the value."
        raise UsageError("E123", f"{error}.", where=where, cure=cure) from None


def _names(settings: Any) -> Iterator[str]:
    """Yield the names of settings, with those of the settings within them."""
    for field in dataclasses.fields(settings):
        yield field.name
        if dataclasses.is_dataclass(value := getattr(settings, field.name)):
            yield from (f"{field.name}.{name}" for name in _names(value))


def flat(
    settings: Mapping[str, Any], above: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield nested settings one by one, with the names that lead to each, the outer first.

    >>> dict(flat({"mu": 0.58, "placement": {"rule": "eq12"}}))
    {('mu',): 0.58, ('placement', 'rule'): 'eq12'}
    """
    for name, value in settings.items():
        if isinstance(value, Mapping):
            yield from flat(value, (*above, name))
        else:
            yield (*above, name), value


def nested(settings: Iterable[tuple[Sequence[str], Any]]) -> dict[str, Any]:
    """Nest settings, each with the names that lead to it; the reverse of :func:`flat`.

    >>> nested([(("placement", "rule"), "eq12"), (("mu",), 0.58)])
    {'placement': {'rule': 'eq12'}, 'mu': 0.58}
    """
    tables: dict[str, Any] = {}
    for (*above, last), value in settings:
        table = tables
        for name in above:
            table = table.setdefault(name, {})
        table[last] = value
    return tables


def ranged(
    default: float,
    *,
    least: float | None = None,
    above: float | None = None,
    most: float | None = None,
    below: float | None = None,
    within: tuple[float | str, ...] | None = None,
) -> Any:
    """Return the field of a number with its range, which :class:`Ranged` checks.

    The ends `least` and `most` are allowed themselves, `above` and `below` are not; nor is more
    than the product of other settings `within`.  A default that is an int is that of a whole
    number.
    """
    ends = {"least": least, "above": above, "most": most, "below": below, "within": within}
    allowed = {name: end for name, end in ends.items() if end is not None}
    return dataclasses.field(default=default, metadata=allowed)


def range_text(allowed: Mapping[str, Any]) -> str:
    """Write a range as in mathematics, or as a bound where it has one end."""
    if "within" in allowed:
        ends = {name: end for name, end in allowed.items() if name != "within"}
        parts = (f"`{one}`" if isinstance(one, str) else f"{one:g}" for one in allowed["within"])
        return f"{range_text(ends)} and at most {' times '.join(parts)}"
    low = allowed.get("least", allowed.get("above"))
    high = allowed.get("most", allowed.get("below"))
    if low is None or high is None:
        words = {"least": "at least", "above": "above", "most": "at most", "below": "below"}
        return " and ".join(f"{words[name]} {end:g}" for name, end in allowed.items())
    begin, end = "[" if "least" in allowed else "(", "]" if "most" in allowed else ")"
    return f"in {begin}{low:g}, {high:g}{end}"


class Ranged:
    """Settings that check themselves: by their types, numbers by their ranges.

    TypeError: a value is of another type; ValueError: it is not one of the choices, or out of its
    range.
    """

    def __post_init__(self) -> None:
        # What others are measured by comes first.
        fields = dataclasses.fields(self)  # type: ignore[arg-type]
        for field in sorted(fields, key=lambda one: "within" in one.metadata):
            value = of_type(getattr(self, field.name), field.type, field.name)
            object.__setattr__(self, field.name, value)
            allowed = field.metadata
            within = (vars(self).get(one, one) for one in allowed.get("within", (math.inf,)))
            # Said so that what is not a number is out of every range.
            if allowed and not (
                allowed.get("least", -math.inf) <= value <= allowed.get("most", math.inf)
                and allowed.get("above", -math.inf) < value < allowed.get("below", math.inf)
                and value <= math.prod(within)
            ):
                raise ValueError(f"{field.name} must be {range_text(allowed)}, not {value}")


def check_finite(settings: Any) -> None:
    """Raise ValueError when a number in settings, or in settings within them, is not finite.

    One beyond 1e12 is as good as that: its square is no length or cost that can be compared.
    """
    for field in dataclasses.fields(settings):
        value = getattr(settings, field.name)
        if dataclasses.is_dataclass(value):
            check_finite(value)
        elif isinstance(value, float) and not abs(value) <= 1e12:
            raise ValueError(f"{field.name} must be a finite number up to 1e12, not {value}")


def _checked(value: Any, hint: Any, where: str) -> Any:
    """Return a value of the declared type, or raise UsageError."""
    for one in value if isinstance(value, list | tuple) else (value,):
        if isinstance(one, float) and not math.isfinite(one):
            raise _refused(f"{where} = {one}.", "Give a finite number.")
        if isinstance(one, int) and abs(one) > _MOST:
            raise _refused(f"the number of {where} is too large.", f"Give one of at most {_MOST}.")
    try:
        return of_type(value, hint, where)
    except (TypeError, ValueError) as error:
        raise _refused(f"{error}.", f"Change {where}.") from None


def _refused(message: str, cure: str) -> UsageError:
    return UsageError("E123", message, where="settings", cure=cure)
