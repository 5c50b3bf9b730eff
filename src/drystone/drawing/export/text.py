"""Numbers and JSON as text, equal for equal assemblies."""

import json
from typing import Any

from drystone.io.json_text import plain

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
