"""JSON of any origin, and values of its own types."""

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from drystone.io.file_bytes import file_bytes

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
