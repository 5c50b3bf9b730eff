"""Stones as a file describes them, outlines or masks, and the pixels whose centres they hold."""

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Literal
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from drystone.errors import Notice
from drystone.io.files import damaged, foreign, listed, short, too_large
from drystone.io.labels import MAX_ID
from drystone.io.patches import PlacedMask, free_numbers
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

METRES = MappingProxyType({"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048})
"""Metres in each unit that a user may name."""

MOST_PX = 10**9
"""No coordinate is further away."""
_CORNERS_OF_ELLIPSE = 256
_MOST_ELEMENTS = 1_000_000

DEEPEST = 64
"""How often what is drawn may be in another group, block or use."""
MOST_DRAWN = 100_000
MOST_CORNERS = 10_000_000
TOO_MANY_CORNERS = f"the drawing has more than {MOST_CORNERS} corners, those on curves."
FEWER = "Export the outlines of stones only, with fewer corners."

_STONE_NAME = re.compile(r"(?:stones?[ _-]*)?0*([1-9][0-9]*)", re.IGNORECASE)
_WEDGE_NAME = re.compile(r"wedge[ _-]*[0-9]+", re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Area:
    """What rings enclose together."""

    rings: tuple[Points, ...]
    """(n, 2) each, not closed, in any sense of rotation, in the unit of the file."""
    rule: Literal["evenodd", "nonzero"] = "evenodd"
    """What is inside: by the number of rings around it, or by the sum of their turns."""


@dataclass(frozen=True, eq=False)
class OutlinedStone:
    """A stone of a file: the union of areas and masks."""

    id: int | None  # the file's own number, be it one that no stone can have
    name: str = ""  # the file's own name
    areas: tuple[Area, ...] = ()
    masks: tuple[PlacedMask, ...] = ()  # only in files in px
    label: str = ""  # the class that the file gives it

    @property
    def rings(self) -> list[Points]:
        """All rings of its areas."""
        return [one for area in self.areas for one in area.rings]

    def moved(self, move: Callable[[Points], Points]) -> "OutlinedStone":
        """Return it with other corners."""
        areas = (Area(tuple(map(move, area.rings)), area.rule) for area in self.areas)
        return replace(self, areas=tuple(areas))


@dataclass(frozen=True, eq=False)
class OutlineFile:
    """What a file of outlines holds."""

    stones: Sequence[OutlinedStone]  # in the order of the file
    unit_m: float | None = None  # metres in its unit; None when that is the px of an image
    y_up: bool = False  # False when y runs down, as in images
    size_px: tuple[int, int] | None = None  # width, height of the image of a file in px, if said
    px_per_m: float | None = None  # px of that image in a metre, if said
    ground: Points | None = None  # (2, 2), two points of the ground that a wall stands on, if said
    photograph: tuple[tuple[str, Any], ...] = ()  # see `Source`
    notices: Sequence[Notice] = ()
    in_space: bool = False  # its coordinates have three axes, so it can be asked which is up
    names_images: bool = False  # it says of which image each stone is, so one can be asked for
    seen_by: Literal["people", "program", "either", "none"] = "people"
    """Who drew them: a program masks whatever it sees.  Masks and bodies may be "either" those of
    one picture or each of its own; with "none" they are.
    """


def number_in(text: object) -> int | None:
    """Return the number that a label is, or that follows the word stone in it.

    Numbers are returned as they are, also those that no stone can have; labels only when one can.
    """
    if isinstance(text, float) and text.is_integer():  # as tables with gaps write them
        return int(text)
    if isinstance(text, bool) or not isinstance(text, int | str):
        return None
    if isinstance(text, int):
        return text
    found = _STONE_NAME.fullmatch(text.strip())
    number = int(found[1]) if found and len(found[1]) < 11 else 0
    return number if 0 < number <= MAX_ID else None


def numbered(
    stones: Sequence[OutlinedStone], left: Collection[int] = ()
) -> tuple[Sequence[OutlinedStone], list[Notice]]:
    """Give every stone an id: the file's own when all differ, else 1, 2, 3 and so on.

    A file with any number of its own is not numbered anew without a notice (W119).  What is `left`
    out, by its place from 1, is no stone: where stones keep their numbers it has later ones.
    """
    counted = [stone for place, stone in enumerate(stones, start=1) if place not in left]
    own = [stone.id for stone in counted if stone.id is not None]
    several = sorted(number for number, count in Counter(own).items() if count > 1)
    beyond = sorted({number for number in own if not 0 < number <= MAX_ID})
    if len(own) == len(counted) and not several and not beyond:
        free = free_numbers(set(own))
        places = enumerate(stones, start=1)
        return [replace(one, id=next(free)) if i in left else one for i, one in places], []
    result = [replace(stone, id=i) for i, stone in enumerate(stones, start=1)]
    if not own:
        return result, []
    why = []
    if several:
        why.append(f"the numbers of the file are not different ({listed(several)})")
    if beyond:
        why.append(f"{listed(beyond)} cannot be the number of a stone")
    if missing := len(counted) - len(own):
        why.append(f"{missing} of {len(counted)} stones without a number")
    pairs = ((stone.id, i) for i, stone in enumerate(stones, start=1) if i not in left)
    moved = listed(f"{own} is now {i}" for own, i in pairs if own not in (None, i))
    shown = f" ({moved})" if moved and not several else ""
    text = f"{', '.join(why)}: all are numbered in order{shown}."
    cure = "Give every stone a number of its own, from 1, to keep them."
    return result, [Notice("W119", text, cure)]


def without_wedges(stones: Sequence[OutlinedStone]) -> tuple[list[OutlinedStone], list[Notice]]:
    """Leave out wedges of a planned wall, which nobody found."""
    kept = [stone for stone in stones if not _WEDGE_NAME.fullmatch(stone.name)]
    left = len(stones) - len(kept)
    return kept, [Notice("W119", f"{left} wedges of a planned wall were left out.")] if left else []


class TooFewPointsError(ValueError):
    """A ring of one or two points, which encloses nothing."""


def left_aside(kinds: Counter[str], cure: str = "") -> list[Notice]:
    """Say what in a file is no outline of a stone."""
    if not kinds:
        return []
    found = listed(f"{count} {short(kind)}" for kind, count in sorted(kinds.items()))
    return [Notice("W119", f"no outlines of stones, left aside: {found}.", cure)]


def ellipse(centre: tuple[float, float], radii: tuple[float, float], turned: float = 0.0) -> Points:
    """Return the corners, (n, 2), of an ellipse that is turned by an angle (radians)."""
    angles = np.arange(_CORNERS_OF_ELLIPSE) * (2.0 * math.pi / _CORNERS_OF_ELLIPSE)
    x, y = radii[0] * np.cos(angles), radii[1] * np.sin(angles)
    turn = np.exp(1j * turned) * (x + 1j * y)
    return np.asarray(np.column_stack([turn.real, turn.imag]) + np.array(centre))


def rectangle(low: Any, high: Any) -> Points:
    """Return the corners, (4, 2), of a rectangle."""
    (x0, y0), (x1, y1) = low, high
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], float)


def overruled(own_m: float | None, own: str, settings: ReadSettings) -> list[Notice]:
    """Say whether the unit of the settings takes the place of another one of the file."""
    unit_m = METRES.get(settings.unit)
    same = unit_m is not None and own_m is not None and abs(unit_m / own_m - 1.0) < 1e-9
    if not settings.unit or own_m is None or same:
        return []
    text = f"the file gives another unit ({own}), but --unit {settings.unit} was said."
    return [Notice("W119", text, "Leave --unit out to take that of the file.")]


def xml_root(data: bytes, what: str, cure: str) -> ET.Element:
    """Parse XML; E106 when it is damaged, E110 when it has too many elements."""
    if data.count(b"<") > 2 * _MOST_ELEMENTS:
        raise too_large(f"the {what} has more than {_MOST_ELEMENTS} elements.", cure)
    with foreign(lambda why: damaged(why, what=what)):
        return ET.fromstring(data)  # noqa: S314 - expat bounds what entities expand to


def side_px(value: Any) -> int:
    """Return a side of an image; ValueError when it is none."""
    number = int(value)
    if not 0 < number <= MOST_PX:
        shown = number if number <= 0 else "more than 1e9"
        raise ValueError(f"a side of it is {shown} px")
    return number


def size_px(width: Any, height: Any) -> tuple[int, int] | None:
    """Return the size of an image, if both sides are given; ValueError when one is none."""
    return None if None in (width, height) else (side_px(width), side_px(height))


def place_px(value: Any) -> int:
    """Return a row or column of a mask; ValueError when no picture reaches there."""
    number = float(value)
    if not abs(number) <= MOST_PX:
        raise ValueError("a coordinate is beyond 1e9")
    return round(number)


def within_reach(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points; ValueError when some are not finite or further away than anything is."""
    if not np.isfinite(points).all():
        raise ValueError("a coordinate is not finite")
    if points.size and np.abs(points).max() > MOST_PX:
        raise ValueError("a coordinate is beyond 1e9")
    return points


def ring(points: Any) -> Points:
    """Return a ring from numbers; ValueError when it is none."""
    corners = np.asarray(points, dtype=float)
    if corners.ndim != 2 or corners.shape[1] < 2:
        raise ValueError("points are pairs of numbers")
    corners = within_reach(corners[:, :2])
    if len(corners) > 1 and (corners[0] == corners[-1]).all():
        corners = corners[:-1]
    if len(corners) < 3:
        raise TooFewPointsError(f"an outline needs 3 points, not {len(corners)}")
    return corners


_AT_ONCE_PX = 2**22
"""Pixels that are filled at once."""

_FREE_ROWS = 10_000
"""Rows that any outline may cross; more than its pixels of a larger one are no outline."""

_MOST_STONES = 10_000


def box_of(area: Area) -> tuple[int, int, int, int]:
    """Return the first row and column that an area can fill, and those after the last."""
    points = np.concatenate(area.rings)
    left, top = np.floor(points.min(axis=0)).astype(int).tolist()
    right, bottom = np.ceil(points.max(axis=0)).astype(int).tolist()
    return top, left, bottom, right


class Room:
    """Pixels that the stones of a file may fill, boxes around them included, asked for before.

    All stones together may have twice as many as a picture.
    """

    def __init__(self, max_px: int) -> None:
        self.max_px = max_px
        self.left = 2 * max_px

    def take(self, px: int) -> None:
        """Take some for one more mask; E110 when there is no room."""
        self.left -= px
        if self.left < 0:
            raise too_large(
                f"its stones fill more than {2 * self.max_px / 1e6:g} million px together.",
                "Reduce or crop its image, or give it a smaller resolution; only in Python can "
                "the limit be raised (max_image_mpx).",
            )


def check_reach(stones: Iterable[OutlinedStone], max_px: int) -> None:
    """Refuse outlines, in px, that would fill the memory (E110), naming the stone."""
    room = Room(max_px)
    for number, stone in enumerate(stones, start=1):
        if number > _MOST_STONES:
            what = f"there are more than {_MOST_STONES} stones in it."
            raise too_large(what, "Export those of one wall.")
        boxes = [box_of(area) for area in stone.areas] + [placed.sides for placed in stone.masks]
        if not boxes:
            continue
        height, width = (np.max(boxes, axis=0)[2:] - np.min(boxes, axis=0)[:2]).tolist()
        # A mask of pixels may be that of the ground; an outline is drawn.
        most = max_px if stone.masks else max_px // 4
        name = short(stone.name or stone.id)
        if width * height > most:
            raise too_large(
                f"stone {name} reaches over {width} x {height} px; the limit is {most / 1e6:g} "
                "million.",
                "Is a corner of it far away from the picture? Correct it; only in Python can the "
                "limit be raised (max_image_mpx).",
            )
        room.take(width * height)
        heights = (np.ceil(ring[:, 1] - 0.5) for ring in stone.rings)
        crossed = sum(int(np.abs(np.diff(rows, append=rows[:1])).sum()) for rows in heights)
        if crossed > width * height + _FREE_ROWS:
            raise too_large(
                f"the outline of stone {name} goes up and down over {crossed} rows of pixels, and "
                f"it has {width} x {height} px.",
                "Draw it with fewer corners.",
            )


def filled_area(area: Area) -> PlacedMask | None:
    """Return the pixels whose centres lie in an area in px, y down; None when there are none.

    Pixel (row, col) is the unit square from (x, y) = (col, row).  A centre on a left or upper edge
    is inside, on a right or lower edge outside, so areas that meet share no pixel.
    """
    top, left, bottom, right = box_of(area)
    height, width = bottom - top, right - left
    if height < 1 or width < 1:
        return None
    mask = np.zeros((height, width), bool)
    rows_at_once = max(1, _AT_ONCE_PX // width)
    for begin in range(0, height, rows_at_once):
        band = mask[begin : begin + rows_at_once]
        turns = np.zeros((len(band), width + 1), np.int32)
        for ring in area.rings:
            _add_crossings(turns, ring, top + begin, left)
        winding = np.cumsum(turns, axis=1, dtype=np.int32, out=turns)[:, :-1]
        band[:] = winding % 2 == 1 if area.rule == "evenodd" else winding != 0
    return trimmed(PlacedMask(mask, top, left))


def trimmed(placed: PlacedMask) -> PlacedMask | None:
    """Cut a mask to its bounding box; None when it has no pixel."""
    rows, cols = (np.flatnonzero(placed.mask.any(axis=axis)) for axis in (1, 0))
    if not len(rows):
        return None
    inside = placed.mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    row, col = placed.row + int(rows[0]), placed.col + int(cols[0])
    return PlacedMask(np.ascontiguousarray(inside), row, col)


def room_around(masks: Sequence[PlacedMask], kind: type[np.generic] = np.bool_) -> PlacedMask:
    """Return zeros on the box around masks, of which there is one at least."""
    sides = np.array([mask.sides for mask in masks])
    (top, left), (bottom, right) = sides[:, :2].min(axis=0), sides[:, 2:].max(axis=0)
    return PlacedMask(np.zeros((bottom - top, right - left), kind), int(top), int(left))


def covered(place: PlacedMask, masks: Iterable[PlacedMask]) -> PlacedMask:
    """Return which pixels within the box of one mask others have."""
    whole = PlacedMask(np.zeros(place.mask.shape, bool), place.row, place.col)
    for one in masks:
        within, mask = whole.shared(one)
        within |= mask
    return whole


def pixels_of(stone: OutlinedStone) -> PlacedMask | None:
    """Return the pixels of a stone whose outlines are in px, y down; None when it has none."""
    filled = (filled_area(area) for area in stone.areas)
    masks = [*(mask for mask in filled if mask is not None), *stone.masks]
    if len(masks) < 2:
        return masks[0] if masks else None
    return covered(room_around(masks), masks)


def _add_crossings(turns: NDArray[np.int32], ring: Points, top: int, left: int) -> None:
    """Add, row by row, where edges cross the line of pixel centres, and in which sense."""
    height, width = turns.shape[0], turns.shape[1] - 1
    ends = np.roll(ring, -1, axis=0)
    sense = np.where(ends[:, 1] > ring[:, 1], 1, -1)
    # From the upper end whichever way it runs, and not from the box: an edge that two areas have
    # in common is crossed at the same number in both.
    down = (sense > 0)[:, None]
    (x0, y0), (x1, y1) = np.where(down, ring, ends).T, np.where(down, ends, ring).T
    first, last = (np.clip(np.ceil(y - 0.5), top, top + height).astype(int) for y in (y0, y1))
    number = last - first
    edge = np.repeat(np.arange(len(ring)), number)
    row = first[edge] + np.arange(len(edge)) - (np.cumsum(number) - number)[edge]
    x = x0[edge] + (row + 0.5 - y0[edge]) / (y1 - y0)[edge] * (x1 - x0)[edge]
    col = np.clip(np.ceil(x - 0.5) - left, 0, width).astype(int)
    place = (row - top) * (width + 1) + col
    turns += np.bincount(place, sense[edge], turns.size).reshape(turns.shape).astype(np.int32)
