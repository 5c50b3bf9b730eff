"""Frozen settings from nested mappings, as TOML files and options give them."""

import dataclasses
import math
import re
import types
from collections.abc import Iterator, Mapping
from typing import Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from drystone.errors import UsageError, meant

Settings = TypeVar("Settings")

_KINDS: Mapping[Any, str] = types.MappingProxyType(
    {
        bool: "true or false",
        int: "a whole number",
        float: "a number",
        str: "a text",
        types.NoneType: "nothing",
    }
)

_LARGEST = 1e12
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


def ranged(
    default: float,
    *,
    least: float | None = None,
    above: float | None = None,
    most: float | None = None,
    below: float | None = None,
) -> Any:
    """Return the field of a number with its range, which :class:`Ranged` checks.

    The ends `least` and `most` are allowed themselves, `above` and `below` are not.  A default that
    is an int is that of a whole number.
    """
    ends = {"least": least, "above": above, "most": most, "below": below}
    allowed = {name: end for name, end in ends.items() if end is not None}
    return dataclasses.field(default=default, metadata=allowed)


def range_text(allowed: Mapping[str, float]) -> str:
    """Write a range as in mathematics, or as a bound where it has one end."""
    low = allowed.get("least", allowed.get("above"))
    high = allowed.get("most", allowed.get("below"))
    if low is None or high is None:
        words = {"least": "at least", "above": "above", "most": "at most", "below": "below"}
        return " and ".join(f"{words[name]} {end:g}" for name, end in allowed.items())
    begin, end = "[" if "least" in allowed else "(", "]" if "most" in allowed else ")"
    return f"in {begin}{low:g}, {high:g}{end}"


class Ranged:
    """Settings that check themselves: choices by their types, numbers by their ranges.

    ValueError: a value is not one of the choices, or out of its range.
    """

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            value, allowed = getattr(self, field.name), field.metadata
            if get_origin(field.type) is Literal and value not in get_args(field.type):
                choices = ", ".join(map(repr, get_args(field.type)))
                raise ValueError(f"{field.name} must be one of {choices}, not {value!r}")
            # Said so that what is not a number is out of every range.
            if allowed and not (
                allowed.get("least", -math.inf) <= value <= allowed.get("most", math.inf)
                and allowed.get("above", -math.inf) < value < allowed.get("below", math.inf)
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
        elif isinstance(value, float) and not abs(value) <= _LARGEST:
            raise ValueError(f"{field.name} must be a finite number up to 1e12, not {value}")


def _checked(value: Any, hint: Any, where: str) -> Any:
    """Return a value of the declared type, or raise UsageError."""
    value = _plain(value)
    if get_origin(hint) is Literal:
        allowed = get_args(hint)
        if value not in allowed:
            raise _refused(f"{where} = {value!r}.", f"Choose from {allowed}.")
        return value
    if isinstance(value, float) and not math.isfinite(value):
        raise _refused(f"{where} = {value}.", "Give a finite number.")
    if isinstance(value, int) and abs(value) > _MOST:
        raise _refused(f"the number of {where} is too large.", f"Give one of at most {_MOST}.")
    if get_origin(hint) is tuple:
        kind = get_args(hint)[0]
        several = list(map(_plain, value)) if isinstance(value, list | tuple) else [None]
        if any(not isinstance(one, kind) or isinstance(one, bool) for one in several):
            wrong = f"{where} = {value!r} has the wrong type."
            wanted = "texts" if kind is str else "whole numbers"
            raise _refused(wrong, f"Give a list of {wanted}.")
        return tuple(_checked(one, kind, where) for one in several)
    kinds = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    if float in kinds and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        wanted = " or ".join(_KINDS[kind] for kind in kinds)
        raise _refused(f"{where} = {value!r} has the wrong type.", f"Give {wanted}.")
    return value


def _plain(value: Any) -> Any:
    """Return numbers and arrays of NumPy as Python's own."""
    return value.tolist() if isinstance(value, np.generic | np.ndarray) else value


def _refused(message: str, cure: str) -> UsageError:
    return UsageError("E123", message, where="settings", cure=cure)
