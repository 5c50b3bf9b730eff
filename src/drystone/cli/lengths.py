"""Lengths on the command line: px of the source image, or metres and centimetres."""

import re

from drystone.errors import UsageError

_UNITS = {"": None, "px": None, "m": 1.0, "cm": 0.01, "mm": 0.001}
_SIDE = re.compile(r"(\d+(?:\.\d*)?|\.\d+)(px|mm|cm|m|)")


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
        E127 for anything else, E131 for metres without a scale.

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
    width, height = (_in_px(float(sides[number]), sides[number + 1], px_per_m) for number in (1, 3))
    return width, height


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
