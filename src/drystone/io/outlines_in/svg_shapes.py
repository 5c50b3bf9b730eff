"""SVG: shapes to corners, with their lengths and transforms, and the page that they are on."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drystone.errors import Notice
from drystone.io.outlines_in.model import METRES, overruled, rectangle
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

Matrix = NDArray[np.float64]
View = tuple[float, float]
"""Width and height that per cents are of, user units."""

_DIGITS = r"[+-]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][+-]?\d++)?"

_TRANSFORM = re.compile(r"\s*+(?:,\s*+)?([a-zA-Z]++)\s*+\(([^)]*+)\)")
_LENGTH = re.compile(rf"({_DIGITS})\s*+([a-z%]*+)", re.IGNORECASE)
_UNITS_M = {
    "mm": 0.001, "cm": 0.01, "q": 0.00025, "in": 0.0254, "pt": 0.0254 / 72, "pc": 0.0254 / 6,
}  # fmt: skip
"""Metres in a unit of length."""
_PX_M = 0.0254 / 96.0
"""Metres in a px of CSS, which a user unit is."""
PLAIN = "Save it as plain SVG"
"""The cure for what few drawings have."""

SHAPES = frozenset({"path", "polygon", "polyline", "rect", "circle", "ellipse"})
CORNERS_OF_CIRCLE = 256
CORNERS_OF_CURVE = 128
"""Chords of a full turn stay within 8e-5 of the radius."""

_MOST_CORNERS = 1_000_000
"""Of a path; a stone has some hundred."""

_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])")
# Possessive: what was taken is not given back, so no text takes longer than it is long.
_NUMBER = re.compile(rf"\s*+(?:,\s*+)?({_DIGITS})")
_FLAG = re.compile(r"\s*+(?:,\s*+)?([01])")
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}

Corner = NDArray[np.float64]


class Subpath(NamedTuple):
    """A line of a path."""

    points: Points  # (n, 2), corners in order
    closed: bool  # whether the path says so, or it ends where it began


def subpaths(data: str) -> list[Subpath]:
    """Return the lines of path data."""
    pen = _Pen()
    for command, numbers in _segments(data):
        pen.draw(command, numbers)
    pen.end(closed=False)
    return pen.done


def _segments(data: str) -> Iterator[tuple[str, list[float]]]:
    """Yield commands with their numbers, repeated ones one by one."""
    parts = _COMMAND.split(data)
    if parts[0].strip():
        raise ValueError(f"path data begins with {parts[0].strip()[:20]!r}")
    for command, text in zip(parts[1::2], parts[2::2], strict=True):
        count = _ARGUMENTS[command.upper()]
        numbers = _numbers(text, arc=command in "Aa")
        if count == 0:
            if numbers:
                raise ValueError("numbers after z")
            yield command, []
            continue
        if not numbers or len(numbers) % count:
            raise ValueError(f"{command} has {len(numbers)} numbers, not a multiple of {count}")
        for start in range(0, len(numbers), count):
            # What follows the first pair of a move is a line.
            later = {"M": "L", "m": "l"}.get(command, command) if start else command
            yield later, numbers[start : start + count]


def _numbers(text: str, *, arc: bool) -> list[float]:
    """Read numbers; the flags of arcs may stand together without a space."""
    numbers: list[float] = []
    place, end = 0, len(text.rstrip())
    while place < end:
        is_flag = arc and len(numbers) % 7 in (3, 4)
        found = (_FLAG if is_flag else _NUMBER).match(text, place)
        if found is None:
            raise ValueError(f"{text[place:end].strip()[:20]!r} is not a number")
        numbers.append(bounded(found[1]))
        place = found.end()
    return numbers


@dataclass
class _Pen:
    """Where a path has come to."""

    done: list[Subpath] = field(default_factory=list)
    line: list[Points] = field(default_factory=list)
    corners: int = 0
    at: Corner = field(default_factory=lambda: np.zeros(2))
    begun: Corner = field(default_factory=lambda: np.zeros(2))
    handle: Corner | None = None  # last control point, which smooth curves mirror
    last: str = ""  # command

    def draw(self, command: str, numbers: list[float]) -> None:
        """Follow one command."""
        kind = command.upper()
        if not self.last and kind != "M":
            raise ValueError(f"path data begins with {command}, not with a move")
        base = self.at if command.islower() else np.zeros(2)
        handle = None
        if kind == "Z":
            self.end(closed=True)
            self.at = self.begun
        elif kind == "M":
            self.end(closed=False)
            self.at = self.begun = base + numbers
        elif kind == "L":
            self._to((base + numbers)[None])
        elif kind in "HV":
            end, axis = self.at.copy(), "HV".index(kind)
            end[axis] = base[axis] + numbers[0]
            self._to(end[None])
        elif kind == "A":
            self._to(arc(self.at, numbers[:5], base + numbers[5:]))
        else:
            points = base + np.reshape(numbers, (-1, 2))
            if kind in "ST":
                # A smooth curve mirrors the last handle only after a curve of its own degree.
                last = self.handle if self.last in ("CS" if kind == "S" else "QT") else None
                first = self.at if last is None else 2.0 * self.at - last
                points = np.concatenate([[first], points])
            handle = points[-2]
            self._to(bezier(np.concatenate([[self.at], points])))
        self.handle, self.last = handle, kind

    def _to(self, points: Points) -> None:
        self.corners += len(points)
        if self.corners > _MOST_CORNERS:
            raise ValueError(f"a path has more than {_MOST_CORNERS} corners, those on curves")
        if not self.line:
            self.line = [self.at[None]]
        self.line.append(points)
        self.at = points[-1]

    def end(self, *, closed: bool) -> None:
        """End a line."""
        if self.line:
            points = np.concatenate(self.line)
            returns = bool(np.allclose(points[0], points[-1], rtol=0.0, atol=1e-9))
            points = points[:-1] if returns else points
            self.done.append(Subpath(points, closed or returns))
        self.line = []


def bezier(points: Points) -> Points:
    """Return points on a Bézier curve of any degree, without its first."""
    t = np.arange(1, CORNERS_OF_CURVE + 1) / CORNERS_OF_CURVE
    degree = len(points) - 1
    weights = [math.comb(degree, k) * t**k * (1.0 - t) ** (degree - k) for k in range(degree + 1)]
    curve = np.column_stack(weights) @ points
    curve[-1] = points[-1]
    return np.asarray(curve)


def arc(start: Corner, shape: list[float], end: Corner) -> Points:
    """Return points on an elliptical arc, without its first (SVG 1.1, F.6).

    Its shape: both radii, turn of the x axis in degrees, large-arc flag, sweep flag.
    """
    rx, ry = abs(shape[0]), abs(shape[1])
    if rx == 0.0 or ry == 0.0 or (start == end).all():
        return end[None]
    angle = math.radians(shape[2])
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    half = turn.T @ ((start - end) / 2.0) / (rx, ry)
    length = float(half @ half)
    if length > 1.0:
        # Radii that cannot reach grow until they do.
        rx, ry = rx * math.sqrt(length), ry * math.sqrt(length)
        half, length = half / math.sqrt(length), 1.0
    side = -1.0 if bool(shape[3]) == bool(shape[4]) else 1.0
    middle = side * math.sqrt(max(0.0, 1.0 / length - 1.0)) * np.array([half[1], -half[0]])
    first = math.atan2(*(half - middle)[::-1])
    sweep = (math.atan2(*(-half - middle)[::-1]) - first) % (2.0 * math.pi)
    if not shape[4] and sweep > 0.0:
        sweep -= 2.0 * math.pi
    number = max(2, math.ceil(abs(sweep) / (2.0 * math.pi) * CORNERS_OF_CIRCLE))
    angles = first + sweep * np.arange(1, number + 1) / number
    circle = np.column_stack([np.cos(angles), np.sin(angles)]) + middle
    points = (circle * (rx, ry)) @ turn.T + (start + end) / 2.0
    points[-1] = end
    return np.asarray(points)


def lines_of(kind: str, attributes: Mapping[str, str], view: View | None = None) -> list[Subpath]:
    """Return the lines of a shape in its own coordinates; ValueError when it cannot be used."""
    if kind == "path":
        data = attributes.get("d", "")
        return [] if data.strip() == "none" else subpaths(data)
    if kind in {"polygon", "polyline"}:
        points = np.reshape(numbers_in(attributes.get("points", "")), (-1, 2))
        if not len(points):
            return []
        closed = kind == "polygon" or bool((points[0] == points[-1]).all())
        return [Subpath(points, closed)]
    if kind == "rect":
        names = ("x", "y", "width", "height")
        x, y, width, height = (user_units(attributes, name, view) for name in names)
        low, high = np.array([x, y]), np.array([x + width, y + height])
        radii = np.clip(_radii(attributes, view), 0.0, (high - low) / 2.0)
    else:
        r = user_units(attributes, "r", view) if kind == "circle" else 0.0
        radii = np.array((r, r) if kind == "circle" else _radii(attributes, view))
        middle = np.array([user_units(attributes, name, view) for name in ("cx", "cy")])
        low, high = middle - radii, middle + radii
    return [Subpath(_rounded(low, high, radii), closed=True)]


def _rounded(low: Corner, high: Corner, radii: Corner) -> Points:
    """Return a rectangle whose corners are quarters of an ellipse."""
    if not radii.all():
        return rectangle(low, high)
    (x0, y0), (x1, y1) = low + radii, high - radii
    quarter = np.linspace(0.0, math.pi / 2.0, CORNERS_OF_CIRCLE // 4 + 1)
    angles = quarter + np.arange(4)[:, None] * (math.pi / 2.0)
    centres = np.array([(x1, y1), (x0, y1), (x0, y0), (x1, y0)])[:, None]
    points = centres + np.stack([np.cos(angles), np.sin(angles)], axis=-1) * radii
    return np.asarray(points.reshape(-1, 2))


def _radii(attributes: Mapping[str, str], view: View | None) -> tuple[float, float]:
    """Return rx and ry, of which one counts for both."""
    given = [user_units(attributes, name, view) for name in ("rx", "ry") if name in attributes]
    return (given[0], given[-1]) if given else (0.0, 0.0)


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
    if unit in _UNITS_M:
        return value * _UNITS_M[unit] / _PX_M
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
    notices: Sequence[Notice] = ()


def page_of(root: Mapping[str, str], settings: ReadSettings) -> Page:
    """Read width, height and viewBox of the root; ValueError when they cannot be used."""
    sides = [length(root.get(name, "100%")) for name in ("width", "height")]
    physical = all(unit in _UNITS_M for _, unit in sides)
    if not physical and any(unit not in {"", "px", "%"} for _, unit in sides):
        raise ValueError("its width and height are in units that cannot be used together")
    box = numbers_in(root.get("viewBox", ""))
    if box and (len(box) != 4 or not min(box[2:]) > 0.0):
        raise ValueError(f"its viewBox is {root['viewBox']!r}")
    given = not any(unit == "%" for _, unit in sides)
    unit_m, own = METRES.get(settings.unit), _UNITS_M[sides[0][1]] if physical else None
    notices = overruled(own, f"its width is {root.get('width', '')[:30]}", settings)
    physical = physical and not notices
    size = [value for value, _ in sides] if given else box[2:]
    if physical:
        unit_m = _UNITS_M[sides[0][1]]
        size = [value * _UNITS_M[unit] / unit_m for value, unit in sides]
    elif unit_m is not None or notices:
        # What the settings name is the user's unit, whatever px it is shown in.
        size = box[2:] or size
    if given and min(size, default=1.0) <= 0.0:
        raise ValueError("its width or height is not above 0")
    matrix = np.eye(3)
    if box and size:
        matrix = _fitted(box, size, root.get("preserveAspectRatio", ""))
    elif physical:
        # User units are the px of CSS then.
        matrix[0, 0] = matrix[1, 1] = _PX_M / _UNITS_M[sides[0][1]]
    if not size:
        return Page(matrix, unit_m, None, None, notices)
    view = (box[2], box[3]) if box else (size[0] / matrix[0, 0], size[1] / matrix[1, 1])
    return Page(matrix, unit_m, (size[0], size[1]), view, notices)


def _fitted(box: Sequence[float], size: Sequence[float], ratio: str = "") -> Matrix:
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
