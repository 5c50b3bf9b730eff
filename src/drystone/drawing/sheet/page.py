"""A page of paper that is drawn on in millimetres."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from numpy.typing import ArrayLike

from drystone.drawing.canvas import add
from drystone.drawing.drawing import Drawable, Lines, Surface
from drystone.drawing.lettering import drawable, fitted
from drystone.drawing.outlines import rectangle
from drystone.drawing.palette import GREY, OUTLINE_COLOUR

MM_PER_INCH = 25.4
PT_PER_MM = 72.0 / MM_PER_INCH

A4_MM = (210.0, 297.0)
EDGE_MM = 12.0  # of paper that printers do not print on, and a hole punch
PAGE_NUMBER_MM = 30.0  # room for it at the right end of the foot
SMALL_PT, PLAIN_PT = 7.0, 8.5
NOT_TO_SCALE = "NOT TO SCALE"
FAINT = "#555555"  # of words that explain


class SheetPage:
    """One sheet of paper; lengths are mm from its lower left corner.

    `right` and `top` are the ends of what is printed.
    """

    def __init__(self, size_mm: tuple[float, float] = A4_MM) -> None:
        self.width, self.height = size_mm
        self.right, self.top = self.width - EDGE_MM, self.height - EDGE_MM
        self.figure = Figure(figsize=(self.width / MM_PER_INCH, self.height / MM_PER_INCH))
        self.ax = self.figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.ax.set_axis_off()
        self.ax.set_xlim(0.0, self.width)
        self.ax.set_ylim(0.0, self.height)
        self.ax.set_autoscale_on(False)

    def write(self, x: float, y: float, text: str, size: float = PLAIN_PT, **style: Any) -> None:
        """Write a line of text, its left end on the base line unless `ha` and `va` differ.

        With `room`, in mm, what is wider is cut.
        """
        text, room = drawable(text), style.pop("room", None)
        if room is not None:
            text = fitted(text, size, room * PT_PER_MM, bold=style.get("weight") == "bold")
        chosen = {"ha": "left", "va": "baseline", "color": OUTLINE_COLOUR, **style}
        # What users call things is text, also with dollar signs in it.
        self.ax.text(x, y, text, size=size, parse_math=False, **chosen)

    def draw(self, *items: Drawable) -> None:
        """Draw what has its lengths in mm from the page's corner."""
        add(self.ax, items)

    def line(self, points: ArrayLike, **style: Any) -> None:
        """Draw a line through points, (n, 2)."""
        chosen = {"name": "", "width_pt": 0.5, "z": 2.0, "layer": "SITE", **style}
        self.draw(Lines(lines=[np.asarray(points, float)], **chosen))

    def box(self, x: float, y: float, width: float, height: float, **style: Any) -> None:
        """Draw a rectangle from its lower left corner."""
        self.draw(Surface(style.pop("name", ""), (rectangle(x, y, width, height),), **style))

    def arrow(self, start: Sequence[float], end: Sequence[float], **style: Any) -> None:
        """Draw a line with a head at its end, or of another `arrowstyle`."""
        chosen = {
            "arrowstyle": "-|>,head_width=1.3,head_length=2.6", "color": OUTLINE_COLOUR,
            "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 1.0, **style,
        }  # fmt: skip
        self.ax.add_patch(FancyArrowPatch((start[0], start[1]), (end[0], end[1]), **chosen))

    def turn_arrow(
        self, centre: Sequence[float], radius: float, angle_deg: float, colour: str
    ) -> None:
        """Draw an arc from straight up by an angle, counter-clockwise, with a head at its end."""
        turned = np.radians(np.linspace(90.0, 90.0 + angle_deg, 60))
        arc = np.asarray(centre, float) + radius * np.column_stack([np.cos(turned), np.sin(turned)])
        out, tip = (arc[-1] - centre) / radius, arc[-1]
        along = np.sign(angle_deg) * np.array([-out[1], out[0]])
        # As long as an arc has room for.
        size = min(1.8, 0.6 * radius * abs(np.radians(angle_deg)))
        head = [tip + 0.5 * size * along, tip - 0.5 * size * along + 0.4 * size * out,
                tip - 0.5 * size * along - 0.4 * size * out]  # fmt: skip
        self.line(arc, colour=colour, width_pt=1.1, z=6.0)
        self.draw(Surface("", (np.array(head),), colour, "none", z=6.0))

    def dimension(
        self, start: Sequence[float], end: Sequence[float], text: str, *, upright: bool = False
    ) -> None:
        """Draw a dimension line between two points with its length in words on it."""
        style = "<|-|>,head_width=1.1,head_length=2.4"
        self.arrow(start, end, arrowstyle=style, linewidth=0.45)
        for x, y in (start, end):
            ends = [(x - 1.5, y), (x + 1.5, y)] if upright else [(x, y - 1.5), (x, y + 1.5)]
            self.line(ends, width_pt=0.45)
        x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
        self.write(
            x, y, text, SMALL_PT, ha="center", va="center", rotation=90 if upright else 0,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.2}, zorder=5,
        )  # fmt: skip

    def tick_box(self, x: float, y: float, size: float = 4.5) -> None:
        """Draw an empty box for a tick."""
        self.box(x, y, size, size, width_pt=0.7)

    def foot(self, left: str, right: str) -> None:
        """Write what the page belongs to, and its number."""
        self.line([(EDGE_MM, EDGE_MM - 1.5), (self.right, EDGE_MM - 1.5)], colour=GREY)
        room = self.right - EDGE_MM - PAGE_NUMBER_MM
        self.write(EDGE_MM, EDGE_MM - 5.0, left, SMALL_PT, color=FAINT, room=room)
        self.write(self.right, EDGE_MM - 5.0, right, SMALL_PT, ha="right", color=FAINT)
