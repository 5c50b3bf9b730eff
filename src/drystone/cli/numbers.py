"""Numbers, lengths and the scale of a picture on the command line; nothing slow is imported."""

import argparse
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from drystone.errors import Notice, UsageError

if TYPE_CHECKING:  # they would bring NumPy
    from drystone.io.walls import GivenWall
    from drystone.model.stone import Source

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "in": 0.0254}
"""Units of lengths."""

_LENGTH = r"(\d+(?:[.,]\d*)?|[.,]\d+)"
_SIDE = rf"{_LENGTH}(px|mm|cm|m|ft|in|)"
_WALL = re.compile(f"{_SIDE}[xX\N{MULTIPLICATION SIGN}]{_SIDE}")
_THOUSANDS = re.compile(r"[1-9]\d{0,2},\d{3}")
_AREA = re.compile(r"(\d+(?:\.\d*)?|\.\d+)\s*(?:(mm|cm|m|ft|in)[2\N{SUPERSCRIPT TWO}]|px|)")
_NUMBER = r"\s*(-?\d+(?:\.\d*)?|-?\.\d+)\s*"
_RULER = re.compile(rf"{_NUMBER},{_NUMBER},{_NUMBER},{_NUMBER}=\s*{_LENGTH}(m|cm|mm|ft|in)")
_PICTURES = {".png", ".tif", ".tiff", ".bmp", ".gif", ".jpg", ".jpeg", ".npy"}
_SAYS = {
    "stones": ("the stones say", "or correct the scale beside the stones"),
    "plan": ("the plan says", "or plan again with another scale"),
}
"""Who knows a scale: how that is said, and what else can be done when an option differs."""

_SIZES = "Write 560x160 (px of the source image), 1.4mx0.4m, 140x40cm or 4x1.5ft."

LEAST_PX = 8.0
"""A wall without a unit is this wide and high at least: less was meant to be metres."""

LEAST_M, MOST_M = 0.01, 2.0
"""Median stones that people build with, metres."""


def _number(text: str, kind: Callable[[str], float] = float) -> float:
    try:
        return kind(text)
    except ValueError:
        return math.nan


def _reader(
    wrong: str, fits: Callable[[float], bool], kind: Callable[[str], float] = float
) -> Callable[[str], float]:
    def read(text: str) -> float:
        if not fits(value := _number(text, kind)):
            raise argparse.ArgumentTypeError(f"{text!r} is {wrong}")
        return value

    return read


def whole_from(least: int) -> Callable[[str], float]:
    """Return a reader of whole numbers, `least` or more."""
    return _reader(f"not a whole number of {least} or more", lambda value: value >= least, int)


finite = _reader("not a finite number", math.isfinite)
not_negative = _reader("not a number of 0 or more", lambda value: 0 <= value < math.inf)
positive = _reader("not a number above 0", lambda value: 0 < value < math.inf)


def share(text: str) -> float:
    """Read a number above 0 and at most 1."""
    value = positive(text)
    if value > 1:
        raise argparse.ArgumentTypeError(f"{text!r} is above 1")
    return value


def area(text: str) -> tuple[float, str]:
    """Read an area: value and unit, "px", or "cm2" for all that are lengths squared."""
    found = _AREA.fullmatch(text.strip())
    if found is None or not 0 < float(found[1]) < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not an area such as 12cm2, 2in2 or 300 (px)")
    value, unit = float(found[1]), found[2]
    return (value * (100.0 * METRES[unit]) ** 2, "cm2") if unit else (value, "px")


def refuse_cm2(
    area: tuple[float, str] | None, scale: object, of: str, options: str = "--px-per-m or --ruler"
) -> None:
    """Refuse an area that is not in px where no option gives the scale of a picture (E131)."""
    if scale is None and area is not None and area[1] == "cm2":
        what = f"an area that is not in px needs the scale of the {of}."
        cure = f"Give it with {options}, or give the area in px."
        raise UsageError("E131", what, where="--min-area", cure=cure)


def friction(text: str) -> tuple[float, float]:
    """Read one coefficient of friction, or LOW:HIGH."""
    parts = [_number(part) for part in text.split(":")]
    low, high = (parts * 2)[:2] if len(parts) in (1, 2) else (math.nan, math.nan)
    if not 0 <= low <= high < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a friction such as 0.58 or 0.4:0.8")
    return low, high


def parse_wall(text: str, px_per_m: float | None) -> tuple[float, float]:
    """Turn ``560x160``, ``1.4mx0.4m`` or ``140 x 40 cm`` into width and height in source px.

    A unit at the end is that of both sides.  E127 for anything else, px beside metres, and a few px
    without a unit; E131 for metres without a scale.
    """
    sides = _WALL.fullmatch(text.strip().replace(" ", ""))
    if sides is None:
        raise _no_wall(f"{text!r} is not the size of a wall.")
    values = _plain(sides[1], text), _plain(sides[3], text)
    units = sides[2] or sides[4], sides[4]
    metric = [unit in METRES for unit in units]
    if metric[0] != metric[1]:
        cure = "Give both sides a unit, as in 1.4mx0.4m, or both in px."
        raise _no_wall(f"{text!r} is px one way and metric the other.", cure)
    # Such a wall in px is smaller than any stone; who means it can say so.
    if not any(units) and 0.0 < min(values) < LEAST_PX:
        w, h = (f"{value:g}" for value in values)
        what = f"{text!r} has no unit, so it is px of the source image, fewer than {LEAST_PX:g}."
        raise _no_wall(what, f"Write {w}mx{h}m if it is metres, {w}pxx{h}px if it is px.")
    if min(values) <= 0:
        raise _no_wall("a wall has a positive width and height.")
    if not metric[0]:
        return values
    if px_per_m is None:
        raise UsageError(
            "E131", "a wall in metres needs the scale of the image.", where="--wall",
            cure="Give the source pixels in a metre with --px-per-m, or a length in the image with "
            "--ruler x1,y1,x2,y2=1.0m; or give the wall in px.",
        )  # fmt: skip
    return values[0] * METRES[units[0]] * px_per_m, values[1] * METRES[units[1]] * px_per_m


def _plain(number: str, text: str) -> float:
    """Read a number with a point or a comma before its decimals; E127 where that may be neither."""
    if _THOUSANDS.fullmatch(number):
        plain = number.replace(",", "")
        what = f"{number} in {text!r} may be {plain}, or {float(number.replace(',', '.')):g}."
        raise _no_wall(what, "Write it without the comma, or with a point before the decimals.")
    return float(number.replace(",", "."))


def _no_wall(what: str, cure: str = _SIZES) -> UsageError:
    return UsageError("E127", what, where="--wall", cure=cure)


class Ruled(float):
    """Px in a metre that were measured with a ruler, and where it lay."""

    ends_px: tuple[tuple[float, float], ...] = ()  # its two points, x and y in the image


def add_scale(command: argparse.ArgumentParser) -> None:
    """Add the options that say how large a px is."""
    group = command.add_argument_group("size of a pixel").add_mutually_exclusive_group()
    group.add_argument("--px-per-m", type=positive, metavar="N", help="source pixels in a metre")
    group.add_argument(
        "--ruler", type=ruler, dest="px_per_m", metavar="X1,Y1,X2,Y2=LENGTH",
        help="two points of the source image (px) and their distance: 20,30,220,30=1.0m",
    )  # fmt: skip


def ruler(text: str) -> Ruled:
    """Read `--ruler`; return px in a metre."""
    found = _RULER.fullmatch(text)
    if found is None:
        message = f"{text!r} is not like 20,30,220,30=1.0m (or cm, mm, ft, in)"
        raise argparse.ArgumentTypeError(message)
    x1, y1, x2, y2, length = (float(number.replace(",", ".")) for number in found.groups()[:5])
    px, metres = math.hypot(x2 - x1, y2 - y1), length * METRES[found[6]]
    if px == 0.0 or metres == 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} has no length")
    scale = Ruled(px / metres)
    scale.ends_px = (x1, y1), (x2, y2)
    return scale


def option_of(px_per_m: float) -> str:
    """Return the name of the option that gave a scale: both are stored as one."""
    return "--ruler" if isinstance(px_per_m, Ruled) else "--px-per-m"


def picture_size_px(source: "Source | Mapping[str, Any]") -> tuple[int, int]:
    """Return width and height of the picture that stones came from; 0 where it is not known.

    Files of outlines and folders of masks say how far the stones reach, and a ruler lies beside
    them.  What a plan says of its stones is a mapping.
    """
    said = source if isinstance(source, Mapping) else vars(source)
    drawn = said.get("files") or Path(said["path"]).suffix.lower() not in _PICTURES
    return (0, 0) if drawn else (said["width_px"], said["height_px"])


def wall_picture_px(wall: "GivenWall") -> tuple[int, int]:
    """Return the size of the picture in which a wall is measured: of a plan that of its stones."""
    if wall.plan is not None:
        return picture_size_px(wall.plan.source)
    # Outlines say how far the stones reach, and a ruler may lie beside them.
    if wall.labels is None or wall.outlines is not None:
        return 0, 0
    height, width = wall.labels.shape
    return width, height


def refuse_outside(px_per_m: float | None, size_px: tuple[int, int]) -> None:
    """Refuse a ruler that lies beyond the picture it was measured in (E138).

    Width and height are 0 when they are not known.
    """
    if not isinstance(px_per_m, Ruled) or not all(size_px):
        return
    width, height = size_px
    for x, y in px_per_m.ends_px:
        if not (0.0 <= x <= width and 0.0 <= y <= height):
            what = f"the point {x:g},{y:g} is outside the picture, which is {width} x {height} px."
            cure = "Give two points of this picture in its full size, x1,y1,x2,y2 in px."
            raise UsageError("E138", what, where="--ruler", cure=cure)


def scale_with(
    px_per_m: float | None, of_source: float | None, who: Literal["stones", "plan"] = "stones"
) -> float | None:
    """Return the scale of the options, or that of the source; refuse two that differ (E131)."""
    if px_per_m is None or of_source is None:
        return px_per_m or of_source
    if abs(px_per_m / of_source - 1.0) > 0.01:
        says, or_else = _SAYS[who]
        what = f"{says} {of_source:.6g} px a metre, the option {px_per_m:.6g}."
        cure = f"Leave the option out, {or_else}."
        raise UsageError("E131", what, where=option_of(px_per_m), cure=cure)
    return px_per_m


def wall_scale(px_per_m: float | None, wall: "GivenWall") -> float | None:
    """Return the scale of a wall, of the options or of its file; E131 for two that differ."""
    if wall.plan is not None:
        return scale_with(px_per_m, wall.plan.px_per_m, "plan")
    return scale_with(px_per_m, wall.px_per_m)


def scale_notice(median_px: float, px_per_m: float | None) -> Notice | None:
    """Say when a scale makes median stones that nobody builds with (W123); None else."""
    if px_per_m is None or LEAST_M <= (length := median_px / px_per_m) <= MOST_M:
        return None
    said = f"{1000 * length:.2g} mm" if length < LEAST_M else f"{length:.3g} m"
    what = f"the median stone is {said} long with {px_per_m:g} px in a metre."
    cure = "Is that scale right? All lengths go by it; --unit corrects that of a drawing."
    return Notice("W123", what, cure)
