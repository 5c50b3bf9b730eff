"""What a picture shows, whoever draws it: areas, lines, dots and words in the unit of a wall.

A :class:`Drawing` is made once and drawn by a back end: :mod:`~drystone.drawing.canvas`
(Matplotlib), :mod:`~drystone.drawing.vector` (SVG, DXF) or :mod:`~drystone.drawing.pixels`
(Pillow).  x is to the right, y up from the ground.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from drystone.drawing.outlines import Bounds, Loop, rectangle
from drystone.drawing.palette import GREY, OUTLINE_COLOUR
from drystone.model.plan import Point

Dashes = tuple[float, ...]
"""Lengths of strokes and gaps by turns, in widths of the line; empty for a line without gaps."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A stone, a wedge, a frame.  Colours are "#rrggbb" or "none", widths of lines pt."""

    name: str  # unique in its layer; files keep it
    loops: tuple[Loop, ...]  # clockwise ones are holes
    fill: str = "none"
    line: str = OUTLINE_COLOUR
    width_pt: float = 0.6
    dashes: Dashes = ()
    hatch: str = ""  # as Matplotlib writes it; files for other programs leave hatched areas out
    z: float = 1.0  # what is higher lies over what is lower
    layer: str = ""  # of files that have layers
    pose: tuple[float, float, float] | None = None
    """x, y and degrees of a stone: a drawing that defines it as it lay turns it about (x, y)."""
    step: int | None = None  # of the plan
    note: str = ""

    @property
    def room(self) -> Point:
        """Width and height of its box."""
        width, height = np.ptp(np.concatenate(self.loops), axis=0).tolist()
        return width, height


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of one kind, each (n, 2)."""

    name: str
    lines: Sequence[Loop]
    colour: str = OUTLINE_COLOUR
    width_pt: float | Sequence[float] = 0.6  # of each, or of all
    dashes: Dashes = ()
    head: bool = False  # of an arrow, at the end
    halo: bool = False  # a white line below, to be seen on anything
    z: float = 3.0
    layer: str = ""
    notes: Sequence[str] = ()  # of each


@dataclass(frozen=True, eq=False)
class Dots:
    """Points, as discs or open rings."""

    name: str
    points: Loop
    colour: str = OUTLINE_COLOUR
    size_pt: float = 3.0
    open: bool = False
    z: float = 4.0
    layer: str = ""


@dataclass(frozen=True, eq=False)
class Words:
    """A number or a few words, black or white with a halo of the colour below."""

    name: str
    text: str
    at: Point  # the middle
    room: Point | None = None  # width and height of what they are on, which says how large they are
    on: str = "#ffffff"  # colour of what is below
    colour: str = ""  # instead of black or white
    size_pt: float = 8.0  # where no room says it
    beside: bool = False  # too small to hold them: they are where there is room, with a line
    z: float = 5.0
    layer: str = "NUMBERS"


Drawable = Surface | Lines | Dots | Words
Legend = Mapping[str, Surface | Lines | Dots]  # what colours and lines mean


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture of a wall: later items over earlier ones of the same `z`."""

    items: tuple[Drawable, ...]
    box: Bounds  # what is in view
    unit: str = ""  # of lengths, where a scale is drawn
    title: str = ""
    legend: Legend = field(default_factory=dict)
    hidden: tuple[str, ...] = ()  # layers that are not shown at first
    notes: Mapping[str, str] = field(default_factory=dict)  # what there is to say of a layer

    def layers(self, *names: str) -> tuple[Drawable, ...]:
        """Return what is on some layers."""
        return tuple(item for item in self.items if item.layer in names)


def placed(items: Iterable[Drawable], factor: float, origin: Point = (0.0, 0.0)) -> list[Drawable]:
    """Return items in another unit of length, the wall's lower left corner moved to `origin`.

    `factor` is new units in an old one.
    """

    def there(points: Loop | Point) -> Loop:
        return np.asarray(np.asarray(points, float) * factor + np.asarray(origin))

    moved: list[Drawable] = []
    for item in items:
        if isinstance(item, Surface):
            pose = item.pose and (*there(item.pose[:2]).tolist(), item.pose[2])
            moved.append(replace(item, loops=tuple(map(there, item.loops)), pose=pose))
        elif isinstance(item, Lines):
            moved.append(replace(item, lines=[there(line) for line in item.lines]))
        elif isinstance(item, Dots):
            moved.append(replace(item, points=there(item.points)))
        else:
            x, y = there(item.at).tolist()
            room = item.room and (item.room[0] * factor, item.room[1] * factor)
            moved.append(replace(item, at=(x, y), room=room))
    return moved


def ground(box: Bounds) -> tuple[Surface, Lines]:
    """Return the ground below a picture: a line at y = 0 and hatching down to its lower edge."""
    x0, y0, x1, _ = box
    earth = rectangle(x0, y0, x1 - x0, -y0)
    return (
        Surface("ground", (earth,), line=GREY, width_pt=0.0, hatch="/////", z=0.0, layer="SITE"),
        Lines("ground-line", [np.array([(x0, 0.0), (x1, 0.0)])], width_pt=1.2, z=4.0,
              layer="SITE"),
    )  # fmt: skip


def letters_pt(text: str, width_pt: float, height_pt: float, share: float = 0.6) -> float:
    """Return how large letters may be to take a share of a box.

    A digit is about .62 of its size wide.

    >>> letters_pt("7", 100.0, 10.0), round(letters_pt("777", 18.6, 100.0), 6)
    (6.0, 6.0)
    """
    return share * min(height_pt, width_pt / (0.62 * len(text)))


def arrow_head(line: Loop, length: float) -> Loop:
    """Return the corners of the head at the end of a line: neck, one side, tip, other side."""
    tail, tip = line[0], line[-1]
    along = (tip - tail) / np.hypot(*(tip - tail))
    size = min(length, 0.5 * float(np.hypot(*(tip - tail))))
    neck, side = tip - size * along, 0.33 * size * np.array([-along[1], along[0]])
    return np.array([neck, neck + side, tip, neck - side])
