"""Frozen dataclasses as JSON, and back again by their types."""

import dataclasses
import json
import math
import operator
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from types import UnionType
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

Value = TypeVar("Value")


def as_json(value: Any) -> str:
    """Return a value as JSON: dataclasses as objects, tuples as lists, floats with all digits.

    Infinite floats are written as Python reads them.
    """
    return json.dumps(value, default=_shallow, separators=(",", ":"))


def _shallow(value: Any) -> Any:
    if dataclasses.is_dataclass(value):
        return {name: getattr(value, name) for name in _types(value.__class__)}
    return operator.index(value)


def to_plain(kind: Any, value: Any) -> Any:
    """Return a value of a declared type in JSON's own types; equal values give equal text."""
    kinds = get_args(kind)
    if value is None:
        return None
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        return {name: to_plain(one, getattr(value, name)) for name, one in _types(kind).items()}
    if get_origin(kind) is tuple:
        several = kinds[:1] * len(value) if kinds[-1] is Ellipsis else kinds
        return [to_plain(one, item) for one, item in zip(several, value, strict=True)]
    if get_origin(kind) is Mapping:
        return {name: to_plain(kinds[1], item) for name, item in value.items()}
    if kind is int:
        return operator.index(value)
    # Adding zero turns -0.0 into 0.0: the two are equal.
    return float(value) + 0.0 if float in (kind, *kinds) else value


def from_plain(kind: type[Value], data: Any) -> Value:
    """Return what :func:`as_json` was given, once its JSON is read."""
    found: Value = _read(kind, data)
    return found


def _read(kind: Any, data: Any) -> Any:
    origin, kinds = get_origin(kind), get_args(kind)
    if dataclasses.is_dataclass(kind):
        return _dataclass(kind, data)
    if origin is UnionType:
        for one in kinds[:-1]:
            with suppress(ValueError):
                return _read(one, data)
        return _read(kinds[-1], data)
    if origin is tuple:
        return _tuple(kinds, data)
    if kind is float and isinstance(data, int | float) and not isinstance(data, bool):
        return _float(data)
    if origin is Mapping and isinstance(data, dict):
        data = {name: _read(kinds[1], item) for name, item in data.items()}
        known = True
    elif origin is Literal:
        known = isinstance(data, str) and data in kinds
    else:
        known = origin is None and type(data) is kind
    if known:
        return data
    raise ValueError(f"{str(data)[:40]!r} is not of type {kind}")


def _dataclass(kind: Any, data: Any) -> Any:
    types = _types(kind)
    if not isinstance(data, dict) or data.keys() != types.keys():
        raise ValueError(f"this is not of type {kind.__name__}")
    return kind(**{name: _read(one, data[name]) for name, one in types.items()})


def _tuple(kinds: Sequence[Any], data: Any) -> Any:
    if isinstance(data, list) and kinds[-1] is Ellipsis:
        return tuple(_read(kinds[0], item) for item in data)
    if not isinstance(data, list) or len(data) != len(kinds):
        raise ValueError(f"this is not a list of {len(kinds)} values")
    return tuple(_read(kind, item) for kind, item in zip(kinds, data, strict=True))


def _float(data: float) -> float:
    try:
        value = float(data)
    except OverflowError as error:
        raise ValueError("this is not a number of 64 bits") from error
    if math.isnan(value):
        raise ValueError("this is not a number")
    return value


@cache
def _types(kind: type) -> dict[str, Any]:
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in dataclasses.fields(kind)}
