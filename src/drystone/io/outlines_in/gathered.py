"""Stones of annotations, gathered one by one, and the picture that they are drawn on."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any

from drystone.errors import InputError, Notice
from drystone.io.file_errors import MANY, listed, short
from drystone.io.outlines_in.classes import class_of
from drystone.io.outlines_in.fill import Room
from drystone.io.outlines_in.model import (
    Area,
    OutlinedStone,
    OutlineFile,
    TooFewPointsError,
    left_aside,
    number_in,
    ring,
)
from drystone.io.patches import PlacedMask
from drystone.io.read_settings import ReadSettings

Drawn = Iterable[Sequence[Any]] | PlacedMask | None
"""Polygons, an outer ring and its holes each, or a mask, which is None without any pixel."""


@dataclass(frozen=True, eq=False)
class Pictured:
    """What is drawn on one picture."""

    name: str
    size_px: tuple[int, int] | None
    shapes: Sequence[Any]
    id: str = ""
    earlier: int = 0  # versions of the same shapes


def chosen(pictures: Sequence[Pictured], asked: str) -> Pictured:
    """Return the picture that was asked for, or the only one with shapes; E115 for several."""
    found = [picture for picture in pictures if picture.shapes] or list(pictures[:1])
    there = listed(short(picture.name) for picture in found)
    what = f"stones of {len(found)} images are in it."
    if asked:
        found = [p for p in pictures if asked in (p.name, PurePath(p.name).name, p.id)]
        what = f"no image or several are called {asked!r}."
    if len(found) > 1 or (asked and not found):
        cure = f"Say which one with --image NAME (ReadSettings.image); there are {there}."
        raise InputError("E115", what, cure=cure)
    return found[0] if found else Pictured("", None, ())


class Gathered:
    """Stones so far, what is none, and what has too few points to be an outline."""

    def __init__(self, settings: ReadSettings | None = None) -> None:
        self.room = Room(int((settings or ReadSettings()).max_image_mpx * 1e6))
        self.stones: list[OutlinedStone] = []
        self.aside = Counter[str]()
        self._slivers: list[str] = []
        self._groups: dict[object, int] = {}

    def add(
        self,
        where: str,
        drawn: Drawn,
        number: int | None = None,
        name: str = "",
        label: str = "",
        group: object = None,
    ) -> None:
        """Add a stone, without polygons of too few points; all of one group are one stone."""
        areas: tuple[Area, ...] = ()
        masks = (drawn,) if isinstance(drawn, PlacedMask) else ()
        if drawn is not None and not isinstance(drawn, PlacedMask):
            areas = self._areas(where, drawn)
            if not areas:
                return
        if group in self._groups:
            known = self.stones[self._groups[group]]
            both = replace(known, areas=known.areas + areas, masks=known.masks + masks)
            self.stones[self._groups[group]] = both
            return
        if group is not None:
            self._groups[group] = len(self.stones)
        self.stones.append(OutlinedStone(number, name, areas, masks, label))

    def labelled(self, where: str, text: str, drawn: Drawn, group: object = None) -> None:
        """Add a stone whose label says its number or its class."""
        self.add(where, drawn, number_in(text), text, class_of(text), group)

    def _areas(self, where: str, polygons: Iterable[Sequence[Any]]) -> tuple[Area, ...]:
        areas = []
        for outer, *holes in polygons:
            rings = []
            for points in (outer, *holes):
                try:
                    rings.append(ring(points))
                except TooFewPointsError:
                    self._slivers.append(f"{where} ({len(points)} points)")
                    if points is outer:
                        break
            if rings:
                areas.append(Area(tuple(rings)))
        return tuple(areas)

    def notices(self, cure: str = "") -> list[Notice]:
        """Name all that was left out; `cure` is that of what is no outline."""
        found = left_aside(+self.aside, cure)
        if self._slivers:
            text = f"outlines of less than 3 points left out: {listed(self._slivers, most=MANY)}."
            found.append(Notice("W119", text, "Draw them again if they are stones."))
        return found

    def file(self, cure: str = "", **more: Any) -> OutlineFile:
        """Return all as a file that says of which image each stone is."""
        more = {"notices": self.notices(cure), "names_images": True, **more}
        return OutlineFile(self.stones, **more)
