"""Lengths on the command line: px of the source image, or metres and centimetres."""

import re

from drystone.errors import UsageError

_UNITS = {"": None, "px": None, "m": 1.0, "cm": 0.01, "mm": 0.001}
_SIDE = re.compile(r"(\d+(?:\.\d*)?|\.\d+)(px|mm|cm|m|)")

LEAST_PX = 8.0
"""A wall without a unit is this wide and high at least: less was meant to be metres."""


def parse_wall(text: str, px_per_m: float | None) -> tuple[float, float]:
    """Turn ``560x160``, ``1.4mx0.4m`` or ``140cmx40cm`` into width and height in source px.

    Parameters
    ----------
    text : str
        Width and height.
    px_per_m : float or None
        Source px in a metre; needed for metric lengths.

    Raises
    ------
    UsageError
        E127 for anything else, px beside metres, and a few px without a unit; E131 for metres
        without a scale.

    Examples
    --------
    >>> parse_wall("560x160", None)
    (560.0, 160.0)
    >>> parse_wall("1.4mx40cm", 100.0)
    (140.0, 40.0)
    """
    sides = re.fullmatch(f"{_SIDE.pattern}[xX]{_SIDE.pattern}", text.strip().replace(" ", ""))
    if sides is None:
        raise UsageError(
            "E127",
            f"{text!r} is no size of a wall.",
            where="--wall",
            cure="Write 560x160 (px of the source image), 1.4mx0.4m or 140cmx40cm.",
        )
    values, units = (float(sides[1]), float(sides[3])), (sides[2], sides[4])
    _refuse_odd_units(text, values, units)
    width, height = (_in_px(*side, px_per_m) for side in zip(values, units, strict=True))
    return width, height


def _refuse_odd_units(text: str, values: tuple[float, float], units: tuple[str, str]) -> None:
    """Refuse what says px, by having no unit, and means metres (E127)."""
    metric = [_UNITS[unit] is not None for unit in units]
    if metric[0] != metric[1]:
        raise UsageError(
            "E127",
            f"{text!r} is px one way and metric the other.",
            where="--wall",
            cure="Give both sides a unit, as in 1.4mx0.4m, or both in px.",
        )
    # Such a wall in px is smaller than any stone; who means it can say so.
    if not any(units) and 0.0 < min(values) < LEAST_PX:
        width, height = (f"{value:g}" for value in values)
        raise UsageError(
            "E127",
            f"{text!r} has no unit, so it is px of the source image, fewer than {LEAST_PX:g}.",
            where="--wall",
            cure=f"Write {width}mx{height}m if it is metres, {width}pxx{height}px if it is px.",
        )


def _in_px(value: float, unit: str, px_per_m: float | None) -> float:
    metres = _UNITS[unit]
    if value <= 0:
        raise UsageError("E127", "a wall has a positive width and height.", where="--wall")
    if metres is None:
        return value
    if px_per_m is None:
        raise UsageError(
            "E131",
            "a wall in metres needs the scale of the image.",
            where="--wall",
            cure="Say how many source pixels make a metre with --px-per-m, name a length in the "
            "image with --ruler x1,y1,x2,y2=1.0m, or give px.",
        )
    return value * metres * px_per_m
