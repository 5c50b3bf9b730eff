"""build-sheet.pdf: what a mason needs on the scaffold, on A4.

The first page has the wall to scale and the title block; then come a line a stone, in order, where
the stones lie, wedges to cut, and what is left over.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from numpy.typing import ArrayLike

from drystone.drawing.assembly import Assembly, Part
from drystone.drawing.canvas import add
from drystone.drawing.drawing import (
    FRAME_DASHES,
    Drawable,
    Lines,
    Surface,
    drawing_of_assembly,
    letters_pt,
    placed,
)
from drystone.drawing.export.formats import ExportSettings
from drystone.drawing.lettering import drawable, fitted
from drystone.drawing.outlines import rectangle
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.drawing.photo import StonePhoto
from drystone.drawing.sheet import words
from drystone.drawing.words.content import source_name
from drystone.io.plan_json import plan_digest
from drystone.model.plan import Point, StoneStep

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


USUAL_SCALES = (1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0, 250.0, 500.0, 1000.0)

DRAWING_MM = (297.0 - 2 * EDGE_MM - 18.0, 110.0)
"""Room for the wall itself on the first page; beside it are dimension lines, above it words."""

SCALE_MM = 60.0  # room for the scale at the right end of the head
BLOCK_MM = 33.0  # height of the title block

ROW_MM = 27.0, 34.0
"""Height of a line: the least, and the most where a page has few."""
HEAD_MM = 19.0
NUMBER, PICTURE, TURN, WHERE, BESIDE = 12.0, 31.0, 63.0, 117.0, 154.0
"""Where the columns begin, mm from the left edge of the page."""

PICTURE_MM = (30.0, 23.0)
STONE_MM = 22.0  # the largest stone of the wall, turned any way, is drawn this large
WORDS = 26  # letters in a line of the last column
SEEN_DEG = 15.0  # smaller turns have no arrow: it would be a dot
TURN_COLOUR = "#0072b2"
CROP_SPARE = 0.14  # of the size of a stone, around it in its picture

MAP_MM = (186.0, 96.0)
LINE_MM = 5.6
COLUMNS = 2
GAP_MM = 8.0

CARD_MM = (62.0, 45.0)  # room for a wedge to cut; its drawing is at most as large as `SHAPE_MM`
SHAPE_MM = (44.0, 25.0)
CARDS_ACROSS, WEDGE_HEAD_MM = 3, 13.0
LEFT_OVER_LINES = 3
USUAL_FACTORS = (10.0, 5.0, 2.0, 1.0, 1 / 2, 1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100)
SMALLEST_MM = 8.0  # wedges smaller than this are drawn larger than they are


@dataclass(frozen=True)
class Scale:
    """How large the wall is on paper: 1 to the denominator, None when nobody knows its size.

    `mm_per_unit` is mm on paper for a unit of the assembly.
    """

    denominator: float | None
    mm_per_unit: float

    @property
    def words(self) -> str:
        """As it stands in a title block."""
        return NOT_TO_SCALE if self.denominator is None else f"1:{self.denominator:g}"


def paper_scale(assembly: Assembly, wished: float | None = None) -> Scale:
    """Return the scale of the drawing: 1 to what is wished when it fits, or the next usual one.

    Without a wish it is the largest usual one that fits.
    """
    width, height = assembly.size
    if assembly.unit != "m":
        return Scale(None, min(DRAWING_MM[0] / width, DRAWING_MM[1] / height))
    least = 1000.0 * max(width / DRAWING_MM[0], height / DRAWING_MM[1])
    usual = [scale for scale in USUAL_SCALES if wished is None or scale > wished]
    tried = usual if wished is None else [wished, *usual]
    chosen = next((scale for scale in tried if scale >= least * (1 - 1e-9)), least)
    return Scale(chosen, 1000.0 / chosen)


@dataclass(frozen=True, eq=False)
class BuildSheet:
    """The pages of a planned wall, with the photograph of its stones if there is one."""

    assembly: Assembly
    settings: ExportSettings
    photo: StonePhoto | None

    def pages(self) -> list[SheetPage]:
        """Draw the pages: the wall, a line a stone, the fetch list, wedges to cut."""
        pages = [self._first_page(), *self._row_pages(), *self._list_pages()]
        for number, page in enumerate(pages, 1):
            y, right = EDGE_MM - 5.0, page.right
            page.line([(EDGE_MM, EDGE_MM - 1.5), (right, EDGE_MM - 1.5)], colour=GREY)
            # What tells plans apart is first: a long title is cut.
            said, room = f"plan {self._sha256}   {self._title}", right - EDGE_MM - PAGE_NUMBER_MM
            page.write(EDGE_MM, y, said, SMALL_PT, color=FAINT, room=room)
            numbered = f"page {number} of {len(pages)}"
            page.write(right, y, numbered, SMALL_PT, ha="right", color=FAINT)
        return pages

    @cached_property
    def _sha256(self) -> str:
        return plan_digest(self.assembly.plan)

    @property
    def _title(self) -> str:
        source = source_name(self.assembly.plan)
        return self.settings.title or (f"Build sheet for {source}" if source else "Build sheet")

    def _first_page(self) -> SheetPage:
        """Draw the wall with the numbers of the steps, its dimensions and the title block."""
        page, assembly = SheetPage(A4_MM[::-1]), self.assembly
        scale = paper_scale(assembly, self.settings.paper_scale)
        width, height = (side * scale.mm_per_unit for side in assembly.size)
        left = (page.width - width) / 2 + 5.0
        bottom = EDGE_MM + BLOCK_MM + 24.0 + (DRAWING_MM[1] - height) / 2
        page.write(EDGE_MM, page.top - 6.0, self._title, 18.0, weight="bold",
                   room=page.right - EDGE_MM - SCALE_MM)  # fmt: skip
        said = (
            "Numbers are steps, in the order of building: set each stone, then push in its wedges."
        )
        page.write(EDGE_MM, page.top - 12.5, said)
        colour = WEDGE_COLOUR if scale.denominator is None else "black"
        page.write(page.right, page.top - 6.0, scale.words, 14.0, ha="right", weight="bold",
                   color=colour)  # fmt: skip
        # The ground: a line, and strokes below it.
        ends = max(EDGE_MM, left - 10.0), min(page.right, left + width + 10.0)
        page.line([(ends[0], bottom), (ends[1], bottom)], width_pt=1.2, z=4.0)
        for x in np.arange(ends[0] + 3.0, ends[1] + 1e-9, 3.0):
            page.line([(x, bottom), (x - 2.5, bottom - 2.5)], colour=GREY)
        page.box(left, bottom, width, height, name="frame", line=GREY, dashes=FRAME_DASHES)
        blocks = drawing_of_assembly(assembly).layers("STONES", "WEDGES", "NUMBERS")
        page.draw(*placed(blocks, scale.mm_per_unit, (left, bottom)))
        across, up = (f"{side} {assembly.unit}" for side in self._size)
        page.dimension((left, bottom - 8.0), (left + width, bottom - 8.0), across)
        page.dimension((left - 8.0, bottom), (left - 8.0, bottom + height), up, upright=True)
        self._title_block(page, scale)
        return page

    @property
    def _size(self) -> list[str]:
        digits = 2 if self.assembly.unit == "m" else 0
        return [f"{side:.{digits}f}" for side in self.assembly.size]

    def _title_block(self, page: SheetPage, scale: Scale) -> None:
        plan = self.assembly.plan
        size = " \N{MULTIPLICATION SIGN} ".join(self._size)
        source = source_name(plan) or "not from a file"
        on_paper = scale.words if scale.denominator is None else f"{scale.words} on A4"
        rows = [
            [("Title", self.settings.title or source), ("Stones", source),
             ("Date", ""), ("Built by", "")],
            [("Wall", f"{size} {self.assembly.unit}"), ("Scale", on_paper),
             ("Stones set", f"{len(plan.stone_steps)}, and {len(plan.unused)} left over"),
             ("Wedges", str(len(plan.wedge_steps)))],
            [("Seed", str(plan.seed)), ("Method", plan.method),
             ("Version", f"drystone {plan.version}"), ("Plan SHA-256", self._sha256)],
        ]  # fmt: skip
        wide = (page.right - EDGE_MM) / 4
        high = BLOCK_MM / len(rows)
        for row, cells in enumerate(rows):
            y = EDGE_MM + BLOCK_MM - (row + 1) * high + 2.0
            for column, (name, value) in enumerate(cells):
                x = EDGE_MM + column * wide
                page.box(x, y, wide, high, width_pt=0.5)
                page.write(x + 1.5, y + high - 3.4, name, 6.5, color=FAINT)
                page.write(x + 1.5, y + 2.2, value, PLAIN_PT + 1, room=wide - 3.0)
        self._ruler(page, EDGE_MM + BLOCK_MM + 7.0, scale)

    @staticmethod
    def _ruler(page: SheetPage, y: float, scale: Scale) -> None:
        """Draw 100 mm, to find out whether a printer has made the page smaller."""
        x = EDGE_MM
        page.line([(x, y), (x + 100.0, y)], width_pt=0.8)
        for step in range(11):
            tick = 2.5 if step % 5 == 0 else 1.4
            page.line([(x + 10.0 * step, y), (x + 10.0 * step, y + tick)])
        said = "100 mm on paper: print at 100 %"
        if scale.denominator is not None:
            said += f"; {scale.denominator / 10:g} m of wall"
        page.write(x + 102.0, y - 0.5, said, SMALL_PT)
        if scale.denominator is None:
            said = "The size of a px is not known: all lengths are in px."
            page.write(page.right, y - 0.5, said, 10.0, ha="right", color=WEDGE_COLOUR)

    def _row_pages(self) -> list[SheetPage]:
        """Draw a line a stone; the drawings that show how to turn one are all to one scale."""
        stones = list(self.assembly.stones)
        high = A4_MM[1] - 2 * EDGE_MM - HEAD_MM - 3.0
        # Pages of about the same length: none has a single row.
        pages = max(1, math.ceil(len(stones) / (high // ROW_MM[0])))
        count = max(1, math.ceil(len(stones) / pages))
        row = min(ROW_MM[1], high / count)
        spans = [float(np.hypot(*np.ptp(part.corners, axis=0))) for part in stones]
        scale = STONE_MM / max(spans, default=1.0)
        return [
            self._row_page(stones[first : first + count], scale, row)
            for first in range(0, len(stones), count)
        ]

    def _row_page(self, stones: Sequence[Part], scale: float, high: float) -> SheetPage:
        page = SheetPage()
        last = [stones[-1], *self.assembly.wedges_after(stones[-1])][-1]
        head = f"Steps {stones[0].step} to {last.step}"
        page.write(EDGE_MM, page.top - 4.5, head, 13.0, weight="bold")
        said = "seen from the front; a mark on top of the stone as it lies shows how it turns"
        page.write(page.right, page.top - 4.5, said, SMALL_PT, ha="right", color=FAINT)
        top = page.top - HEAD_MM + 8.0
        taken = "in the photo" if self.photo else "as it lies"
        for x, name in ((NUMBER, "step"), (PICTURE, taken), (TURN, "how to turn it"),
                        (WHERE, "where"), (BESIDE, "rests on, beside")):  # fmt: skip
            page.write(x, top, name, SMALL_PT, weight="bold")
        arrows = "\N{RIGHTWARDS ARROW} from the left end", "\N{UPWARDS ARROW} above the ground"
        for row, meaning in enumerate(arrows, 1):
            page.write(WHERE, top - 3.1 * row, meaning, 6.0, color=FAINT)
        for row, part in enumerate(stones):
            y = page.top - HEAD_MM - (row + 1) * high
            page.line([(EDGE_MM, y + high), (page.right, y + high)], colour=GREY)
            page.write(NUMBER, y + high - 9.5, str(part.step), 19.0, weight="bold")
            page.write(NUMBER, y + high - 14.0, f"stone {part.id}", SMALL_PT, color=FAINT)
            page.box(NUMBER, y + 4.0, 4.5, 4.5, width_pt=0.7)
            self._picture(page, part, y + high / 2)
            self._turn(page, part, y + high / 2, scale)
            self._words(page, part, y + high - 5.0, high)
        page.line([(EDGE_MM, y), (page.right, y)], colour=GREY)
        return page

    def _picture(self, page: SheetPage, part: Part, middle_mm: float) -> None:
        """Draw a stone as it lies, with what is around it in the photograph."""
        outline = self.assembly.source_corners(part)
        low, high = outline.min(axis=0), outline.max(axis=0)
        spare = CROP_SPARE * float((high - low).max())
        middle, half = (low + high) / 2, (high - low) / 2 + spare
        scale = min(PICTURE_MM[0] / (2 * half[0]), PICTURE_MM[1] / (2 * half[1]))
        at = np.array([PICTURE + PICTURE_MM[0] / 2, middle_mm])
        if self.photo is not None:
            (x0, y0), (x1, y1) = (middle - half).tolist(), (middle + half).tolist()
            (left, bottom), (wide, high) = (at - half * scale).tolist(), (2 * half * scale).tolist()
            extent = (left, left + wide, bottom, bottom + high)
            page.ax.imshow(self.photo.crop((x0, y0, x1, y1)), extent=extent, aspect="auto",
                           interpolation="none", zorder=1)  # fmt: skip
        shape = Surface("", ((outline - middle) * scale + at,), PLAIN_COLOUR, z=3.0)
        over = replace(shape, fill="none", line=WEDGE_COLOUR, width_pt=0.9)
        page.draw(over if self.photo else shape)

    def _turn(self, page: SheetPage, part: Part, middle_mm: float, scale: float) -> None:
        """Draw how a stone lies beside how it is in the wall."""
        angle, middle = words.shortest_turn(part.angle_deg), middle_mm + 2.2
        lying, standing = (TURN + 12.5, middle), (TURN + 39.5, middle)
        own = part.own_corners * scale
        placed = (part.corners - np.array(part.centroid)) * scale
        page.draw(
            Surface("", (own + lying,), "#f4f1ec", GREY),
            Surface("", (placed + standing,), PLAIN_COLOUR),
        )
        # How far the outline reaches straight up from the origin.
        after = np.roll(own, -1, axis=0)
        crossing = (own[:, 0] <= 0.0) != (after[:, 0] <= 0.0)
        (x0, y0), (x1, y1) = own[crossing].T, after[crossing].T
        reach = float((y0 - x0 * (y1 - y0) / (x1 - x0)).max(initial=1.0))
        for centre, turned in ((lying, 0.0), (standing, angle)):
            up = np.radians(90.0 + turned)
            out = np.array([np.cos(up), np.sin(up)])
            mark = [centre + 0.62 * reach * out, centre + reach * out]
            page.line(mark, colour=TURN_COLOUR, width_pt=2.2, z=5.0)
        if abs(angle) >= SEEN_DEG:
            radius = min(4.5, 0.55 * reach)
            page.turn_arrow(lying, radius, angle, TURN_COLOUR)
        page.arrow((TURN + 24.0, middle), (TURN + 28.0, middle))
        said, low = words.turn_words(angle), middle_mm - 11.9
        page.write(TURN + 26.0, low, said, PLAIN_PT + 1, ha="center", weight="bold")

    def _words(self, page: SheetPage, part: Part, top: float, high: float) -> None:
        places = (("middle", part.centroid), ("left end of its foot", words.left_foot(part)))
        for row, (name, point) in enumerate(places):
            at = top - 10.0 * row
            page.write(WHERE, at, name, SMALL_PT, color=FAINT)
            # The grip of a rule: how far from the left end, then how high.
            across, up = (words.length_words(self.assembly, length) for length in point)
            said = f"\N{RIGHTWARDS ARROW} {across.split()[0]}   \N{UPWARDS ARROW} {up}"
            page.write(WHERE, at - 4.2, said, PLAIN_PT)
        told = [(line, "black") for line in wrap(words.beside_words(self.assembly, part), WORDS)]
        for wedge in self.assembly.wedges_after(part):
            lines = wrap(words.wedge_words(self.assembly, wedge), WORDS)
            told += [(line, WEDGE_COLOUR) for line in lines]
        # Lines come closer where there are many, such as three wedges.
        pitch = min(3.9, (high - 4.0) / max(len(told), 1))
        size = min(PLAIN_PT, 2.15 * pitch)
        for place, (line, colour) in enumerate(told):
            page.write(BESIDE, top - pitch * place, line, size, color=colour)

    def _list_pages(self) -> list[SheetPage]:
        """Draw where the stones lie, list them, and draw the wedges to cut.

        The wedges are below the list when all of them have room there, else on pages of their own.
        """
        pages, foot = self._fetch_pages()
        wedges = list(self.assembly.wedges)
        if wedges and _wedge_room(foot) >= len(wedges):
            self._draw_wedges(pages[-1], wedges, foot)
            return pages
        while wedges:
            page = SheetPage()
            count = _wedge_room(page.top)
            self._draw_wedges(page, wedges[:count], page.top)
            pages.append(page)
            wedges = wedges[count:]
        return pages

    def _fetch_pages(self) -> tuple[list[SheetPage], float]:
        """List the stones as one walks past them; return the pages and the foot of the last."""
        stones, pages, foot = in_photo_order(self.assembly), list[SheetPage](), 0.0
        while stones or not pages:
            page = SheetPage()
            page.write(EDGE_MM, page.top - 4.5, "Fetch list", 13.0, weight="bold")
            top = page.top - 11.0
            if not pages:
                said = (
                    "The stones as they lie in the picture that they were found in, from the top "
                )
                page.write(EDGE_MM, top, f"{said}left. Chalk on each the number of its step.")
                top = self._map(page, top - 4.0) - 8.0
            rows = int((top - EDGE_MM - 20.0) // LINE_MM)
            here, stones = stones[: COLUMNS * rows], stones[COLUMNS * rows :]
            # Columns of the same length, when there is room.
            rows = min(rows, -(-len(here) // COLUMNS))
            wide = (page.right - EDGE_MM - GAP_MM * (COLUMNS - 1)) / COLUMNS
            for column in range(COLUMNS):
                part = here[column * rows : (column + 1) * rows]
                self._list(page, part, (EDGE_MM + column * (wide + GAP_MM), top), wide)
            foot = top - (rows + 1) * LINE_MM - 3.0
            if not stones:
                foot = self._left_over(page, foot)
            pages.append(page)
        return pages, foot

    def _draw_wedges(self, page: SheetPage, wedges: Sequence[Part], top: float) -> None:
        page.write(EDGE_MM, top - 4.5, "Wedges to cut", 13.0, weight="bold")
        said = (
            "Each at the scale that stands below it, as it is seen from the front; mm."
            if self.assembly.unit == "m" else f"{NOT_TO_SCALE}: each as large as there is room; px."
        )  # fmt: skip
        page.write(EDGE_MM, top - 10.5, said, PLAIN_PT)
        for place, wedge in enumerate(wedges):
            row, column = divmod(place, CARDS_ACROSS)
            corner = (EDGE_MM + column * CARD_MM[0], top - WEDGE_HEAD_MM - (row + 1) * CARD_MM[1])
            self._card(page, wedge, corner)

    def _map(self, page: SheetPage, top: float) -> float:
        """Draw the frame of the photograph with outlines and steps of stones; return its foot."""
        assembly = self.assembly
        outlines = {part.step: assembly.source_corners(part) for part in assembly.stones}
        reach = np.concatenate([*outlines.values(), [[1.0, 1.0]]]).max(axis=0).tolist()
        source = assembly.plan.source
        width = float(source.get("width_px") or reach[0])
        height = float(source.get("height_px") or reach[1])
        scale = min(MAP_MM[0] / width, MAP_MM[1] / height)
        left, foot = (page.width - width * scale) / 2, top - height * scale
        page.box(left, foot, width * scale, height * scale, line=GREY)
        room = {}
        for step, outline in outlines.items():
            wide, high = (np.ptp(outline, axis=0) * scale * PT_PER_MM).tolist()
            room[step] = float(np.clip(letters_pt(str(step), wide, high), 3.5, 12.0))
        usual = float(np.median([*room.values()])) if room else 0.0
        for step, outline in outlines.items():
            drawn = outline * scale + (left, foot)
            page.draw(Surface("", (drawn,), PLAIN_COLOUR, width_pt=0.4))
            x, y = ((drawn.min(axis=0) + drawn.max(axis=0)) / 2).tolist()
            page.write(x, y, str(step), min(usual, room[step]), ha="center",
                       va="center", zorder=5)  # fmt: skip
        return foot

    def _list(self, page: SheetPage, stones: Sequence[Part], at: Point, wide: float) -> None:
        (x, y), assembly = at, self.assembly
        if not stones:
            return
        columns = (x + 7.0, x + 19.0, x + 33.0, x + 64.0)
        names = ("step", "stone", "across, down", "long, wide")
        for place, name in zip(columns, names, strict=True):
            page.write(place, y, name, SMALL_PT, weight="bold")
        page.line([(x, y - 1.6), (x + wide, y - 1.6)], colour=GREY)
        height = float(assembly.plan.source.get("height_px") or 0.0)
        for row, part in enumerate(stones):
            base = y - (row + 1) * LINE_MM
            across, up = _place(part)
            down = (height - up) / assembly.px_per_unit
            page.box(x + 1.0, base - 0.8, 3.6, 3.6, width_pt=0.7)
            # Length and least width, which do not depend on how it lies.
            width, across_deg = part.grip
            along = np.radians(across_deg + 90.0)
            length = np.ptp(part.own_corners @ np.array([np.cos(along), np.sin(along)]))
            texts = (
                str(part.step), str(part.id),
                words.length_words(assembly, across / assembly.px_per_unit, down),
                words.length_words(assembly, float(length), width),
            )  # fmt: skip
            for place, text in zip(columns, texts, strict=True):
                weight = "bold" if place == columns[0] else "normal"
                page.write(place, base, text, PLAIN_PT, weight=weight)

    def _left_over(self, page: SheetPage, top: float) -> float:
        """Name the stones that the wall is built without; return the foot."""
        unused = self.assembly.plan.unused
        if not unused:
            return top
        page.write(EDGE_MM, top - 4.0, "Left over", PLAIN_PT, weight="bold")
        named = ", ".join(str(stone) for stone in unused)
        lines = wrap(f"stones {named}: the wall is built without them.", 105)
        if len(lines) > LEFT_OVER_LINES:
            lines = [*lines[:LEFT_OVER_LINES], f"and others: {len(unused)} in all."]
        for row, line in enumerate(lines):
            page.write(EDGE_MM + 20.0, top - 4.0 - 4.0 * row, line, PLAIN_PT)
        return top - 5.0 - 4.0 * len(lines)

    def _card(self, page: SheetPage, wedge: Part, corner: Point) -> None:
        """Draw a wedge with its dimensions, the steps it belongs to, and a box for a tick."""
        (x, y), assembly = corner, self.assembly
        page.box(x, y, *CARD_MM, line=GREY, width_pt=0.4)
        stone = assembly.part(wedge.under or 0)
        size = [float(side) for side in np.ptp(wedge.corners, axis=0)]
        page.write(x + 2.0, y + CARD_MM[1] - 6.0, str(wedge.step), 13.0, weight="bold",
                   color=WEDGE_COLOUR)  # fmt: skip
        place = words.wedge_place(assembly, wedge)
        said = f"under {stone.step}, {place}"
        page.write(x + 13.0, y + CARD_MM[1] - 5.6, said, SMALL_PT)
        page.box(x + CARD_MM[0] - 7.0, y + CARD_MM[1] - 7.0, 4.5, 4.5, width_pt=0.7)
        factor = drawn_factor(assembly, wedge)
        per_unit = factor * (1000.0 if assembly.unit == "m" else 1.0)
        shown = [side * per_unit for side in size]
        left = x + 12.0 + (SHAPE_MM[0] - shown[0]) / 2
        foot = y + 11.0 + (SHAPE_MM[1] - shown[1]) / 2
        shape = (wedge.corners - wedge.corners.min(axis=0)) * per_unit + (left, foot)
        page.draw(Surface("", (shape,), "#f3d9d9"))
        texts = [f"{1000 * side:.0f}" if assembly.unit == "m" else f"{side:.0f}" for side in size]
        page.dimension((left, foot - 4.0), (left + shown[0], foot - 4.0), texts[0])
        page.dimension((left - 4.5, foot), (left - 4.5, foot + shown[1]), texts[1], upright=True)
        page.write(x + 2.0, y + 2.0, words.size_words(assembly, wedge), SMALL_PT)
        if assembly.unit == "m":
            scale = f"{factor:g}:1" if factor > 1.0 else f"1:{1 / factor:g}"
            page.write(x + CARD_MM[0] - 2.0, y + 2.0, f"drawn {scale}", SMALL_PT, ha="right")


def in_photo_order(assembly: Assembly) -> list[Part]:
    """Return the stones as they lie: rows of the photograph from the top, each from the left.

    A row ends where the next stone lies lower than the first of the row by more than half of the
    usual height of a stone.
    """
    waiting = sorted(assembly.stones, key=lambda part: -_place(part)[1])
    heights = [part.size[1] * assembly.px_per_unit for part in waiting]
    half = 0.5 * float(np.median(heights)) if heights else 0.0
    rows: list[list[Part]] = []
    for part in waiting:
        if rows and _place(rows[-1][0])[1] - _place(part)[1] <= half:
            rows[-1].append(part)
        else:
            rows.append([part])
    return [part for row in rows for part in sorted(row, key=lambda part: _place(part)[0])]


def _place(part: Part) -> tuple[float, float]:
    step = part.plan_step
    return step.source_centroid if isinstance(step, StoneStep) else (0.0, 0.0)


def drawn_factor(assembly: Assembly, wedge: Part) -> float:
    """Return mm on paper for a mm of a wedge (for a px without a scale): 1, or a usual factor."""
    width, height = (float(side) for side in np.ptp(wedge.corners, axis=0))
    if assembly.unit != "m":
        return min(SHAPE_MM[0] / width, SHAPE_MM[1] / height)
    width, height = 1000.0 * width, 1000.0 * height
    if width <= SHAPE_MM[0] and height <= SHAPE_MM[1] and max(width, height) >= SMALLEST_MM:
        return 1.0
    fitting = [f for f in USUAL_FACTORS if f * width <= SHAPE_MM[0] and f * height <= SHAPE_MM[1]]
    return fitting[0] if fitting else min(SHAPE_MM[0] / width, SHAPE_MM[1] / height)


def _wedge_room(top: float) -> int:
    return CARDS_ACROSS * max(0, int((top - WEDGE_HEAD_MM - EDGE_MM) // CARD_MM[1]))
