"""The scale of an image: how many of its px are a metre."""

import argparse
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from drystone.cli.numbers import positive
from drystone.errors import Notice, UsageError

if TYPE_CHECKING:  # they would bring NumPy
    from drystone.io.walls import GivenWall
    from drystone.model.stone import Source

_NUMBER = r"\s*(-?\d+(?:\.\d*)?|-?\.\d+)\s*"
_RULER = re.compile(rf"{_NUMBER},{_NUMBER},{_NUMBER},{_NUMBER}=\s*(\d+(?:\.\d*)?|\.\d+)(m|cm|mm)")
_PICTURES = {".png", ".tif", ".tiff", ".bmp", ".gif", ".jpg", ".jpeg", ".npy"}
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_SAYS = {
    "stones": ("the stones say", "or correct the scale beside the stones"),
    "plan": ("the plan says", "or plan again with another scale"),
}
"""Who knows a scale: how that is said, and what else can be done when an option differs."""

LEAST_M, MOST_M = 0.01, 2.0
"""Median stones that people build with, metres."""


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


def option_of(px_per_m: float) -> str:
    """Return the name of the option that gave a scale: both are stored as one."""
    return "--ruler" if isinstance(px_per_m, Ruled) else "--px-per-m"


def picture_size_px(source: "Source") -> tuple[int, int]:
    """Return width and height of the picture that stones came from; 0 where it is not known.

    Files of outlines and folders of masks say how far the stones reach, and a ruler lies beside
    them.
    """
    return _size_px(source.path, source.files, (source.width_px, source.height_px))


def planned_picture_px(source: Mapping[str, Any]) -> tuple[int, int]:
    """Return the size of the picture that the stones of a plan came from; 0 where it is not known.

    Parameters
    ----------
    source : mapping
        What a plan says of it (:attr:`drystone.model.plan.Plan.source`).
    """
    size_px = source["width_px"], source["height_px"]
    return _size_px(source["path"], source.get("files", ()), size_px)


def wall_picture_px(wall: "GivenWall") -> tuple[int, int]:
    """Return the size of the picture in which a wall is measured: of a plan that of its stones."""
    if wall.plan is not None:
        return planned_picture_px(wall.plan.source)
    height, width = (0, 0) if wall.labels is None else wall.labels.shape
    return width, height


def _size_px(path: str, files: Sequence[str], size_px: tuple[int, int]) -> tuple[int, int]:
    return (0, 0) if files or Path(path).suffix.lower() not in _PICTURES else size_px


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


def scale_with(
    px_per_m: float | None, of_source: float | None, who: Literal["stones", "plan"] = "stones"
) -> float | None:
    """Return the scale that was given, or that of the source; refuse two that differ (E131).

    Parameters
    ----------
    px_per_m : float or None
        From the options.
    of_source : float or None
        What the source says itself (:attr:`drystone.model.stone.Source.px_per_m`).
    who : {"stones", "plan"}
        Which source that is, for the message.
    """
    if px_per_m is None or of_source is None:
        return px_per_m or of_source
    if abs(px_per_m / of_source - 1.0) > 0.01:
        says, or_else = _SAYS[who]
        raise UsageError(
            "E131",
            f"{says} {of_source:.6g} px a metre, the option {px_per_m:.6g}.",
            where=option_of(px_per_m),
            cure=f"Leave the option out, {or_else}.",
        )
    return px_per_m


def scale_notice(median_px: float, px_per_m: float | None) -> Notice | None:
    """Say when a scale makes stones that nobody builds with (W123); None when it does not.

    Parameters
    ----------
    median_px : float
        Length of the median stone, source px.
    px_per_m : float or None
        Scale, if there is one.

    Examples
    --------
    >>> print(scale_notice(40.0, 10.0).message)
    the median stone is 4 m long with 10 px in a metre.
    """
    if px_per_m is None or LEAST_M <= (length := median_px / px_per_m) <= MOST_M:
        return None
    said = f"{1000 * length:.2g} mm" if length < LEAST_M else f"{length:.3g} m"
    return Notice(
        "W123",
        f"the median stone is {said} long with {px_per_m:g} px in a metre.",
        "Is that scale right? All lengths go by it.",
    )
