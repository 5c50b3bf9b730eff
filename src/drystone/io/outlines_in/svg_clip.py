"""Clip paths of SVG: what of a shape is there."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import shapely

from drystone.errors import InputError, Notice
from drystone.io.file_errors import listed, too_large, unusable
from drystone.io.foreign import foreign
from drystone.io.outlines_in.model import Area
from drystone.io.outlines_in.silhouettes import areas_of, region
from drystone.io.outlines_in.svg_style import tag
from drystone.io.outlines_in.svg_view import Matrix
from drystone.kernels.polygons import Points

_NOTHING = {"", "none", "initial", "revert"}
_LINK = re.compile(r"""url\(\s*+(["']?)#([^"')\s]++)\1\s*+\)""")
_RELEASE = "Apply or release it where it was drawn"
_MOST_CORNERS = 300_000
"""Of the shapes that are cut, and of their clip paths each time."""
_ALL = 1.0 - 1e-9
"""Share of a shape that is all of it."""

Rings = tuple[Sequence[Points], str]
"""Rings and their fill rule."""


class Clips:
    """The clip paths of a drawing, and what they have left out and cut."""

    def __init__(self, known: Mapping[str | None, ET.Element]) -> None:
        self._known = known
        self._regions: dict[tuple[str, bytes], Any] = {}
        self._left = _MOST_CORNERS
        self._outside: list[str] = []
        self._cut: list[str] = []
        self._missing: dict[str, None] = {}

    def within(
        self,
        style: Mapping[str, str],
        matrix: Matrix,
        around: Any,
        drawn: Callable[[ET.Element], list[Rings]],
    ) -> Any:
        """Return where an element is there: a planar shape, or None for everywhere.

        `drawn` returns what a clip path holds.  ValueError for masks, and for clips of other kinds
        than shapes.
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
            raise ValueError(
                f"its clip path is in shares of its box, which is not read. {_RELEASE}"
            )
        key = (found[2], matrix.tobytes())
        if key not in self._regions:
            parts = drawn(clip)
            self._spend(len(clip) + sum(len(ring) for rings, _ in parts for ring in rings))
            with foreign(_unusable):
                self._regions[key] = shapely.union_all([region(*part) for part in parts])
        whole = self._regions[key]
        with foreign(_unusable):
            if around is not None:
                self._spend(int(shapely.get_num_coordinates([around, whole]).sum()))
                whole = shapely.intersection(around, whole)
            shapely.prepare(whole)
        return whole

    def inside(self, name: str, rings: Sequence[Points], rule: str, clip: Any) -> Rings:
        """Return what of a shape is there, and its fill rule; no rings when nothing is.

        What has no name is not told.
        """
        corners = np.concatenate(rings)
        box = shapely.box(*corners.min(axis=0), *corners.max(axis=0))
        if shapely.covers(clip, box):
            return rings, rule
        share, inside = 0.0, tuple[Area, ...]()
        if not shapely.disjoint(clip, box):
            self._spend(len(corners) + int(shapely.get_num_coordinates(clip)))
            with foreign(_unusable):
                whole = region(rings, rule)
                left = shapely.intersection(whole, clip)
                inside, share = areas_of(left), float(left.area) / max(whole.area, 1e-300)
        if share > _ALL:
            return rings, rule
        if share < 1.0 - _ALL:
            self._outside += [name] if name else []
            return (), rule
        self._cut += [f"{name} ({100 * share:.2g} % is left)"] if name else []
        return tuple(ring for area in inside for ring in area.rings), "evenodd"

    def notices(self) -> list[Notice]:
        """Say what was left out and cut."""
        cure = "Release the clips where it was drawn to read all that they hide."
        return [
            Notice("W119", f"{what}: {listed(which)}.", cure)
            for which, what in (
                (self._outside, "outside of their clip paths, left out"),
                (self._cut, "cut by their clip paths"),
                (self._missing, "clip paths that are not there, so nothing was cut"),
            )
            if which
        ]

    def _spend(self, corners: int) -> None:
        self._left -= corners
        if self._left < 0:
            what = f"its clip paths cut more than {_MOST_CORNERS} corners."
            raise too_large(what, f"{_RELEASE}, or export the outlines of stones only.")


def _unusable(why: str) -> InputError:
    return unusable(f"clip paths cannot be used ({why})")
