"""The pages of a build sheet with a line a stone, in order."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from textwrap import wrap

import numpy as np

from drystone.drawing.assembly.handling import wedges_after
from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.drawing import Surface
from drystone.drawing.palette import GREY, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.drawing.photo import StonePhoto
from drystone.drawing.sheet.page import A4_MM, EDGE_MM, PLAIN_PT, SMALL_PT, SheetPage
from drystone.drawing.sheet.words import (
    beside_words,
    length_words,
    lowest_corner,
    shortest_turn,
    turn_words,
    wedge_words,
)
from drystone.kernels.polygons import Points

ROW_MM = 27.0
HEAD_MM = 19.0
NUMBER, PICTURE, TURN, WHERE, BESIDE = 12.0, 31.0, 63.0, 120.0, 148.0
"""Where the columns begin, mm from the left edge of the page."""

PICTURE_MM = (30.0, 23.0)
STONE_MM = 22.0  # the largest stone of the wall, turned any way, is drawn this large
WORDS = 28  # letters in a line of the last column
SEEN_DEG = 15.0  # smaller turns have no arrow: it would be a dot
TURN_COLOUR = "#0072b2"
CROP_SPARE = 0.14  # of the size of a stone, around it in its picture


@dataclass(frozen=True, eq=False)
class Rows:
    """What all lines of a build sheet have in common."""

    assembly: Assembly
    photo: StonePhoto | None

    @property
    def per_page(self) -> int:
        """Lines that a page has room for."""
        return int((A4_MM[1] - 2 * EDGE_MM - HEAD_MM) // ROW_MM)

    def pages(self) -> list[SheetPage]:
        """Return the pages; the drawings that show how to turn a stone are all to one scale."""
        stones, count = list(self.assembly.stones), self.per_page
        spans = [float(np.hypot(*np.ptp(part.corners, axis=0))) for part in stones]
        scale = STONE_MM / max(spans, default=1.0)
        return [
            self._page(stones[first : first + count], scale)
            for first in range(0, len(stones), count)
        ]

    def _page(self, stones: Sequence[Part], scale: float) -> SheetPage:
        page = SheetPage()
        last = max(step for part in stones for step in
                   (part.step, *(wedge.step for wedge in self._wedges(part))))  # fmt: skip
        head = f"Steps {stones[0].step} to {last}"
        page.write(EDGE_MM, page.top - 4.5, head, 13.0, weight="bold")
        page.write(
            page.right, page.top - 4.5,
            "seen from the front; a mark on top of the stone as it lies shows how it turns",
            SMALL_PT, ha="right", color="#555555",
        )  # fmt: skip
        top = page.top - HEAD_MM + 8.0
        taken = "in the photo" if self.photo else "as it lies"
        for x, name in ((NUMBER, "step"), (PICTURE, taken), (TURN, "how to turn it"),
                        (WHERE, "where"), (BESIDE, "rests on, beside")):  # fmt: skip
            page.write(x, top, name, SMALL_PT, weight="bold")
        for row, meaning in enumerate(
            ("\N{RIGHTWARDS ARROW} from the left end", "\N{UPWARDS ARROW} above the ground")
        ):
            page.write(WHERE, top - 3.1 * (row + 1), meaning, 6.0, color="#555555")
        for row, part in enumerate(stones):
            y = page.top - HEAD_MM - (row + 1) * ROW_MM
            page.line([(EDGE_MM, y + ROW_MM), (page.right, y + ROW_MM)], colour=GREY)
            page.write(NUMBER, y + ROW_MM - 9.5, str(part.step), 19.0, weight="bold")
            page.write(NUMBER, y + ROW_MM - 14.0, f"stone {part.id}", SMALL_PT, color="#555555")
            page.tick_box(NUMBER, y + 4.0)
            self._picture(page, part, y)
            self._turn(page, part, y, scale)
            self._words(page, part, y)
        page.line([(EDGE_MM, y), (page.right, y)], colour=GREY)
        return page

    def _wedges(self, stone: Part) -> tuple[Part, ...]:
        return wedges_after(self.assembly, stone)

    def _picture(self, page: SheetPage, part: Part, y: float) -> None:
        """Draw a stone as it lies, with what is around it in the photograph."""
        outline = self.assembly.source_corners(part)
        low, high = outline.min(axis=0), outline.max(axis=0)
        spare = CROP_SPARE * float((high - low).max())
        middle, half = (low + high) / 2, (high - low) / 2 + spare
        scale = min(PICTURE_MM[0] / (2 * half[0]), PICTURE_MM[1] / (2 * half[1]))
        at = np.array([PICTURE + PICTURE_MM[0] / 2, y + ROW_MM / 2])
        if self.photo is not None:
            (x0, y0), (x1, y1) = (middle - half).tolist(), (middle + half).tolist()
            (left, bottom), (wide, high) = (at - half * scale).tolist(), (2 * half * scale).tolist()
            page.picture(self.photo.crop((x0, y0, x1, y1)), left, bottom, wide, high)
        shape = Surface("", ((outline - middle) * scale + at,), PLAIN_COLOUR, z=3.0)
        over = replace(shape, fill="none", line=WEDGE_COLOUR, width_pt=0.9)
        page.draw(over if self.photo else shape)

    def _turn(self, page: SheetPage, part: Part, y: float, scale: float) -> None:
        """Draw how a stone lies beside how it is in the wall."""
        angle, middle = shortest_turn(part.angle_deg), y + ROW_MM / 2 + 2.2
        lying, standing = (TURN + 12.5, middle), (TURN + 39.5, middle)
        own = part.own_corners * scale
        placed = (part.corners - np.array(part.centroid)) * scale
        page.draw(
            Surface("", (own + lying,), "#f4f1ec", GREY),
            Surface("", (placed + standing,), PLAIN_COLOUR),
        )
        reach = _reach_up(own)
        for centre, turned in ((lying, 0.0), (standing, angle)):
            up = np.radians(90.0 + turned)
            out = np.array([np.cos(up), np.sin(up)])
            mark = [centre + 0.62 * reach * out, centre + reach * out]
            page.line(mark, colour=TURN_COLOUR, width_pt=2.2, z=5.0)
        if abs(angle) >= SEEN_DEG:
            radius = min(4.5, 0.55 * reach)
            page.turn_arrow(lying, radius, angle, TURN_COLOUR)
        page.arrow((TURN + 24.0, middle), (TURN + 28.0, middle))
        page.write(
            TURN + 26.0, y + 1.6, turn_words(angle), PLAIN_PT + 1, ha="center", weight="bold"
        )

    def _words(self, page: SheetPage, part: Part, y: float) -> None:
        corner, top = lowest_corner(part), y + ROW_MM - 5.0
        for row, (name, point) in enumerate((("middle", part.centroid), ("lowest corner", corner))):
            at = top - 11.0 * row
            page.write(WHERE, at, name, SMALL_PT, color="#555555")
            # The grip of a rule: how far from the left end, then how high.
            for line, (sign, length) in enumerate(
                (("\N{RIGHTWARDS ARROW}", point[0]), ("\N{UPWARDS ARROW}", point[1]))
            ):
                said = f"{sign} {length_words(self.assembly, length)}"
                page.write(WHERE, at - 3.7 * (line + 1), said, PLAIN_PT)
        lines = wrap(beside_words(self.assembly, part), WORDS)
        told = [(line, "black") for line in lines]
        for wedge in self._wedges(part):
            told += [
                (line, WEDGE_COLOUR) for line in wrap(wedge_words(self.assembly, wedge), WORDS)
            ]
        # Lines come closer where there are many, such as three wedges.
        pitch = min(3.9, (ROW_MM - 4.0) / max(len(told), 1))
        size = min(PLAIN_PT, 2.15 * pitch)
        for place, (words, colour) in enumerate(told):
            page.write(BESIDE, top - pitch * place, words, size, color=colour)


def _reach_up(outline: Points) -> float:
    """Return how far an outline reaches straight up from the origin."""
    following = np.roll(outline, -1, axis=0)
    crossing = (outline[:, 0] <= 0.0) != (following[:, 0] <= 0.0)
    (x0, y0), (x1, y1) = outline[crossing].T, following[crossing].T
    heights = y0 - x0 * (y1 - y0) / (x1 - x0)
    return float(heights.max(initial=1.0))
