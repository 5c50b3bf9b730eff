"""What a picture shows, whoever draws it: areas, lines, dots and words; walls, described once.

A :class:`Drawing` is made once and drawn by a back end: :mod:`~drystone.drawing.canvas`
(Matplotlib), :mod:`~drystone.drawing.export.drawings` (SVG, DXF) or
:mod:`~drystone.drawing.pixels` (Pillow).  x is to the right, y up from the ground.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from drystone.drawing.assembly import Assembly
from drystone.drawing.outlines import (
    Bounds,
    Loop,
    Region,
    label_regions,
    rectangle,
    regions_box,
    stands_on_ground,
    wall_outlines,
)
from drystone.drawing.palette import (
    FIXED_COLOUR,
    GREY,
    OUTLINE_COLOUR,
    PALE,
    PLAIN_COLOUR,
    WEDGE_COLOUR,
    cluster_colour,
)
from drystone.model.plan import Point, StoneStep
from drystone.model.wall import Wall
from drystone.statics.model import RigidBlockModel

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
    room: Point  # width and height of what they are on, which says how large they are
    on: str = "#ffffff"  # colour of what is below
    colour: str = ""  # instead of black or white
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
            wide, high = item.room
            moved.append(replace(item, at=(x, y), room=(wide * factor, high * factor)))
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


FRAME_DASHES = (5.0, 4.0)
MARGIN, GROUND = 0.015, 0.035
"""Room beside and above a wall over its width; depth of the ground over its height or a fifth of
its width."""


def wall_drawing(
    items: Iterable[Drawable], size: Point, unit: str, title: str, legend: Legend
) -> Drawing:
    """Return stones, wedges and numbers on the ground, in the frame of what was ordered."""
    width, height = size
    margin, depth = MARGIN * width, GROUND * max(height, 0.2 * width)
    frame = Surface(
        "frame", (rectangle(0.0, 0.0, width, height),), line=GREY, width_pt=0.9,
        dashes=FRAME_DASHES, z=3.0, layer="SITE",
    )  # fmt: skip
    box = (-margin, -depth, width + margin, height + margin)
    return Drawing((*ground(box), frame, *items), box, unit, title, legend)


def drawing_of_wall(
    wall: Wall, clusters: Mapping[int, int] | None = None, title: str = ""
) -> Drawing:
    """Describe what :func:`drystone.drawing.plot_wall` draws."""
    site, units = wall.site, wall.site.units_per_px
    loops: dict[int, tuple[Loop, ...]]
    if wall.outlines is None:
        regions = label_regions(wall.labels)
        loops = {one.id: tuple(loop * units for loop in one.loops) for one in regions}
    else:
        loops = {block: (loop,) for block, loop in wall_outlines(wall).items()}
    items: list[Drawable] = []
    steps = step_by_id(wall)
    for group in wall.groups:
        stone, (x, y) = group.placement.stone_id, group.placement.centroid(site.height_px)
        fill = PLAIN_COLOUR if clusters is None else cluster_colour(clusters[stone])
        area = Surface(f"stone-{stone}", loops[stone], fill, layer="STONES", step=steps[stone])
        at = x * units, y * units
        items += [area, Words(f"number-{stone}", str(steps[stone]), at, area.room, fill)]
        for wedge in group.wedges:
            items.append(
                Surface(f"wedge-{wedge.id}", loops[wedge.id], WEDGE_COLOUR, z=2.0, layer="WEDGES",
                     step=steps[wedge.id])
            )  # fmt: skip
    legend = {"wedge": Surface("", (), WEDGE_COLOUR)} if wall.wedges else {}
    width, height = (side / (site.px_per_m or 1.0) for side in site.extent_px)
    unit = "m" if site.px_per_m else "px"
    return wall_drawing(items, (width, height), unit, title, legend)


def step_by_id(wall: Wall) -> dict[int, int]:
    """Return the step that places each stone, and each wedge."""
    pieces = (
        piece
        for group in wall.groups
        for piece in (group.placement.stone_id, *(wedge.id for wedge in group.wedges))
    )
    return {piece: step for step, piece in enumerate(pieces, 1)}


def drawing_of_assembly(assembly: Assembly, title: str = "") -> Drawing:
    """Describe a planned wall in one colour, with the step of every stone and wedge."""
    items: list[Drawable] = []
    for part in assembly.parts:
        step, at = part.plan_step, part.centroid
        if isinstance(step, StoneStep):
            note = f"step {part.step}: stone {part.id}, turned {part.angle_deg:.1f}\N{DEGREE SIGN}"
            area = Surface(
                part.name, (part.corners,), PLAIN_COLOUR, layer="STONES", step=part.step,
                pose=(*at, part.angle_deg), note=note,
            )  # fmt: skip
            number = Words(f"number-{part.name}", str(part.step), at, area.room, PLAIN_COLOUR)
        else:
            area = Surface(
                part.name, (part.corners,), WEDGE_COLOUR, z=2.0, layer="WEDGES", step=part.step,
                note=f"step {part.step}: wedge {part.id} under stone {step.under}",
            )  # fmt: skip
            number = Words(
                f"number-{part.name}", str(part.step), at, area.room, colour=WEDGE_COLOUR,
                beside=True, z=6.0,
            )  # fmt: skip
        items += [area, number]
    return wall_drawing(items, assembly.size, assembly.unit, title, {})


def size_of(regions: Iterable[Region]) -> float:
    """Return the height of a wall, or a fifth of its length if that is more."""
    x0, y0, x1, y1 = regions_box(region.loops for region in regions)
    return max(y1 - y0, 0.2 * (x1 - x0))


def pale_wall(
    regions: Sequence[Region], model: RigidBlockModel, reach: Sequence[Loop] = ()
) -> Drawing:
    """Describe a wall to draw contacts and forces on: pale blocks, fixed ones grey.

    The model is of this wall, y = 0 its ground; ValueError when it has a block that the wall does
    not have.  Points of `reach` are in view as well.
    """
    missing = sorted({block.id for block in model.blocks} - {region.id for region in regions})
    if missing:
        raise ValueError(f"the model has blocks that the wall lacks: {missing}")
    size = size_of(regions)
    pad, depth = 0.04 * size, 0.06 * size
    x0, y0, x1, y1 = regions_box((region.loops for region in regions), [reach])
    grounded = stands_on_ground(regions)
    bottom = min(y0 - 0.01 * size, -depth if grounded else y0 - pad)
    fixed = {block.id for block in model.blocks if block.fixed}
    blocks = tuple(
        Surface(f"block-{region.id}", region.loops, FIXED_COLOUR if region.id in fixed else PALE,
             line=GREY, width_pt=0.4)
        for region in regions
    )  # fmt: skip
    box = (x0 - pad, bottom, x1 + pad, y1 + pad)
    return Drawing((*(ground((box[0], -depth, box[2], 0.0)) if grounded else ()), *blocks), box)
