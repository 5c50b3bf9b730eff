"""Numbers on the command line; nothing slow is imported here."""

import argparse
import math
from collections.abc import Callable


def whole_from(least: int) -> Callable[[str], int]:
    """Return a reader of whole numbers, `least` or more."""

    def read(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            raise argparse.ArgumentTypeError(f"{text!r} is no whole number from {least} on")
        return value

    return read


def finite(text: str) -> float:
    """Read a finite number."""
    value = _number(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is no finite number")
    return value


def not_negative(text: str) -> float:
    """Read a finite number from 0 on."""
    value = _number(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no number from 0 on")
    return value


def positive(text: str) -> float:
    """Read a finite number above 0."""
    value = _number(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no number above 0")
    return value


def share(text: str) -> float:
    """Read a number above 0 and at most 1."""
    value = positive(text)
    if value > 1:
        raise argparse.ArgumentTypeError(f"{text!r} is above 1")
    return value


def friction(text: str) -> tuple[float, float]:
    """Read one coefficient of friction, or LOW:HIGH."""
    parts = [_number(part) for part in text.split(":")]
    low, high = (parts * 2)[:2] if len(parts) in (1, 2) else (math.nan, math.nan)
    if not 0 <= low <= high < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no friction such as .58 or .4:.8")
    return low, high


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan
