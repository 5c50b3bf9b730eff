"""Lengths, transforms and the page of SVG: what makes a drawing of user units."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.io.outlines_in.model import METRES
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

Matrix = NDArray[np.float64]
View = tuple[float, float]
"""Width and height that per cents are of, user units."""

NUMBER = r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"
"""A number of SVG, as a regular expression."""

_TRANSFORM = re.compile(r"\s*+(?:,\s*+)?([a-zA-Z]++)\s*+\(([^)]*+)\)")
_LENGTH = re.compile(rf"({NUMBER})\s*+([a-z%]*+)", re.IGNORECASE)
UNITS_M = {
    "mm": 0.001, "cm": 0.01, "q": 0.00025, "in": 0.0254, "pt": 0.0254 / 72, "pc": 0.0254 / 6,
}  # fmt: skip
"""Metres in a unit of length."""
PX_M = 0.0254 / 96.0
"""Metres in a px of CSS, which a user unit is."""
PLAIN = "Save it as plain SVG"
"""The cure for what few drawings have."""


def bounded(text: str) -> float:
    """Return a number; ValueError for one beyond 1e12, which no drawing has."""
    value = float(text)
    if not abs(value) < 1e12:
        raise ValueError(f"{text[:20]} is too large")
    return value


def numbers_in(text: str) -> list[float]:
    """Return the numbers between spaces and commas; ValueError when there is anything else."""
    return [bounded(word) for word in re.split(r"[\s,]+", text.strip()) if word]


def length(text: str) -> tuple[float, str]:
    """Split a length into number and unit; ValueError when it is none."""
    found = _LENGTH.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text[:30]!r} is not a length")
    return bounded(found[1]), found[2].lower()


def transform(text: str) -> Matrix:
    """Return the (3, 3) matrix of the attribute ``transform``."""
    matrix, place = np.eye(3), 0
    text = "" if text.strip() == "none" else text.rstrip()
    while place < len(text):
        found = _TRANSFORM.match(text, place)
        if found is None:
            raise ValueError(f"{text[place:][:30]!r} is not a transform")
        matrix = matrix @ _matrix_of(found[1], numbers_in(found[2]))
        place = found.end()
    return matrix


def _matrix_of(name: str, numbers: list[float]) -> Matrix:
    """Return the matrix of one function of a transform; ValueError when it is none."""
    matrix = np.eye(3)
    count = len(numbers)
    if name == "matrix" and count == 6:
        matrix[:2] = np.reshape(numbers, (3, 2)).T
    elif name == "translate" and count in (1, 2):
        matrix[:2, 2] = numbers[0], numbers[1] if count == 2 else 0.0
    elif name == "scale" and count in (1, 2):
        matrix[0, 0], matrix[1, 1] = numbers[0], numbers[-1]
    elif name == "rotate" and count in (1, 3):
        angle = math.radians(numbers[0])
        matrix[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        centre = np.array(numbers[1:] or (0.0, 0.0))
        matrix[:2, 2] = centre - matrix[:2, :2] @ centre
    elif name in {"skewX", "skewY"} and count == 1:
        row = 0 if name == "skewX" else 1
        matrix[row, 1 - row] = math.tan(math.radians(numbers[0]))
    else:
        raise ValueError(f"{name} of {count} numbers is not a transform")
    return matrix


def moved(matrix: Matrix, points: Points) -> Points:
    """Return points under a transform."""
    return np.asarray(points @ matrix[:2, :2].T + matrix[:2, 2])


def user_units(attributes: Mapping[str, str], name: str, view: View | None) -> float:
    """Return an attribute that is a length, 0 when there is none; ValueError when it is none."""
    value, unit = length(attributes.get(name, "0"))
    if unit in UNITS_M:
        return value * UNITS_M[unit] / PX_M
    if unit == "%" and view is not None and name != "r":
        return value / 100.0 * view[0 if name in {"x", "cx", "rx", "width"} else 1]
    if unit not in {"", "px"}:
        raise ValueError(f"{name} in {unit} is not read, only user units")
    return value


@dataclass(frozen=True, eq=False)
class Page:
    """What the root element says."""

    matrix: Matrix  # from its user units to the page
    unit_m: float | None  # metres in a unit of the page; None for px
    size: tuple[float, float] | None  # of the page, in its unit, if it is known
    view: View | None  # what per cents are of
    overruled: str = ""  # its own unit, when the settings name another


def page_of(root: Mapping[str, str], settings: ReadSettings) -> Page:
    """Read width, height and viewBox of the root; ValueError when they cannot be used."""
    sides = [length(root.get(name, "100%")) for name in ("width", "height")]
    physical = all(unit in UNITS_M for _, unit in sides)
    if not physical and any(unit not in {"", "px", "%"} for _, unit in sides):
        raise ValueError("its width and height are in units that cannot be used together")
    box = view_box(root)
    given = not any(unit == "%" for _, unit in sides)
    unit_m, overruled = METRES.get(settings.unit or "px"), ""
    if physical and settings.unit:
        own = UNITS_M[sides[0][1]]
        physical = unit_m is not None and abs(unit_m / own - 1.0) < 1e-9
        overruled = "" if physical else f"its width is {root['width'][:30]}"
    size = [value for value, _ in sides] if given else box[2:]
    if physical:
        unit_m = UNITS_M[sides[0][1]]
        size = [value * UNITS_M[unit] / unit_m for value, unit in sides]
    elif unit_m is not None or overruled:
        # What the settings name is the user's unit, whatever px it is shown in.
        size = box[2:] or size
    if given and min(size, default=1.0) <= 0.0:
        raise ValueError("its width or height is not above 0")
    matrix = np.eye(3)
    if box and size:
        matrix = fitted(box, size, root.get("preserveAspectRatio", ""))
    elif physical:
        # User units are the px of CSS then.
        matrix[0, 0] = matrix[1, 1] = PX_M / UNITS_M[sides[0][1]]
    if not size:
        return Page(matrix, unit_m, None, None, overruled)
    view = (box[2], box[3]) if box else (size[0] / matrix[0, 0], size[1] / matrix[1, 1])
    return Page(matrix, unit_m, (size[0], size[1]), view, overruled)


def view_box(attributes: Mapping[str, str]) -> list[float]:
    """Return the four numbers of a viewBox; none when there is none, ValueError for others."""
    text = attributes.get("viewBox", "").strip()
    box = numbers_in(text)
    if box and (len(box) != 4 or not min(box[2:]) > 0.0):
        raise ValueError(f"its viewBox is {text!r}")
    return box


def fitted(box: Sequence[float], size: Sequence[float], ratio: str = "") -> Matrix:
    """Return the way from the units of a viewBox to a page with its origin at (0, 0).

    The drawing lies in the middle of the page, as it does unless a ratio says another thing.
    """
    if ratio.strip() not in {"", "none", "xMidYMid", "xMidYMid meet"}:
        raise ValueError(f"its preserveAspectRatio {ratio[:30]!r} is not read. {PLAIN}")
    sides, room = np.array(box[2:]), np.array(size)
    scale = room / sides
    if ratio.strip() != "none":
        scale[:] = scale.min()
    matrix = np.eye(3)
    matrix[:2, :2] = np.diag(scale)
    matrix[:2, 2] = (room - scale * sides) / 2.0 - scale * box[:2]
    return matrix
