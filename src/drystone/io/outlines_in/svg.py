"""SVG: closed shapes, under all their transforms and styles, in mm or in px."""

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple
from xml.etree import ElementTree as ET

import numpy as np
import shapely
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.files import entry, foreign, listed, too_large, unusable
from drystone.io.outlines_in import model
from drystone.io.outlines_in.classes import layer
from drystone.io.outlines_in.model import Area, OutlinedStone, OutlineFile
from drystone.io.outlines_in.silhouettes import areas_of, region
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

_MOST_OF_PATH = 1_000_000
"""Of a path; a stone has some hundred."""

_COMMAND = re.compile(r"([MmZzLlHhVvCcSsQqTtAa])")
# Possessive: what was taken is not given back, so no text takes longer than it is long.
_NUMBER = re.compile(rf"\s*+(?:,\s*+)?({_DIGITS})")
_FLAG = re.compile(r"\s*+(?:,\s*+)?([01])")
_ARGUMENTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}


class Subpath(NamedTuple):
    """A line of a path."""

    points: Points  # (n, 2), corners in order
    closed: bool  # whether the path says so, or it ends where it began


def subpaths(data: str) -> list[Subpath]:
    """Return the lines of path data."""
    pen, (before, *parts) = _Pen(), _COMMAND.split(data)
    if before.strip():
        raise ValueError(f"path data begins with {before.strip()[:20]!r}")
    for command, text in zip(parts[::2], parts[1::2], strict=True):
        count = _ARGUMENTS[command.upper()]
        numbers = _numbers(text, arc=command in "Aa")
        if not count and numbers:
            raise ValueError("numbers after z")
        if count and (not numbers or len(numbers) % count):
            raise ValueError(f"{command} has {len(numbers)} numbers, not a multiple of {count}")
        for start in range(0, len(numbers) or 1, count or 1):
            # What follows the first pair of a move is a line.
            later = {"M": "L", "m": "l"}.get(command, command) if start else command
            pen.draw(later, numbers[start : start + count])
    pen.end(closed=False)
    return pen.done


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
    at: Points = field(default_factory=lambda: np.zeros(2))
    begun: Points = field(default_factory=lambda: np.zeros(2))
    handle: Points | None = None  # last control point, which smooth curves mirror
    last: str = ""  # command

    def draw(self, command: str, numbers: list[float]) -> None:
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
        if self.corners > _MOST_OF_PATH:
            raise ValueError(f"a path has more than {_MOST_OF_PATH} corners, those on curves")
        if not self.line:
            self.line = [self.at[None]]
        self.line.append(points)
        self.at = points[-1]

    def end(self, *, closed: bool) -> None:
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


def arc(start: Points, shape: list[float], end: Points) -> Points:
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


def lines_of(kind: str, attributes: Mapping[str, str], view: View | None) -> list[Subpath]:
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


def _rounded(low: Points, high: Points, radii: Points) -> Points:
    """Return a rectangle whose corners are quarters of an ellipse."""
    if not radii.all():
        return model.rectangle(low, high)
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
    notices: Sequence[Notice]


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
    unit_m, own = model.METRES.get(settings.unit), _UNITS_M[sides[0][1]] if physical else None
    notices = model.overruled(own, f"its width is {root.get('width', '')[:30]}", settings)
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


def _fitted(box: Sequence[float], size: Sequence[float], ratio: str) -> Matrix:
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


_PAINT = {
    "fill": "black", "fill-opacity": "1", "stroke": "none", "stroke-opacity": "1",
    "stroke-width": "1",
}  # fmt: skip
"""Properties of paint, and what they are where nobody says it."""
_ASIDE = frozenset({"clip-rule", *_PAINT}) - {"fill", "stroke"}
"""Those that count only together with others; a rule of another kind is passed over, unless 0."""
SEEN = frozenset({"display", "visibility", "opacity", "fill-rule", "clip-path", "mask"})
SEEN |= _PAINT.keys() | _ASIDE
"""Properties that say whether a shape is seen, and what of it is filled."""

_MOVING = {
    "transform", "translate", "rotate", "scale", "offset", "offset-path", "zoom",
    "x", "y", "cx", "cy", "r", "rx", "ry", "d",
}  # fmt: skip
_SIZES = {"width", "height"}
NOTHING = {"", "none", "initial", "unset", "revert", "auto"}
"""Values that say nothing."""
_COMMENT = re.compile(r"/\*.*?(?:\*/|$)", re.DOTALL)
_RULE = re.compile(r"([^{}]*+)\{([^{}]*+)\}")
_SIMPLE = re.compile(r"(\*|[\w-]*+)([.#][\w-]++)?+")


class Styles:
    """Properties of elements by simple rules of style sheets, by `style`, and by attributes.

    ValueError where a rule that may hide, fill, move or shape has a selector that is more than a
    tag, a class or an id, or stands under a condition.
    """

    def __init__(self, root: ET.Element) -> None:
        # Of every selector: each property, how much its rule weighs, and its value.
        self._said: dict[str, dict[str, tuple[tuple[int, int], str]]] = {}
        place = 0
        for element in root.iter():
            if tag(element) != "style":
                continue
            media = element.get("media", "all").strip().lower()
            condition = "" if media in {"all", "screen"} else f"media {media}"
            for selector, said in _rules("".join(element.itertext()), condition):
                place += 1
                of_tag = selector[0] not in "*.#"
                weight = (4 * selector.count("#") + 2 * selector.count(".") + of_tag, place)
                known = self._said.setdefault(selector, {})
                known.update({name: (weight, value) for name, value in said.items()})

    def of(self, element: ET.Element) -> dict[str, str]:
        """Return the properties of an element; ValueError where its style moves or shapes it."""
        kind = tag(element)
        names = [f".{name}" for name in element.get("class", "").split()]
        names += [f"#{element.get('id')}"] if element.get("id") else []
        keys = ["*", kind, *names, *(f"{kind}{name}" for name in names)]
        best: dict[str, tuple[tuple[int, int], str]] = {}
        for key in keys:
            for name, said in self._said.get(key, {}).items():
                best[name] = max(said, best.get(name, said))
        properties = {name: element.get(name, "").strip() for name in SEEN if element.get(name)}
        properties |= {name: value for name, (_, value) in best.items()}
        properties |= declared(element.get("style", ""))
        # Words may be in capitals, but those of links are names.
        properties = {k: v if "(" in v else v.lower() for k, v in properties.items()}
        # The size of the page by its style is how a window shows it.
        shaping = _MOVING if kind in {"svg", "g"} else _MOVING | _SIZES
        for name in sorted(shaping & properties.keys()):
            if properties[name] not in NOTHING or element.get(name):
                raise ValueError(f"its style says {name}, which is read as an attribute only")
        return {k: v for k, v in properties.items() if v not in {"inherit", "unset"}}


def declared(body: str) -> dict[str, str]:
    """Return the properties of a declaration block."""
    pairs = (part.partition(":") for part in _COMMENT.sub("", body).split(";"))
    return {
        name.strip().lower().removeprefix("-webkit-"): value.partition("!")[0].strip()
        for name, _, value in pairs
        if value
    }


def _rules(text: str, condition: str) -> Iterator[tuple[str, Mapping[str, str]]]:
    """Yield the simple selectors of a sheet with what they say of shapes."""
    text = _COMMENT.sub("", text)
    at_rule = re.search(r"@(?!font-face|charset|namespace|import)[\w-]+", text)
    condition = condition or (at_rule[0] if at_rule else "")
    for prelude, body in _RULE.findall(text):
        said = {k: v for k, v in declared(body).items() if k in SEEN | _MOVING | _SIZES}
        selectors = [one.strip() for one in prelude.rpartition(";")[2].split(",")]
        if not said or selectors == ["@font-face"]:
            continue
        for selector in selectors:
            if _POINTED.search(selector):
                continue
            if condition or not selector or not _SIMPLE.fullmatch(selector):
                what = (condition or selector)[:30]
                telling = [k for k, v in said.items() if k not in _ASIDE or _is_0(v)]
                if not telling:
                    continue
                first = min(telling)
                cure = f"{PLAIN}, with attributes instead of styles."
                raise ValueError(f"its style sheet says {first} for {what!r}. {cure}")
            yield selector.removeprefix("*") if selector[1:] else selector, said


def tag(element: ET.Element) -> str:
    """Return the name of an element without its namespace."""
    return str(element.tag).rpartition("}")[2]


_HIDDEN = frozenset(
    {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "title", "desc", "metadata",
     "style", "script", "linearGradient", "radialGradient", "filter", "namedview"}
)  # fmt: skip
_GROUPS = frozenset({"g", "a", "switch"})
_CONDITIONS = {"requiredExtensions", "systemLanguage"}, {"requiredExtensions"}
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_XLINK = "{http://www.w3.org/1999/xlink}href"
_SHEETS = (b"<?xml-stylesheet", b"@import")
_LAYER = "stones"
_UNSEEN = "elements that are hidden"
_BARE = "elements without a fill or a line that is seen"
_MOST_TEXT = 2_000_000
"""Of attributes of what is drawn, beside two times what the file has: a use draws things again."""
_MOST_CLIPPED = 300_000
"""Corners of the shapes that are cut, and of their clip paths each time."""
_TEXT = "the drawing has long paths that are used too often."
_CLIPPED = f"its clip paths cut more than {_MOST_CLIPPED} corners."

_LINK = re.compile(r"""url\(\s*+(["']?)#([^"')\s]++)\1\s*+\)""")
_RELEASE = "Apply or release it where it was drawn"
_OUTSIDE = "outside of their clip paths, left out"
_CUT = "cut by their clip paths"
_MISSING = "clip paths that are not there, so nothing was cut"
_ALL = 1.0 - 1e-9
"""Share of a shape that is all of it."""
_VISIBLE = {"visible": True, "hidden": False, "collapse": False}

_POINTED = re.compile(r":(hover|focus|active)")
"""What no drawing that lies still is."""
_CLEAR = re.compile(
    r"none|transparent|#[\da-f]{3}0|#[\da-f]{6}00"
    r"|[a-z]++\((?:(?:[^,]*+,){3}|[^/]*+/)\s*+[.0]++%?\s*+\)",
    re.IGNORECASE,
)
"""Colours of alpha 0, which is after three commas or a slash."""


@dataclass(frozen=True, eq=False)
class _Place:
    """Where in the tree an element is drawn."""

    matrix: Matrix
    rule: str = "nonzero"
    stones: bool = False
    name: str = ""
    number: int | None = None
    group: str = ""
    depth: int = 0
    visible: bool = True
    paint: Mapping[str, str] = field(default_factory=lambda: _PAINT)
    clip: Any = None  # a planar shape outside of which nothing is; None when there is none
    clipping: bool = False  # what is drawn is a clip path, and its paint does not count


@dataclass(frozen=True, eq=False)
class _Shape:
    area: Area
    place: _Place
    kind: str


def read_svg(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read every closed shape that is drawn as a stone; subpaths of one path are its holes.

    Where there is a group of the name stones, only what is in it counts.  Lines that are neither
    closed nor filled, text, what is hidden or has no paint, and a rectangle over the whole page
    are left aside; drawings in the drawing are refused.  A width in mm (cm, in, pt …) makes it a
    drawing to scale; otherwise its unit is px, or what the settings say.
    """
    root = model.xml_root(data, "drawing", model.FEWER)
    if tag(root) != "svg":
        raise unusable(f"its root element is {tag(root)[:40]}, not svg")
    with entry("the element svg"):
        page = page_of(root.attrib, settings)
        walk = _Walk(root, page.view, _MOST_TEXT + 2 * len(data))
    shapes = list(walk.shapes(page))
    if any(shape.place.stones for shape in shapes):
        outside = [shape for shape in shapes if not shape.place.stones]
        walk.aside.update({"shapes outside the group STONES": len(outside)})
        shapes = [shape for shape in shapes if shape.place.stones]
    stones = []
    for shape in shapes:
        if shape.kind == "rect" and page.size is not None and _covers(shape, page.size):
            walk.aside["rectangles over the whole page"] += 1
            continue
        place, label = shape.place, layer(shape.place.group)
        stones.append(OutlinedStone(place.number, place.name, (shape.area,), label=label))
    px = page.size if page.unit_m is None else None
    size = None if px is None else (round(px[0]), round(px[1]))
    notices = model.left_aside(+walk.aside, "Only closed shapes are read.")
    cure = "Release the clips where it was drawn to read all that they hide."
    said = walk.clipped.items()
    notices += [Notice("W119", f"{what}: {listed(of)}.", cure) for what, of in said if of]
    notices += page.notices
    if any(sheet in data for sheet in _SHEETS):
        text = "a style sheet in another file was not read, whatever it hides or moves."
        notices.append(Notice("W119", text, "Put it into the drawing, in an element style."))
    return OutlineFile(stones, page.unit_m, size_px=size, notices=notices)


class _Walk:
    def __init__(self, root: ET.Element, view: View | None, most_text: int) -> None:
        self.root, self.view = root, view
        self.styles = Styles(root)
        self.aside: Counter[str] = Counter()
        # Of two with one id the first is meant.
        self.known = {e.get("id"): e for e in [*root.iter()][::-1] if e.get("id")}
        self.count = 0
        self.left = {_TEXT: most_text, _CLIPPED: _MOST_CLIPPED}
        self.left[model.TOO_MANY_CORNERS] = model.MOST_CORNERS
        self.regions: dict[tuple[str, bytes], Any] = {}
        self.clipped: dict[str, dict[str, None]] = {_OUTSIDE: {}, _CUT: {}, _MISSING: {}}

    def shapes(self, page: Page) -> Iterator[_Shape]:
        """Yield the shapes in the order in which they are drawn."""
        with entry("the element svg"):
            style = self.styles.of(self.root)
            place = self._within(self.root, _Place(page.matrix), style)
        for child in self.root:
            yield from self._draw(child, place)

    def _draw(self, element: ET.Element, place: _Place, *, used: bool = False) -> Iterator[_Shape]:
        """Draw an element; `used` when it is not shown where it stands."""
        kind, name = tag(element), element.get("id")
        inner = kind == "svg" or (kind == "symbol" and used)
        if kind in _HIDDEN and not inner:
            return
        self.count += 1
        if self.count > model.MOST_DRAWN or place.depth > model.DEEPEST:
            raise unusable("elements use each other too often or too deeply")
        self._spend(_TEXT, sum(map(len, element.attrib.values())))
        what = f"the {kind} {name!r}" if name else f"a {kind}"
        with entry(what):
            style = self.styles.of(element)
            if style.get("display") == "none" or _is_0(style.get("opacity", "1")):
                self.aside[_UNSEEN] += 1
            elif kind in SHAPES:
                yield from self._shape(element, self._within(element, place, style))
            elif kind in _GROUPS:
                here = self._within(element, place, style)
                for child in self._met(element) if kind == "switch" else element:
                    yield from self._draw(child, here)
            elif kind == "use":
                here = self._within(element, place, style)
                link = element.get("href") or element.get(_XLINK) or ""
                target = self.known.get(link.removeprefix("#")) if link.startswith("#") else None
                if target is None:
                    raise unusable(f"{what} is of {link!r}, which is not there")
                own = target.get("id", "")
                if model.number_in(own) is not None:
                    here = replace(here, name=own)
                yield from self._draw(target, here, used=True)
            elif inner:
                raise ValueError(f"a drawing in the drawing is not read. {PLAIN}")
            elif place.clipping:
                raise ValueError(f"a {kind} in a clip path is not read. {PLAIN}")
            else:
                self.aside[kind] += 1

    def _met(self, switch: ET.Element) -> Sequence[ET.Element]:
        """Return what of a switch is drawn: its first child without a condition, or in a language.

        Which stones there are does not depend on the language of who reads them.
        """
        ways = [child for child in switch if tag(child) not in _HIDDEN]
        few = ([way for way in ways if one.isdisjoint(way.keys())] for one in _CONDITIONS)
        drawn = next(filter(None, few), [])[:1]
        self.aside[_UNSEEN] += len(ways) - len(drawn)
        return drawn

    def _clip(self, style: Mapping[str, str], matrix: Matrix, place: _Place) -> Any:
        """Return where an element is there: a planar shape, or None for everywhere.

        ValueError for masks, and for clips of other kinds than shapes.
        """
        if style.get("mask", "none") not in NOTHING:
            raise ValueError(f"its mask is not read. {_RELEASE}")
        said = style.get("clip-path", "none")
        if said in NOTHING:
            return place.clip
        found = _LINK.fullmatch(said)
        if found is None:
            raise ValueError(f"its clip path {said[:30]!r} is not read. {_RELEASE}")
        clip = self.known.get(found[2])
        if clip is None or tag(clip) != "clipPath":
            self.clipped[_MISSING][found[2]] = None
            return place.clip
        if clip.get("clipPathUnits") == "objectBoundingBox":
            what = "its clip path is in shares of its box, which is not read."
            raise ValueError(f"{what} {_RELEASE}")
        key = (found[2], matrix.tobytes())
        if key not in self.regions:
            self.regions[key] = self._region(clip, matrix, place.depth + 1)
        whole = self.regions[key]
        with foreign(_no_clip):
            if place.clip is not None:
                self._spend(_CLIPPED, int(shapely.get_num_coordinates([place.clip, whole]).sum()))
                whole = shapely.intersection(place.clip, whole)
            shapely.prepare(whole)
        return whole

    def _region(self, clip: ET.Element, matrix: Matrix, depth: int) -> Any:
        """Return what a clip path leaves; of what else it holds nothing is said."""
        if depth > model.DEEPEST:
            raise unusable("clip paths use each other too often or too deeply")
        aside = self.aside.copy()
        here = _Place(matrix, depth=depth, clipping=True)
        here = self._within(clip, here, self.styles.of(clip))
        areas = [shape.area for child in clip for shape in self._draw(child, here)]
        self.aside = aside
        self._spend(_CLIPPED, len(clip) + sum(len(ring) for area in areas for ring in area.rings))
        with foreign(_no_clip):
            return shapely.union_all([region(area.rings, area.rule) for area in areas])

    def _inside(self, name: str, area: Area, clip: Any) -> Area:
        """Return what of a shape is there, perhaps no ring; without a name nothing is said."""
        corners = np.concatenate(area.rings)
        box = shapely.box(*corners.min(axis=0), *corners.max(axis=0))
        if shapely.covers(clip, box):
            return area
        share, inside = 0.0, tuple[Area, ...]()
        if not shapely.disjoint(clip, box):
            self._spend(_CLIPPED, len(corners) + int(shapely.get_num_coordinates(clip)))
            with foreign(_no_clip):
                whole = region(area.rings, area.rule)
                left = shapely.intersection(whole, clip)
                inside, share = areas_of(left), float(left.area) / max(whole.area, 1e-300)
        if share > _ALL:
            return area
        if share < 1.0 - _ALL:
            self.clipped[_OUTSIDE] |= {name: None} if name else {}
            return Area(())
        self.clipped[_CUT] |= {f"{name} ({100 * share:.2g} % is left)": None} if name else {}
        return Area(tuple(ring for part in inside for ring in part.rings))

    def _spend(self, what: str, number: int) -> None:
        self.left[what] -= number
        if self.left[what] < 0:
            release = f"{_RELEASE}, or export the outlines of stones only."
            raise too_large(what, release if what == _CLIPPED else model.FEWER)

    def _within(self, element: ET.Element, place: _Place, style: Mapping[str, str]) -> _Place:
        turn = transform(element.get("transform", ""))
        origin = style.get("transform-origin") or element.get("transform-origin", "")
        if origin and (turn[:2, :2] != np.eye(2)).any():
            raise ValueError("its transform-origin is not read")
        matrix = place.matrix @ turn
        if tag(element) == "use":
            shift = np.eye(3)
            shift[:2, 2] = [user_units(element.attrib, name, self.view) for name in ("x", "y")]
            matrix = matrix @ shift
        own = (element.get("id", ""), element.get(_LABEL, ""))
        words = {word.lower() for word in (*own, *element.get("class", "").split())}
        # Named by a use that places it, else by itself, else by the groups around it.
        name = place.name if model.number_in(place.name) else (own[1] or own[0] or place.name)
        # Inkscape's label is the name, but the number may be in the id beside it.
        numbers = map(model.number_in, (place.name, own[1], own[0]))
        return replace(
            place,
            matrix=matrix,
            rule=style.get("clip-rule" if place.clipping else "fill-rule", place.rule),
            stones=place.stones or (_LAYER in words and tag(element) == "g"),
            name=name if tag(element) not in {"g", "svg"} or model.number_in(name) else place.name,
            number=next(filter(None, numbers), place.number),
            group=(own[1] or own[0] or place.group) if tag(element) == "g" else place.group,
            depth=place.depth + 1,
            visible=_VISIBLE.get(style.get("visibility", ""), place.visible),
            paint={name: style.get(name, said) for name, said in place.paint.items()},
            clip=self._clip(style, matrix, place),
        )

    def _shape(self, element: ET.Element, place: _Place) -> Iterator[_Shape]:
        kind, filled = tag(element), place.clipping or self._shows(place.paint, "fill")
        if not place.visible or not (filled or self._shows(place.paint, "stroke")):
            self.aside[_BARE if place.visible else _UNSEEN] += 1
            return
        lines = lines_of(kind, element.attrib, self.view)
        # What is filled is closed by that.
        closed = [one.points for one in lines if (one.closed or filled) and len(one.points) > 2]
        if len(closed) < len(lines):
            self.aside[f"open lines in {kind}"] += len(lines) - len(closed)
        self._spend(model.TOO_MANY_CORNERS, sum(map(len, closed)))
        turn, shift = place.matrix[:2, :2].T, place.matrix[:2, 2]
        rings = tuple(model.within_reach(points @ turn + shift) for points in closed)
        if not rings:
            return
        area = Area(rings, "evenodd" if place.rule == "evenodd" else "nonzero")
        if place.clip is not None:
            name = "" if place.clipping else place.name or f"a {kind}"
            area = self._inside(name, area, place.clip)
        if any(np.ptp(ring, axis=0).min() > 0.0 for ring in area.rings):
            yield _Shape(area, place, kind)
        elif area.rings:
            self.aside[f"{kind} without an area"] += 1

    def _shows(self, paint: Mapping[str, str], what: str) -> bool:
        """Tell whether the fill or the stroke is seen."""
        colour, link = paint[what], _LINK.match(paint[what])
        if link:
            # What stands after it counts where the gradient is not there.
            colour = "" if link[2] in self.known else colour[link.end() :].strip() or "none"
        shares = (said for name, said in paint.items() if name.startswith(f"{what}-"))
        return not (_CLEAR.fullmatch(colour) or any(map(_is_0, shares)))


def _no_clip(why: str) -> InputError:
    return unusable(f"clip paths cannot be used ({why})")


def _covers(shape: _Shape, page: tuple[float, float]) -> bool:
    ring = shape.area.rings[0]
    slack = 1e-3 * np.array(page)
    return bool((ring.min(axis=0) <= slack).all() and (ring.max(axis=0) >= page - slack).all())


def _is_0(text: str) -> bool:
    """Tell an opacity or a width of nothing; what is no number is none."""
    found = _LENGTH.fullmatch(text)
    return found is not None and float(found[1]) <= 0.0
