"""JSON of any origin."""

import json
import re
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


def _depth(text: str) -> int:
    """Return how many brackets are open at once, those in strings aside."""
    if text.count("[") + text.count("{") <= DEEPEST:
        return 0
    outside = _STRING.sub("", text).encode("ascii", "ignore").translate(None, _NO_BRACKETS)
    opens = np.isin(np.frombuffer(outside, np.uint8), (ord("["), ord("{")))
    steps = np.where(opens, np.int8(1), np.int8(-1))
    return int(np.cumsum(steps, dtype=np.int32).max(initial=0))
