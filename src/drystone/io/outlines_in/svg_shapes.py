"""Elements of SVG as path lines, and their transforms."""

import math
import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from drystone.io.outlines_in.svg_path import (
    CORNERS_OF_CIRCLE,
    NUMBER,
    Subpath,
    arc,
    bounded,
    subpaths,
)
from drystone.kernels.polygons import Points

SHAPES = frozenset({"path", "polygon", "polyline", "rect", "circle", "ellipse"})

Matrix = NDArray[np.float64]

_TRANSFORM = re.compile(r"\s*+(?:,\s*+)?([a-zA-Z]++)\s*+\(([^)]*+)\)")
_LENGTH = re.compile(rf"({NUMBER})\s*+([a-z%]*+)", re.IGNORECASE)
UNITS_M = {
    "mm": 0.001, "cm": 0.01, "q": 0.00025, "in": 0.0254, "pt": 0.0254 / 72, "pc": 0.0254 / 6,
}  # fmt: skip
"""Metres in a unit of length."""
PX_M = 0.0254 / 96.0
"""Metres in a px of CSS, which a user unit is."""


def length(text: str) -> tuple[float, str]:
    """Split a length into number and unit; ValueError when it is none."""
    found = _LENGTH.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text[:30]!r} is no length")
    return bounded(found[1]), found[2].lower()


def transform(text: str) -> Matrix:
    """Return the (3, 3) matrix of the attribute ``transform``."""
    matrix, place = np.eye(3), 0
    text = "" if text.strip() == "none" else text.rstrip()
    while place < len(text):
        found = _TRANSFORM.match(text, place)
        if found is None:
            raise ValueError(f"{text[place:][:30]!r} is no transform")
        numbers = [bounded(word) for word in re.split(r"[\s,]+", found[2].strip()) if word]
        matrix = matrix @ _matrix_of(found[1], numbers)
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
        raise ValueError(f"{name} of {count} numbers is no transform")
    return matrix


def moved(matrix: Matrix, points: Points) -> Points:
    """Return points under a transform."""
    return np.asarray(points @ matrix[:2, :2].T + matrix[:2, 2])


def lines_of(
    kind: str, attributes: Mapping[str, str], view: tuple[float, float] | None = None
) -> list[Subpath]:
    """Return the lines of a shape in its own coordinates; ValueError when it cannot be used."""
    if kind == "path":
        data = attributes.get("d", "")
        return [] if data.strip() == "none" else subpaths(data)
    if kind in {"polygon", "polyline"}:
        words = re.split(r"[\s,]+", attributes.get("points", "").strip())
        points = np.reshape([bounded(word) for word in words if word], (-1, 2))
        if not len(points):
            return []
        closed = kind == "polygon" or bool((points[0] == points[-1]).all())
        return [Subpath(points, closed)]
    if kind == "rect":
        return [Subpath(_rectangle(attributes, view), closed=True)]
    if kind == "circle":
        rx = ry = user_units(attributes, "r", view)
    else:
        rx, ry = _radii(attributes, view)
    angles = np.arange(CORNERS_OF_CIRCLE) * (2.0 * math.pi / CORNERS_OF_CIRCLE)
    circle = np.column_stack([rx * np.cos(angles), ry * np.sin(angles)])
    middle = np.array([user_units(attributes, "cx", view), user_units(attributes, "cy", view)])
    return [Subpath(circle + middle, closed=True)]


def _rectangle(attributes: Mapping[str, str], view: tuple[float, float] | None) -> Points:
    names = ("x", "y", "width", "height")
    x, y, width, height = (user_units(attributes, name, view) for name in names)
    rx, ry = np.minimum(_radii(attributes, view), (width / 2, height / 2)).tolist()
    if rx <= 0.0 or ry <= 0.0:
        return np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height)])
    corners = []
    for (x0, y0), (x1, y1) in (
        ((x + width - rx, y), (x + width, y + ry)),
        ((x + width, y + height - ry), (x + width - rx, y + height)),
        ((x + rx, y + height), (x, y + height - ry)),
        ((x, y + ry), (x + rx, y)),
    ):
        start = np.array([x0, y0])
        corners += [start[None], arc(start, [rx, ry, 0.0, 0.0, 1.0], np.array([x1, y1]))]
    return np.concatenate(corners)


def _radii(attributes: Mapping[str, str], view: tuple[float, float] | None) -> tuple[float, float]:
    """Return rx and ry, of which one counts for both."""
    given = [user_units(attributes, name, view) for name in ("rx", "ry") if name in attributes]
    return (given[0], given[-1]) if given else (0.0, 0.0)


def user_units(attributes: Mapping[str, str], name: str, view: tuple[float, float] | None) -> float:
    """Return an attribute that is a length, 0 when there is none; ValueError when it is none."""
    value, unit = length(attributes.get(name, "0"))
    if unit in UNITS_M:
        return value * UNITS_M[unit] / PX_M
    if unit == "%" and view is not None and name != "r":
        return value / 100.0 * view[0 if name in {"x", "cx", "rx", "width"} else 1]
    if unit not in {"", "px"}:
        raise ValueError(f"{name} in {unit} is not read, only user units")
    return value
