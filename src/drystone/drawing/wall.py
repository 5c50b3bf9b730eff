"""A wall as a drawing: stones, numbers, colours, wedges, ground and frame, described once."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.drawing import Drawable, Drawing, Legend, Surface, Words, ground
from drystone.drawing.outlines import (
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
    PALE,
    PLAIN_COLOUR,
    WEDGE_COLOUR,
    cluster_colour,
)
from drystone.model.plan import Point, StoneStep
from drystone.model.wall import Wall
from drystone.statics.model import RigidBlockModel

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
    wall: Wall,
    clusters: Mapping[int, int] | None = None,
    outlines: Mapping[int, Loop] | None = None,
    title: str = "",
) -> Drawing:
    """Describe a wall: stones coloured by cluster and numbered in order of placement, wedges red.

    Parameters as for :func:`drystone.drawing.plot_wall`.
    """
    site, units = wall.site, wall.site.units_per_px
    if outlines is None and wall.outlines is not None:
        outlines = wall_outlines(wall)
    loops: dict[int, tuple[Loop, ...]]
    if outlines is None:
        regions = label_regions(wall.labels)
        loops = {one.id: tuple(loop * units for loop in one.loops) for one in regions}
    else:
        loops = {block: (np.asarray(points, float),) for block, points in outlines.items()}
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
    size = site.width_px * units, site.height_px * units
    return wall_drawing(items, size, "m" if site.px_per_m else "px", title, legend)


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
                size_pt=6.5, beside=True, z=6.0,
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
