"""Stones of annotations, gathered one by one: their picture, and which classes are stones."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any

from drystone.errors import InputError, Notice
from drystone.io.files import MANY, listed, short, unfit
from drystone.io.outlines_in import model
from drystone.io.outlines_in.model import Area, OutlinedStone, OutlineFile, Room
from drystone.io.patches import PlacedMask

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

    def __init__(self, max_px: int) -> None:
        self.room = Room(max_px)
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
        self.add(where, drawn, model.number_in(text), text, class_of(text), group)

    def _areas(self, where: str, polygons: Iterable[Sequence[Any]]) -> tuple[Area, ...]:
        areas = []
        for outer, *holes in polygons:
            rings = []
            for points in (outer, *holes):
                try:
                    rings.append(model.ring(points))
                except model.TooFewPointsError:
                    self._slivers.append(f"{where} ({len(points)} points)")
                    if points is outer:
                        break
            if rings:
                areas.append(Area(tuple(rings)))
        return tuple(areas)

    def notices(self, cure: str = "") -> list[Notice]:
        """Name all that was left out; `cure` is that of what is no outline."""
        found = model.left_aside(+self.aside, cure)
        if self._slivers:
            text = f"outlines of less than 3 points left out: {listed(self._slivers, most=MANY)}."
            found.append(Notice("W119", text, "Draw them again if they are stones."))
        return found

    def file(self, cure: str = "", **more: Any) -> OutlineFile:
        """Return all as a file that says of which image each stone is."""
        more = {"notices": self.notices(cure), "names_images": True, **more}
        return OutlineFile(self.stones, **more)


_PLACES = frozenset({"wall", "facade", "facing", "frame", "sheet", "page", "artboard", "canvas"})
"""What stones are drawn in: layers of these names have stones, too."""
_WORDS_OF_STONES = """
stone rock pebble boulder cobble block brick rubble clast grain gravel ashlar slab chunk debris
piece fragment foreground object instance cell particle
"""
_WORDS_OF_OTHERS = """
scale scalebar ruler rule tape measure marker aruco apriltag tag fiducial qr chessboard checkerboard
charuco calibration target colorchecker colourchecker coin card wall facade facing ground
groundplane background backdrop bg floor table tray box bin pallet tarp sheet page paper artboard
canvas frame border edge boundary outline roi region interest crop shadow shade sky soil earth sand
dirt mud grass vegetation plant leaf leave moss lichen tree root water mortar cement joint gap void
hole crack fissure fracture spot stain hand foot person tool hammer shovel text label legend
dimension ignore unlabeled unlabelled trash artifact artefact noise
"""
_STONES = frozenset(_WORDS_OF_STONES.split())
_OTHERS = frozenset(_WORDS_OF_OTHERS.split())
_WORD = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
_NUMBER = re.compile(r"[ _#.-]*[0-9]+$")
_NONE = "(none)"


def class_of(label: str) -> str:
    """Return the class that a label names, without the number of the stone."""
    return _NUMBER.sub("", label.strip())


def layer(name: str) -> str:
    """Return the class that a layer or group of a drawing is, if it does not say where it lies."""
    return "" if _PLACES.intersection(map(str.lower, _WORD.findall(name))) else class_of(name)


def is_other(name: str) -> bool:
    """Tell by the last word that says either whether a class is something else than stones."""
    for found in reversed(_WORD.findall(name)):
        word = found.lower()
        for form in (word, word.removesuffix("s"), word.removesuffix("es")):
            if form in _STONES or form.endswith(("stone", "rock")):
                return False
            if form in _OTHERS:
                return True
    return False


def of_classes(
    stones: Sequence[OutlinedStone], asked: tuple[str, ...]
) -> tuple[list[OutlinedStone], list[Notice]]:
    """Leave out what is of another class than stones, and list the classes of a file of several.

    Without a word of the user these are the classes whose names say something else, unless no
    stone is left then.  A class that is not there is refused (E118).
    """
    found = Counter(stone.label for stone in stones)
    if asked:
        left = set(found) - _named(asked, found)
    else:
        left = {name for name in found if is_other(name)}
        left = set() if len(left) == len(found) else left
    kept = [stone for stone in stones if stone.label not in left]
    doubtful = not asked and any(map(is_other, found))
    names_of_stones = all(count < 2 for name, count in found.items() if name)
    if not left and not doubtful and (len(found) < 2 or names_of_stones):
        return kept, []
    classes = listed((f"{_shown(name)} ({count})" for name, count in found.items()), most=MANY)
    rest = f"left out: {listed(map(_shown, sorted(left)), most=MANY)}" if left else ""
    text = f"classes in it: {classes}; {rest or 'all classes are read'}."
    return kept, [Notice("W119", text, "Choose with --label NAME ... (label in Python).")]


def _named(asked: tuple[str, ...], found: Counter[str]) -> set[str]:
    """Return the classes that are asked for, by their names in any case."""
    chosen = set()
    for name in asked:
        wanted = "" if name == _NONE else name
        same = {one for one in found if one == wanted} or {
            one for one in found if one.casefold() == wanted.casefold()
        }
        if not same:
            there = listed(map(_shown, found), most=MANY)
            raise unfit(
                f"no outline in it is of the class {short(repr(name))}.",
                f"There are {there}: name others, or leave --label (label in Python) out."
                if any(found)
                else "It has no classes: leave --label (label in Python) out.",
            )
        chosen |= same
    return chosen


def _shown(name: str) -> str:
    return short(name) if name else _NONE
