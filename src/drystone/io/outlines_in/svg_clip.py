"""Clip paths of SVG: what of a shape is there."""

import re
from collections.abc import Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import shapely

from drystone.errors import InputError, Notice
from drystone.io.file_errors import listed, too_large, unusable
from drystone.io.foreign import foreign
from drystone.io.outlines_in.silhouettes import areas_of, region
from drystone.io.outlines_in.svg_shapes import SHAPES, lines_of
from drystone.io.outlines_in.svg_style import Styles, tag
from drystone.io.outlines_in.svg_view import Matrix, View, moved, transform, user_units
from drystone.kernels.polygons import Points

_NOTHING = {"", "none", "initial", "revert"}
_LINK = re.compile(r"""url\(\s*+(["']?)#([^"')\s]++)\1\s*+\)""")
_RELEASE = "Apply or release it where it was drawn"
_MOST_CORNERS = 300_000
"""Of the shapes that are cut, and of their clip paths each time."""
_ALL = 1.0 - 1e-9
"""Share of a shape that is all of it."""

Style = Mapping[str, str]


class Clips:
    """The clip paths of a drawing, and what they have left out and cut."""

    def __init__(self, known: Mapping[str | None, ET.Element], styles: Styles) -> None:
        self._known, self._styles = known, styles
        self._regions: dict[tuple[str, bytes, View | None], Any] = {}
        self._left = _MOST_CORNERS
        self._outside: list[str] = []
        self._cut: list[str] = []
        self._missing: dict[str, None] = {}

    def within(
        self, element: ET.Element, style: Style, matrix: Matrix, view: View | None, around: Any
    ) -> Any:
        """Return where an element is there: a planar shape, or None for everywhere.

        ValueError for masks, and for clips of other kinds than shapes.
        """
        if style.get("mask", "none") not in _NOTHING:
            raise ValueError(f"its mask is not read. {_RELEASE}")
        said = style.get("clip-path", "none")
        if said in _NOTHING:
            return around
        found = _LINK.fullmatch(said)
        if found is None:
            raise ValueError(f"its clip path {said[:30]!r} is not read. {_RELEASE}")
        clip = self._known.get(found[2])
        if clip is None or tag(clip) != "clipPath":
            self._missing[found[2]] = None
            return around
        if clip.get("clipPathUnits") == "objectBoundingBox":
            matrix = matrix @ _box(element, view)
        key = (found[2], matrix.tobytes(), view)
        if key not in self._regions:
            parts = self._parts(clip, matrix, view)
            with foreign(_unusable):
                shapes = [region(rings, rule) for rings, rule in parts]
                self._regions[key] = shapely.union_all(shapes) if shapes else shapely.Polygon()
        with foreign(_unusable):
            return self._both(around, self._regions[key])

    def viewport(self, corners: Points, around: Any) -> Any:
        """Return where what an inner drawing holds is there."""
        with foreign(_unusable):
            return self._both(around, shapely.make_valid(shapely.Polygon(corners)))

    def rings(
        self, name: str, rings: Sequence[Points], rule: str, clip: Any
    ) -> tuple[tuple[Points, ...], str]:
        """Return what of a shape is there, and its fill rule; no rings when nothing is."""
        with foreign(_unusable):
            return self._inside(name, rings, rule, clip)

    def _inside(
        self, name: str, rings: Sequence[Points], rule: str, clip: Any
    ) -> tuple[tuple[Points, ...], str]:
        all_of = tuple(rings), rule
        corners = np.concatenate(rings)
        box = shapely.box(*corners.min(axis=0), *corners.max(axis=0))
        if shapely.covers(clip, box):
            return all_of
        if shapely.disjoint(clip, box):
            self._outside.append(name)
            return (), rule
        self._spend(len(corners) + int(shapely.get_num_coordinates(clip)))
        whole = region(rings, rule)
        inside = areas_of(shapely.intersection(whole, clip))
        share = sum(shapely.Polygon(a.rings[0], a.rings[1:]).area for a in inside)
        share /= max(whole.area, 1e-300)
        if share > _ALL:
            return all_of
        if share < 1.0 - _ALL:
            self._outside.append(name)
            return (), rule
        self._cut.append(f"{name} ({100 * share:.2g} % is left)")
        return tuple(ring for area in inside for ring in area.rings), "evenodd"

    def notices(self) -> list[Notice]:
        """Say what was left out and cut."""
        notices = []
        for which, what in (
            (self._outside, "outside of their clip paths, left out"),
            (self._cut, "cut by their clip paths"),
            (list(self._missing), "clip paths that are not there, so nothing was cut"),
        ):
            if which:
                text = f"{what}: {listed(which)}."
                cure = "Release the clips where it was drawn to read all that they hide."
                notices.append(Notice("W119", text, cure))
        return notices

    def _parts(
        self, clip: ET.Element, matrix: Matrix, view: View | None
    ) -> list[tuple[list[Points], str]]:
        """Return the shapes of a clip path: rings and their fill rule."""
        style = self._own_style(clip)
        matrix = matrix @ transform(clip.get("transform", ""))
        parts = []
        for element in clip:
            self._spend(1)
            child, place, its = element, matrix, {**style, **self._own_style(element)}
            if tag(element) == "use":
                shift = np.eye(3)
                shift[:2, 2] = [user_units(element.attrib, name, view) for name in ("x", "y")]
                place = place @ transform(element.get("transform", "")) @ shift
                link = element.get("href") or element.get("{http://www.w3.org/1999/xlink}href")
                child = self._known.get((link or "").removeprefix("#"), element)
                its |= self._own_style(child)
            if tag(child) in {"text", "use"}:
                raise ValueError(f"a {tag(child)} in its clip path is not read. {_RELEASE}")
            hidden = its.get("display") == "none" or its.get("visibility", "visible") != "visible"
            if hidden or tag(child) not in SHAPES:
                continue
            place = place @ transform(child.get("transform", ""))
            lines = lines_of(tag(child), child.attrib, view)
            rings = [moved(place, one.points) for one in lines if len(one.points) > 2]
            if rings:
                self._spend(sum(map(len, rings)))
                parts.append((rings, its.get("clip-rule", "nonzero")))
        return parts

    def _own_style(self, element: ET.Element) -> Style:
        style = self._styles.of(element)
        if {style.get(name, "none") for name in ("clip-path", "mask")} - _NOTHING:
            raise ValueError(f"its clip path is clipped, which is not read. {_RELEASE}")
        return style

    def _both(self, around: Any, clip: Any) -> Any:
        if around is None:
            return _prepared(clip)
        self._spend(int(shapely.get_num_coordinates([around, clip]).sum()))
        return _prepared(shapely.intersection(around, clip))

    def _spend(self, corners: int) -> None:
        self._left -= corners
        if self._left < 0:
            raise _too_long()


def _too_long() -> InputError:
    what = f"its clip paths cut more than {_MOST_CORNERS} corners."
    return too_large(what, f"{_RELEASE}, or export the outlines of stones only.")


def _unusable(why: str) -> InputError:
    return unusable(f"clip paths cannot be used ({why})")


def _prepared(shape: Any) -> Any:
    shapely.prepare(shape)
    return shape


def _box(element: ET.Element, view: View | None) -> Matrix:
    """Return the way from shares of the box of a shape to its user units."""
    if tag(element) not in SHAPES:
        raise ValueError(f"its clip path is in shares of its box, which is not read. {_RELEASE}")
    lines = lines_of(tag(element), element.attrib, view)
    points = np.concatenate([one.points for one in lines]) if lines else np.zeros((1, 2))
    matrix = np.eye(3)
    matrix[:2, :2] = np.diag(np.ptp(points, axis=0))
    matrix[:2, 2] = points.min(axis=0)
    return matrix
