"""SVG: closed shapes, under all their transforms, in mm or in px."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree import ElementTree as ET

import numpy as np

from drystone.errors import InputError
from drystone.io.outlines_in.model import (
    METRES,
    Area,
    OutlinedStone,
    OutlineFile,
    damaged,
    entry,
    left_aside,
    number_in,
)
from drystone.io.outlines_in.svg_shapes import (
    PX_M,
    SHAPES,
    UNITS_M,
    Matrix,
    length,
    lines_of,
    moved,
    transform,
)
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

_HIDDEN = frozenset(
    {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "title", "desc", "metadata",
     "style", "script", "linearGradient", "radialGradient", "filter", "namedview"}
)  # fmt: skip
_GROUPS = frozenset({"svg", "g", "a", "switch"})
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_XLINK = "{http://www.w3.org/1999/xlink}href"
_LAYER = "stones"
_DEEPEST = 64
_MOST = 100_000


@dataclass(frozen=True, eq=False)
class _Place:
    """Where in the tree an element is drawn."""

    matrix: Matrix
    rule: str = "nonzero"
    stones: bool = False
    name: str = ""
    depth: int = 0
    inner: bool = False
    """In a viewport of its own, of which per cents are."""


@dataclass(frozen=True, eq=False)
class _Shape:
    """A shape that is drawn."""

    rings: tuple[Points, ...]
    place: _Place
    kind: str


def is_svg(data: bytes, suffix: str) -> bool:
    """Tell SVG by its root element or by its ending."""
    return suffix == ".svg" or b"<svg" in data[:4096] or b":svg" in data[:4096]


def read_svg(data: bytes, where: str, settings: ReadSettings) -> OutlineFile:
    """Read every closed shape that is drawn as a stone; subpaths of one path are its holes.

    Where there is a group of the name stones, only what is in it counts.  Open paths, text, and
    a rectangle over the whole page are left aside.  A width in mm (cm, in, pt …) makes it a
    drawing to scale; otherwise its unit is px, or what the settings say.

    Raises
    ------
    InputError
        E106 for what is no XML, E114 naming the element that cannot be used.
    """
    try:
        root = ET.fromstring(data)  # noqa: S314 - expat bounds what entities expand to
    except (ET.ParseError, ValueError, LookupError) as error:
        raise InputError(
            "E106", f"the drawing is damaged or cut short ({error}).", where=where,
            cure="Copy or export it again.",
        ) from error  # fmt: skip
    if _tag(root) != "svg":
        raise damaged(where, f"its root element is {_tag(root)}, not svg")
    with entry(where, "the element svg"):
        to_page, unit_m, page = _page(root, settings)
    walk = _Walk(root, where, _view(root, to_page, page))
    shapes = list(walk.shapes(to_page))
    if any(shape.place.stones for shape in shapes):
        outside = [shape for shape in shapes if not shape.place.stones]
        walk.aside.update({"shapes outside the group STONES": len(outside)})
        shapes = [shape for shape in shapes if shape.place.stones]
    stones = []
    for shape in shapes:
        if shape.kind == "rect" and page is not None and _covers(shape, page):
            walk.aside["rectangles over the whole page"] += 1
            continue
        name = shape.place.name
        area = Area(shape.rings, "evenodd" if shape.place.rule == "evenodd" else "nonzero")
        stones.append(OutlinedStone(number_in(name), name, (area,)))
    size = None if page is None or unit_m else (round(page[0]), round(page[1]))
    notices = left_aside(+walk.aside, "Only closed shapes are read.")
    return OutlineFile(tuple(stones), unit_m, size_px=size, notices=tuple(notices))


class _Walk:
    """Through all that is drawn."""

    def __init__(
        self, root: ET.Element, where: str, view: tuple[float, float] | None = None
    ) -> None:
        self.root, self.where, self.view = root, where, view
        self.aside: Counter[str] = Counter()
        self.known = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.count = 0

    def shapes(self, matrix: Matrix) -> Iterator[_Shape]:
        """Yield the shapes in the order in which they are drawn."""
        place = self._within(self.root, _Place(matrix))
        for child in self.root:
            yield from self._draw(child, place)

    def _draw(self, element: ET.Element, place: _Place) -> Iterator[_Shape]:
        kind = _tag(element)
        if kind in _HIDDEN or not _shown(element):
            return
        self.count += 1
        if self.count > _MOST or place.depth > _DEEPEST:
            raise damaged(self.where, "elements use each other too often or too deeply")
        with entry(self.where, _what(element, kind)):
            here = self._within(element, place)
            if kind in SHAPES:
                yield from self._shape(element, kind, here)
        if kind in _GROUPS:
            for child in element:
                yield from self._draw(child, here)
        elif kind == "use":
            yield from self._use(element, here)
        elif kind not in SHAPES:
            self.aside[kind] += 1

    def _use(self, element: ET.Element, place: _Place) -> Iterator[_Shape]:
        link = element.get("href") or element.get(_XLINK) or ""
        target = self.known.get(link.removeprefix("#")) if link.startswith("#") else None
        if target is None:
            raise damaged(self.where, f"{_what(element, 'use')} is of {link!r}, which is not there")
        named = number_in(target.get("id", "")) is not None
        inner = replace(place, name=target.get("id", "") if named else place.name)
        if _tag(target) == "symbol":
            inner = self._within(target, inner)
            for child in target:
                yield from self._draw(child, inner)
        else:
            yield from self._draw(target, inner)

    def _within(self, element: ET.Element, place: _Place) -> _Place:
        matrix = place.matrix @ transform(element.get("transform", ""))
        if _tag(element) == "use" or (_tag(element) == "svg" and element is not self.root):
            shift = np.eye(3)
            shift[:2, 2] = [length(element.get(name, "0"))[0] for name in ("x", "y")]
            matrix = matrix @ shift
        own = (element.get("id", ""), element.get(_LABEL, ""))
        words = {word.lower() for word in (*own, *element.get("class", "").split())}
        # Named by a use that places it, else by itself, else by the groups around it.
        name = place.name if number_in(place.name) else (own[1] or own[0] or place.name)
        return _Place(
            matrix,
            _styled(element, "fill-rule") or place.rule,
            place.stones or (_LAYER in words and _tag(element) == "g"),
            name if _tag(element) not in {"g", "svg"} or number_in(name) else place.name,
            place.depth + 1,
            place.inner or (_tag(element) in {"svg", "symbol"} and element is not self.root),
        )

    def _shape(self, element: ET.Element, kind: str, place: _Place) -> Iterator[_Shape]:
        lines = lines_of(kind, element.attrib, None if place.inner else self.view)
        closed = [line.points for line in lines if line.closed and len(line.points) > 2]
        if len(closed) < len(lines):
            self.aside[f"open lines in {kind}"] += len(lines) - len(closed)
        rings = tuple(moved(place.matrix, points) for points in closed)
        if not all(np.isfinite(ring).all() and np.abs(ring).max() < 1e9 for ring in rings):
            raise ValueError("a coordinate is not finite or beyond 1e9")
        if rings and any(np.ptp(ring, axis=0).min() > 0.0 for ring in rings):
            yield _Shape(rings, place, kind)
        elif rings:
            self.aside[f"{kind} without an area"] += 1


def _page(
    root: ET.Element, settings: ReadSettings
) -> tuple[Matrix, float | None, tuple[float, float] | None]:
    """Return the way from user units to the page, metres in its unit, and its size in it."""
    sides = [length(root.get(name, "100%")) for name in ("width", "height")]
    physical = all(unit in UNITS_M for _, unit in sides)
    if not physical and any(unit not in {"", "px", "%"} for _, unit in sides):
        raise ValueError("its width and height are in units that cannot be used together")
    box = [float(word) for word in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if word]
    if box and (len(box) != 4 or min(box[2:]) <= 0.0):
        raise ValueError(f"its viewBox is {root.get('viewBox')!r}")
    given = not any(unit == "%" for _, unit in sides)
    unit_m = METRES.get(settings.unit or "px")
    size = [value for value, _ in sides] if given else box[2:]
    if physical:
        unit_m = UNITS_M[sides[0][1]]
        size = [value * UNITS_M[unit] / unit_m for value, unit in sides]
    elif unit_m is not None:
        # What the settings name is the user's unit, whatever px it is shown in.
        size = box[2:] or size
    if given and min(size, default=1.0) <= 0.0:
        raise ValueError("its width or height is not above 0")
    matrix = np.eye(3)
    if box and size:
        scale = min(size[0] / box[2], size[1] / box[3])
        # As preserveAspectRatio does unless told otherwise: the box in the middle of the page.
        middle = [(side - scale * wide) / 2.0 for side, wide in zip(size, box[2:], strict=True)]
        matrix[0, 0] = matrix[1, 1] = scale
        matrix[:2, 2] = np.array(middle) - scale * np.array(box[:2])
    elif physical:
        # User units are the px of CSS then.
        matrix[0, 0] = matrix[1, 1] = PX_M / UNITS_M[sides[0][1]]
    return matrix, unit_m, (size[0], size[1]) if size else None


def _view(
    root: ET.Element, to_page: Matrix, page: tuple[float, float] | None
) -> tuple[float, float] | None:
    """Return the width and height of the page in user units; None when they are not known."""
    box = [float(word) for word in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if word]
    if box:
        return box[2], box[3]
    return None if page is None else (page[0] / to_page[0, 0], page[1] / to_page[1, 1])


def _covers(shape: _Shape, page: tuple[float, float]) -> bool:
    ring = shape.rings[0]
    slack = 1e-3 * np.array(page)
    return bool((ring.min(axis=0) <= slack).all() and (ring.max(axis=0) >= page - slack).all())


def _tag(element: ET.Element) -> str:
    return element.tag.rpartition("}")[2]


def _what(element: ET.Element, kind: str) -> str:
    name = element.get("id")
    return f"the {kind} {name!r}" if name else f"a {kind}"


def _styled(element: ET.Element, name: str) -> str:
    """Return a property from the style or from the attribute of its name."""
    for part in element.get("style", "").split(";"):
        key, _, value = part.partition(":")
        if key.strip() == name:
            return value.strip()
    return element.get(name, "")


def _shown(element: ET.Element) -> bool:
    return _styled(element, "display") != "none" and _styled(element, "visibility") != "hidden"
