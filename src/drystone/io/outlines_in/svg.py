"""SVG: closed shapes, under all their transforms, in mm or in px."""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import shapely

from drystone.errors import InputError, Notice
from drystone.io.file_errors import entry, listed, too_large, unusable
from drystone.io.foreign import foreign
from drystone.io.outlines_in import svg_shapes
from drystone.io.outlines_in.classes import layer
from drystone.io.outlines_in.model import (
    Area,
    OutlinedStone,
    OutlineFile,
    left_aside,
    number_in,
    within_reach,
    xml_root,
)
from drystone.io.outlines_in.silhouettes import areas_of, region
from drystone.io.outlines_in.svg_shapes import PLAIN, SHAPES, Matrix, Page, View
from drystone.io.outlines_in.svg_style import NOTHING, Styles, tag
from drystone.io.read_settings import ReadSettings

_HIDDEN = frozenset(
    {"defs", "symbol", "clipPath", "mask", "marker", "pattern", "title", "desc", "metadata",
     "style", "script", "linearGradient", "radialGradient", "filter", "namedview"}
)  # fmt: skip
_GROUPS = frozenset({"g", "a", "switch"})
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_XLINK = "{http://www.w3.org/1999/xlink}href"
_SHEET = b"<?xml-stylesheet"
_LAYER = "stones"
_UNSEEN = "elements that are hidden"
_DEEPEST = 64
_MOST = 100_000
_MOST_CORNERS = 10_000_000
_MOST_TEXT = 2_000_000
"""Of attributes of what is drawn, beside two times what the file has: a use draws things again."""
_MOST_CLIPPED = 300_000
"""Corners of the shapes that are cut, and of their clip paths each time."""
_TEXT = "the drawing has long paths that are used too often."
_CORNERS = f"the drawing has more than {_MOST_CORNERS} corners, those on curves."
_CLIPPED = f"its clip paths cut more than {_MOST_CLIPPED} corners."
_FEWER = "Export the outlines of stones only, with fewer corners."
_LINK = re.compile(r"""url\(\s*+(["']?)#([^"')\s]++)\1\s*+\)""")
_RELEASE = "Apply or release it where it was drawn"
_OUTSIDE = "outside of their clip paths, left out"
_CUT = "cut by their clip paths"
_MISSING = "clip paths that are not there, so nothing was cut"
_ALL = 1.0 - 1e-9
"""Share of a shape that is all of it."""
_VISIBLE = {"visible": True, "hidden": False, "collapse": False}

_UNPAINTED = {"none", "transparent"}

Style = dict[str, str]
"""Properties of an element."""


@dataclass(frozen=True, eq=False)
class _Place:
    """Where in the tree an element is drawn."""

    matrix: Matrix
    rule: str = "nonzero"
    stones: bool = False
    name: str = ""
    group: str = ""
    depth: int = 0
    visible: bool = True
    fill: str = "black"
    stroke: str = "none"
    clip: Any = None  # a planar shape outside of which nothing is; None when there is none
    clipping: bool = False  # what is drawn is a clip path, and its paint does not count


@dataclass(frozen=True, eq=False)
class _Shape:
    area: Area
    place: _Place
    kind: str


def is_svg(data: bytes, suffix: str) -> bool:
    """Tell SVG by its root element or by its ending."""
    return suffix == ".svg" or b"<svg" in data[:4096] or b":svg" in data[:4096]


def read_svg(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read every closed shape that is drawn as a stone; subpaths of one path are its holes.

    Where there is a group of the name stones, only what is in it counts.  Lines that are neither
    closed nor filled, text, what is hidden or has no paint, and a rectangle over the whole page
    are left aside; drawings in the drawing are refused.  A width in mm (cm, in, pt …) makes it a
    drawing to scale; otherwise its unit is px, or what the settings say.
    """
    root = xml_root(data, "drawing", _FEWER)
    if tag(root) != "svg":
        raise unusable(f"its root element is {tag(root)[:40]}, not svg")
    with entry("the element svg"):
        page = svg_shapes.page_of(root.attrib, settings)
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
        name = shape.place.name
        label = layer(shape.place.group)
        stones.append(OutlinedStone(number_in(name), name, (shape.area,), label=label))
    px = page.size if page.unit_m is None else None
    size = None if px is None else (round(px[0]), round(px[1]))
    notices = left_aside(+walk.aside, "Only closed shapes are read.")
    cure = "Release the clips where it was drawn to read all that they hide."
    said = walk.clipped.items()
    notices += [Notice("W119", f"{what}: {listed(of)}.", cure) for what, of in said if of]
    notices += page.notices
    if _SHEET in data:
        text = "a style sheet in another file was not read, whatever it hides or moves."
        notices.append(Notice("W119", text, "Put it into the drawing, in an element style."))
    return OutlineFile(stones, page.unit_m, size_px=size, notices=notices)


class _Walk:
    """Through all that is drawn."""

    def __init__(self, root: ET.Element, view: View | None, most_text: int) -> None:
        self.root, self.view = root, view
        self.styles = Styles(root)
        self.aside: Counter[str] = Counter()
        self.known = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.count = 0
        self.left = {_TEXT: most_text, _CORNERS: _MOST_CORNERS, _CLIPPED: _MOST_CLIPPED}
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
        if self.count > _MOST or place.depth > _DEEPEST:
            raise unusable("elements use each other too often or too deeply")
        self._spend(_TEXT, sum(map(len, element.attrib.values())))
        what = f"the {kind} {name!r}" if name else f"a {kind}"
        with entry(what):
            style = self.styles.of(element)
            if _vanishes(style):
                self.aside[_UNSEEN] += 1
            elif kind in SHAPES:
                yield from self._shape(element, self._within(element, place, style))
            elif kind in _GROUPS:
                here = self._within(element, place, style)
                for child in element:
                    yield from self._draw(child, here)
            elif kind == "use":
                here = self._within(element, place, style)
                link = element.get("href") or element.get(_XLINK) or ""
                target = self.known.get(link.removeprefix("#")) if link.startswith("#") else None
                if target is None:
                    raise unusable(f"{what} is of {link!r}, which is not there")
                own = target.get("id", "")
                if number_in(own) is not None:
                    here = replace(here, name=own)
                yield from self._draw(target, here, used=True)
            elif inner:
                raise ValueError(f"a drawing in the drawing is not read. {PLAIN}")
            elif place.clipping:
                raise ValueError(f"a {kind} in a clip path is not read. {PLAIN}")
            else:
                self.aside[kind] += 1

    def _clip(self, style: Style, matrix: Matrix, place: _Place) -> Any:
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
        if depth > _DEEPEST:
            raise unusable("clip paths use each other too often or too deeply")
        aside = self.aside.copy()
        here = _Place(matrix, depth=depth, clipping=True)
        here = self._within(clip, here, self.styles.of(clip))
        areas = [shape.area for child in clip for shape in self._draw(child, here)]
        self.aside = aside
        self._spend(_CLIPPED, len(clip) + sum(len(ring) for area in areas for ring in area.rings))
        with foreign(_no_clip):
            return shapely.union_all([region(area.rings, area.rule) for area in areas])

    def _inside(self, name: str, area: Area, clip: Any) -> Area | None:
        """Return what of a shape is there; of one without a name nothing is said."""
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
            return None
        self.clipped[_CUT] |= {f"{name} ({100 * share:.2g} % is left)": None} if name else {}
        return Area(tuple(ring for part in inside for ring in part.rings))

    def _spend(self, what: str, number: int) -> None:
        self.left[what] -= number
        if self.left[what] < 0:
            release = f"{_RELEASE}, or export the outlines of stones only."
            raise too_large(what, release if what == _CLIPPED else _FEWER)

    def _within(self, element: ET.Element, place: _Place, style: Style) -> _Place:
        turn = svg_shapes.transform(element.get("transform", ""))
        origin = style.get("transform-origin") or element.get("transform-origin", "")
        if origin and (turn[:2, :2] != np.eye(2)).any():
            raise ValueError("its transform-origin is not read")
        matrix = place.matrix @ turn
        if tag(element) == "use":
            shift = np.eye(3)
            shift[:2, 2] = [
                svg_shapes.user_units(element.attrib, name, self.view) for name in ("x", "y")
            ]
            matrix = matrix @ shift
        own = (element.get("id", ""), element.get(_LABEL, ""))
        words = {word.lower() for word in (*own, *element.get("class", "").split())}
        # Named by a use that places it, else by itself, else by the groups around it.
        name = place.name if number_in(place.name) else (own[1] or own[0] or place.name)
        return replace(
            place,
            matrix=matrix,
            rule=style.get("clip-rule" if place.clipping else "fill-rule", place.rule),
            stones=place.stones or (_LAYER in words and tag(element) == "g"),
            name=name if tag(element) not in {"g", "svg"} or number_in(name) else place.name,
            group=(own[1] or own[0] or place.group) if tag(element) == "g" else place.group,
            depth=place.depth + 1,
            visible=_VISIBLE.get(style.get("visibility", ""), place.visible),
            fill=style.get("fill", place.fill),
            stroke=style.get("stroke", place.stroke),
            clip=self._clip(style, matrix, place),
        )

    def _shape(self, element: ET.Element, place: _Place) -> Iterator[_Shape]:
        kind, filled = tag(element), place.clipping or place.fill not in _UNPAINTED
        if not place.visible or not (filled or place.stroke not in _UNPAINTED):
            self.aside[_UNSEEN] += 1
            return
        lines = svg_shapes.lines_of(kind, element.attrib, self.view)
        # What is filled is closed by that.
        closed = [one.points for one in lines if (one.closed or filled) and len(one.points) > 2]
        if len(closed) < len(lines):
            self.aside[f"open lines in {kind}"] += len(lines) - len(closed)
        self._spend(_CORNERS, sum(map(len, closed)))
        rings = tuple(within_reach(svg_shapes.moved(place.matrix, points)) for points in closed)
        if not rings:
            return
        area: Area | None = Area(rings, "evenodd" if place.rule == "evenodd" else "nonzero")
        if area and place.clip is not None:
            name = "" if place.clipping else place.name or f"a {kind}"
            area = self._inside(name, area, place.clip)
        if area and any(np.ptp(ring, axis=0).min() > 0.0 for ring in area.rings):
            yield _Shape(area, place, kind)
        elif area:
            self.aside[f"{kind} without an area"] += 1


def _no_clip(why: str) -> InputError:
    return unusable(f"clip paths cannot be used ({why})")


def _covers(shape: _Shape, page: tuple[float, float]) -> bool:
    ring = shape.area.rings[0]
    slack = 1e-3 * np.array(page)
    return bool((ring.min(axis=0) <= slack).all() and (ring.max(axis=0) >= page - slack).all())


def _vanishes(style: Style) -> bool:
    """Tell what is hidden with all that is in it."""
    if style.get("display") == "none":
        return True
    try:
        return float(style.get("opacity", "1").removesuffix("%")) <= 0.0
    except ValueError:
        return False
