"""The scale of an image: how many of its px are a metre."""

import argparse
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from drystone.cli.numbers import positive
from drystone.errors import UsageError

if TYPE_CHECKING:  # it would bring NumPy
    from drystone.model.stone import Source

_NUMBER = r"\s*(-?\d+(?:\.\d*)?|-?\.\d+)\s*"
_RULER = re.compile(rf"{_NUMBER},{_NUMBER},{_NUMBER},{_NUMBER}=\s*(\d+(?:\.\d*)?|\.\d+)(m|cm|mm)")
_PICTURES = {".png", ".tif", ".tiff", ".bmp", ".gif", ".jpg", ".jpeg", ".npy"}
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}


class Ruled(float):
    """Px in a metre that were measured with a ruler, and where it lay.

    Attributes
    ----------
    ends_px : tuple of (float, float)
        Its two points, x and y in the image.
    """

    ends_px: tuple[tuple[float, float], ...] = ()


def add_scale(command: argparse.ArgumentParser) -> None:
    """Add the options that say how large a px is."""
    group = command.add_argument_group("scale").add_mutually_exclusive_group()
    group.add_argument("--px-per-m", type=positive, metavar="N", help="source px in a metre")
    group.add_argument(
        "--ruler", type=ruler, dest="px_per_m", metavar="X1,Y1,X2,Y2=LENGTH",
        help="two points of the source image, px, and how far apart they are: 20,30,220,30=1.0m",
    )  # fmt: skip


def ruler(text: str) -> Ruled:
    """Read `--ruler`; return px in a metre.

    Examples
    --------
    >>> ruler("0,0,300,400=2.5m")
    200.0
    """
    found = _RULER.fullmatch(text)
    if found is None:
        message = f"{text!r} is not like 20,30,220,30=1.0m (or cm, mm)"
        raise argparse.ArgumentTypeError(message)
    x1, y1, x2, y2, length = (float(number) for number in found.groups()[:5])
    px, metres = math.hypot(x2 - x1, y2 - y1), length * _METRES[found[6]]
    if px == 0.0 or metres == 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} has no length")
    scale = Ruled(px / metres)
    scale.ends_px = (x1, y1), (x2, y2)
    return scale


def picture_size_px(source: "Source") -> tuple[int, int]:
    """Return width and height of the picture that stones came from; 0 where it is not known.

    Files of outlines and folders of masks say how far the stones reach, and a ruler lies beside
    them.
    """
    if source.files or Path(source.path).suffix.lower() not in _PICTURES:
        return 0, 0
    return source.width_px, source.height_px


def refuse_outside(px_per_m: float | None, size_px: tuple[int, int]) -> None:
    """Refuse a ruler that lies beyond the picture it was measured in (E138).

    Parameters
    ----------
    px_per_m : float or None
        From the options; only what :func:`ruler` read has points.
    size_px : (int, int)
        Width and height of the picture; 0 when they are not known.
    """
    if not isinstance(px_per_m, Ruled) or not all(size_px):
        return
    width, height = size_px
    for x, y in px_per_m.ends_px:
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            raise UsageError(
                "E138",
                f"the point {x:g},{y:g} is outside the picture, which is {width} x {height} px.",
                where="--ruler",
                cure="Give two points of this picture in its full size, x1,y1,x2,y2 in px.",
            )


def scale_with(px_per_m: float | None, of_source: float | None) -> float | None:
    """Return the scale that was given, or that of the source; refuse two that differ (E131).

    Parameters
    ----------
    px_per_m : float or None
        From the options.
    of_source : float or None
        What the source says itself (:attr:`drystone.model.stone.Source.px_per_m`).
    """
    if px_per_m is None or of_source is None:
        return px_per_m or of_source
    if abs(px_per_m / of_source - 1.0) > 0.01:
        raise UsageError(
            "E131",
            f"the stones say {of_source:.6g} px a metre, the option {px_per_m:.6g}.",
            where="--px-per-m",
            cure="Leave the option out, or correct the scale beside the stones.",
        )
    return px_per_m
