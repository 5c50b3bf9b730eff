"""JSON of any origin, values as JSON and back again by their types, and numbers as text."""

import dataclasses
import json
import math
import operator
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import UnionType
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from drystone.io.files import file_bytes

DEEPEST = 100
"""How many lists and objects may be in each other; plans and outlines have less than 12."""

_STRING = re.compile(r'"[^"\\]*+(?:\\.[^"\\]*+)*+"?', re.DOTALL)
_NO_BRACKETS = bytes(set(range(256)) - set(b"[]{}"))


def json_of(text: str, **hooks: Any) -> Any:
    """Return what JSON says; ValueError when it is none, or is nested deeper than `DEEPEST`.

    Whoever walks through it may then call itself for every level.
    """
    # Before it is parsed: Python's own limit depends on how deep the caller is.
    if _depth(text) > DEEPEST:
        raise ValueError(f"it is nested deeper than {DEEPEST} levels")
    try:
        return json.loads(text, **hooks)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


def json_in(path: Path) -> Any:
    """Return what a JSON file says; OSError when it cannot be read, ValueError when it is none."""
    return json_of(file_bytes(path).decode("utf-8-sig"))


def plain(value: Any, *, ordered: bool = False) -> Any:
    """Return a value of JSON's own types, mappings in alphabetical order if `ordered`."""
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, Mapping):
        keys = sorted(value) if ordered else value
        return {str(key): plain(value[key], ordered=ordered) for key in keys}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item, ordered=ordered) for item in value]
    # Adding zero turns -0.0 into 0.0: equal values are equal text.
    return value + 0.0 if isinstance(value, float) else value


def _depth(text: str) -> int:
    """Return how many brackets are open at once, those in strings aside."""
    if text.count("[") + text.count("{") <= DEEPEST:
        return 0
    outside = _STRING.sub("", text).encode("ascii", "ignore").translate(None, _NO_BRACKETS)
    opens = np.isin(np.frombuffer(outside, np.uint8), (ord("["), ord("{")))
    steps = np.where(opens, np.int8(1), np.int8(-1))
    return int(np.cumsum(steps, dtype=np.int32).max(initial=0))


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


def from_plain(kind: Any, data: Any) -> Any:
    """Return what :func:`as_json` was given, of a type, once its JSON is read."""
    origin, kinds = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        types = _types(kind)
        if not isinstance(data, dict) or data.keys() != types.keys():
            raise ValueError(f"this is not of type {kind.__name__}")
        return kind(**{name: from_plain(one, data[name]) for name, one in types.items()})
    if origin is UnionType:
        for one in kinds[:-1]:
            with suppress(ValueError):
                return from_plain(one, data)
        return from_plain(kinds[-1], data)
    if origin is tuple:
        if not isinstance(data, list) or (len(data) != len(kinds) and kinds[-1] is not Ellipsis):
            raise ValueError(f"this is not a list of {len(kinds)} values")
        several = kinds[:1] * len(data) if kinds[-1] is Ellipsis else kinds
        return tuple(from_plain(one, item) for one, item in zip(several, data, strict=True))
    if kind is float and isinstance(data, int | float) and not isinstance(data, bool):
        return _float(data)
    if origin is Mapping and isinstance(data, dict):
        data = {name: from_plain(kinds[1], item) for name, item in data.items()}
        known = True
    elif origin is Literal:
        known = isinstance(data, str) and data in kinds
    else:
        known = origin is None and type(data) is kind
    if known:
        return data
    raise ValueError(f"{str(data)[:40]!r} is not of type {kind}")


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


LINE = 320  # characters; a matrix of 16 numbers with all digits is shorter


def json_text(value: Any, depth: int = 0) -> str:
    """Return JSON on few lines: what holds nothing but numbers and words is not broken up.

    Floats have all digits; a list of rows, such as a matrix, counts as plain.  What is longer
    than 320 characters is broken up all the same.  NaN and infinities are refused (ValueError).
    """
    value = plain(value)
    line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if not value or not isinstance(value, dict | list):
        return line
    # A list of rows of numbers is a matrix, and stays on one line.
    rows = isinstance(value, list) and all(isinstance(item, list) for item in value)
    if _height(value) <= 1 + rows and len(line) <= LINE:
        return line
    margin = " " * (depth + 1)
    if isinstance(value, dict):
        parts = [f"{json.dumps(key, ensure_ascii=False)}: {json_text(item, depth + 1)}"
                 for key, item in value.items()]  # fmt: skip
        opening, closing = "{", "}"
    else:
        parts = [json_text(item, depth + 1) for item in value]
        opening, closing = "[", "]"
    inside = ",\n".join(margin + part for part in parts)
    return f"{opening}\n{inside}\n{' ' * depth}{closing}"


def number(value: float) -> str:
    """Write a number for text formats: all digits, a point always, no minus before zero.

    YAML 1.1 takes ``1e-05`` for a word; with a point before the e it is a number everywhere.
    """
    text = repr(float(value) + 0.0)
    head, e, tail = text.partition("e")
    return text if not e or "." in head else f"{head}.0e{tail}"


def _height(value: Any) -> int:
    inside = value.values() if isinstance(value, dict) else value
    return 1 + max(map(_height, inside), default=0) if isinstance(value, dict | list) else 0
