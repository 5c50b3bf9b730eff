"""What fails when a plan is checked: where blocks were planned, and where they ended."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.canvas import MARGIN_IN, WIDTH_IN, draw
from drystone.drawing.drawing import Area, Drawing, Item, Lines, Words, ground
from drystone.drawing.outlines import Box, Loop, polygon_regions, rectangle, regions_box
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PALE

CONCERNED = "#f0a030"
PLANNED = "#0050a0"
PLANNED_PALE = "#90b0d8"
COMMON = "#c00020"
DASHES, DOTS = (4.0, 2.0), (1.0, 1.65)

NOTICEABLE = 4e-3
"""Blocks that have moved by this share of the wall's height are shown where they were planned."""

LEGEND_IN, TITLE_IN = 0.3, 0.3
HEIGHT_IN = 5.0
"""Largest height of one view."""


@dataclass(frozen=True, eq=False)
class FailureView:
    """A wall and what fails in it; lengths in source px, wall frame.

    `concerned` are the blocks that fail, `ended` where blocks ended that moved, `common` areas that
    two blocks claim, `size` that of the wall that was to be built.
    """

    title: str
    planned: Mapping[int, Loop]
    concerned: Sequence[int] = ()
    ended: Mapping[int, Loop] = field(default_factory=dict)
    common: Sequence[Loop] = ()
    size: tuple[float, float] | None = None

    @property
    def box(self) -> Box:
        """What is to be seen."""
        frame = [np.array([(0.0, 0.0), self.size])] if self.size else []
        loops = [[loop] for loop in (*self.planned.values(), *self.ended.values(), *frame)]
        x0, y0, x1, y1 = regions_box(loops)
        pad = 0.03 * max(y1 - y0, 0.2 * (x1 - x0))
        return x0 - pad, min(y0, 0.0) - 2 * pad, x1 + pad, y1 + pad


def plot_failures(views: Sequence[FailureView]) -> Figure:
    """Draw one or more views under each other."""
    boxes = [view.box for view in views]
    heights = [min(WIDTH_IN * (y1 - y0) / (x1 - x0), HEIGHT_IN) for x0, y0, x1, y1 in boxes]
    gap = TITLE_IN + LEGEND_IN
    width, height = WIDTH_IN + 2 * MARGIN_IN, sum(heights) + gap * len(views)
    figure = Figure(figsize=(width, height))
    bottom = height
    for view, tall in zip(views, heights, strict=True):
        bottom -= gap + tall
        left = (MARGIN_IN / width, (bottom + LEGEND_IN) / height)
        plot_failure(view, figure.add_axes((*left, WIDTH_IN / width, tall / height)))
    return figure


def plot_failure(view: FailureView, ax: Axes | None = None) -> Axes:
    """Draw a wall and what fails in it, in source px.

    Blocks are drawn where they ended; those that fail are coloured and numbered, dashed lines
    show where they, and others that have moved, were planned.
    """
    items: list[Item] = [*ground(view.box)]
    legend: dict[str, Area | Lines] = {}
    if view.concerned:
        legend["fails"] = Area("", (), CONCERNED)
    ended = polygon_regions({**view.planned, **view.ended})
    for region in ended:
        # Blocks that fail lie over those that they have got into, and over their numbers.
        fails = region.id in view.concerned
        fill = CONCERNED if fails else PALE
        area = Area(
            f"block-{region.id}", region.loops, fill, OUTLINE_COLOUR if fails else GREY,
            width_pt=0.8 if fails else 0.5, z=2.0 if fails else 1.0,
        )  # fmt: skip
        number = Words(
            f"number-{region.id}", str(region.id), region.centroid, area.room, fill,
            colour="" if fails else GREY, z=5.0 if fails else 1.5,
        )  # fmt: skip
        items += [area, number]
    moved = _planned(view)
    if moved:
        legend["where it was planned"] = Lines("", [], PLANNED, 1.0, DASHES)
    common = [
        Area(f"common-{number}", (loop,), COMMON, COMMON, width_pt=0.8, z=4.0)
        for number, loop in enumerate(view.common)
    ]
    if common:
        legend["claimed by two"] = common[0]
    items += [*moved, *common]
    if view.size:
        site = rectangle(0.0, 0.0, *view.size)
        items.append(Area("site", (site,), line=GREY, width_pt=1.0, dashes=DOTS))
        legend["wall that was to be built"] = Lines("", [], GREY, 1.5, DOTS)
    return draw(Drawing(tuple(items), view.box, title=view.title, legend=legend), ax)


def _planned(view: FailureView) -> list[Area]:
    """Return where blocks that have moved were planned."""
    _, y0, _, y1 = regions_box([loop] for loop in view.planned.values())
    drawn = []
    for block, loop in view.planned.items():
        way = np.hypot(*(view.ended[block] - loop).T).max() if block in view.ended else 0.0
        if way > NOTICEABLE * (y1 - y0):
            fails = block in view.concerned
            drawn.append(
                Area(f"planned-{block}", (loop,), line=PLANNED if fails else PLANNED_PALE,
                     width_pt=1.0 if fails else 0.5, dashes=DASHES, z=3.0)
            )  # fmt: skip
    return drawn
