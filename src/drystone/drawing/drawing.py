"""What a picture shows, whoever draws it: areas, lines, dots and words in the unit of a wall.

A :class:`Drawing` is made once and drawn by a back end: :mod:`~drystone.drawing.canvas`
(Matplotlib), :mod:`~drystone.drawing.svg`, :mod:`~drystone.drawing.dxf` or
:mod:`~drystone.drawing.pixels` (Pillow).  x is to the right, y up from the ground.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from drystone.drawing.outlines import Box, Loop, rectangle
from drystone.drawing.palette import GREY, OUTLINE_COLOUR

Point = tuple[float, float]
Dashes = tuple[float, ...]
"""Lengths of strokes and gaps by turns, in widths of the line; empty for a line without gaps."""


class Pose(NamedTuple):
    """Where a thing is: a point of it, and how far it is turned about this point."""

    x: float
    y: float
    angle_deg: float


@dataclass(frozen=True, eq=False)
class Area:
    """A stone, a wedge, a frame.

    Parameters
    ----------
    name : str
        Unique in its layer; files keep it.
    loops : tuple of (n, 2) float arrays
        Clockwise ones are holes.
    fill, line : str
        Colours "#rrggbb", or "none".
    width_pt : float
        Of the line.
    dashes : tuple of float
        Of the line.
    hatch : str
        Strokes over the area, as Matplotlib writes them; files for other programs leave hatched
        areas out.
    z : float
        What is higher lies over what is lower.
    layer : str
        Of files that have layers.
    pose : Pose or None
        Of a stone; drawings that define a stone as it lay put it there.
    step : int or None
        Of the plan.
    note : str
        What there is to say of it.
    """

    name: str
    loops: tuple[Loop, ...]
    fill: str = "none"
    line: str = OUTLINE_COLOUR
    width_pt: float = 0.6
    dashes: Dashes = ()
    hatch: str = ""
    z: float = 1.0
    layer: str = ""
    pose: Pose | None = None
    step: int | None = None
    note: str = ""

    @property
    def room(self) -> Point:
        """Width and height of its box."""
        width, height = np.ptp(np.concatenate(self.loops), axis=0).tolist()
        return width, height

    @property
    def middle(self) -> Point:
        """Of its corners."""
        x, y = np.concatenate(self.loops).mean(axis=0).tolist()
        return x, y


@dataclass(frozen=True, eq=False)
class Lines:
    """Lines of one kind; parameters as for :class:`Area`.

    Parameters
    ----------
    lines : sequence of (n, 2) float arrays
        Their points.
    width_pt : float or sequence of float
        One of each, or of all.
    head : bool
        Whether they end in the head of an arrow.
    halo : bool
        Whether there is a white line below, to be seen on anything.
    notes : sequence of str
        What there is to say of each.
    """

    name: str
    lines: Sequence[Loop]
    colour: str = OUTLINE_COLOUR
    width_pt: float | Sequence[float] = 0.6
    dashes: Dashes = ()
    head: bool = False
    halo: bool = False
    z: float = 3.0
    layer: str = ""
    notes: Sequence[str] = ()


@dataclass(frozen=True, eq=False)
class Dots:
    """Points with a marker; parameters as for :class:`Area`."""

    name: str
    points: Loop
    colour: str = OUTLINE_COLOUR
    size_pt: float = 3.0
    marker: str = "o"
    open: bool = False
    z: float = 4.0
    layer: str = ""


@dataclass(frozen=True, eq=False)
class Words:
    """A number or a few words; parameters as for :class:`Area`.

    Parameters
    ----------
    at : (float, float)
        The middle.
    room : (float, float) or None
        Width and height of what they are written on, which says how large they are.
    on : str
        Colour of what is below; the words are black or white, and have a halo of it.
    colour : str
        Instead of black or white.
    size_pt : float
        Where no room says it.
    beside : bool
        The thing is too small to hold them: they are written where there is room, with a line.
    """

    name: str
    text: str
    at: Point
    room: Point | None = None
    on: str = "#ffffff"
    colour: str = ""
    size_pt: float = 8.0
    beside: bool = False
    z: float = 5.0
    layer: str = "NUMBERS"


Item = Area | Lines | Dots | Words


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture of a wall.

    Parameters
    ----------
    items : tuple of Area, Lines, Dots or Words
        What is drawn, later ones over earlier ones of the same `z`.
    box : (x0, y0, x1, y1)
        What is in view.
    unit : str
        Of lengths, where a scale is drawn; "" for a picture without one.
    title : str
        Above it.
    legend : mapping of str to Area, Lines or Dots
        What colours and lines mean.
    hidden : tuple of str
        Layers that are not shown at first.
    notes : mapping of str to str
        What there is to say of a layer.
    """

    items: tuple[Item, ...]
    box: Box
    unit: str = ""
    title: str = ""
    legend: Mapping[str, Area | Lines | Dots] = field(default_factory=dict)
    hidden: tuple[str, ...] = ()
    notes: Mapping[str, str] = field(default_factory=dict)

    def layers(self, *names: str) -> tuple[Item, ...]:
        """Return what is on some layers."""
        return tuple(item for item in self.items if item.layer in names)

    def with_items(self, items: Iterable[Item]) -> "Drawing":
        """Return it with more drawn over it."""
        return replace(self, items=(*self.items, *items))


def placed(items: Iterable[Item], factor: float, origin: Point = (0.0, 0.0)) -> list[Item]:
    """Return items in another unit of length, the wall's lower left corner moved to `origin`.

    `factor` is new units in an old one.
    """

    def there(points: Loop | Point) -> Loop:
        return np.asarray(np.asarray(points, float) * factor + np.asarray(origin))

    moved: list[Item] = []
    for item in items:
        if isinstance(item, Area):
            pose = item.pose
            if pose is not None:
                x, y = there(pose[:2]).tolist()
                pose = Pose(x, y, pose.angle_deg)
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


def ground(box: Box) -> tuple[Area, Lines]:
    """Return the ground below a picture: a line at y = 0 and hatching down to its lower edge."""
    x0, y0, x1, _ = box
    earth = rectangle(x0, y0, x1 - x0, -y0)
    return (
        Area("ground", (earth,), line=GREY, width_pt=0.0, hatch="/////", z=0.0, layer="SITE"),
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
