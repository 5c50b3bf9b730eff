"""Sheets of markers to be printed at 1:1."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from drystone.drawing.canvas import pdf_bytes
from drystone.drawing.drawing import Surface
from drystone.drawing.outlines import pixel_loops
from drystone.drawing.sheet.pages import SheetPage
from drystone.photo import layout
from drystone.photo.markers import FAMILIES, marker_modules
from drystone.whole_files import write_whole


@dataclass(frozen=True)
class MarkerSheets:
    """What is to be printed: markers in their order, four a sheet, or one a page.

    `size_m` is the side of the black square, `dictionary` ``"aruco"`` or ``"apriltag"``, `page`
    ``"A4"``, ``"A3"`` or ``"letter"``.
    """

    ids: tuple[int, ...]
    size_m: float
    dictionary: str = "aruco"
    page: str = "A4"
    single: bool = False

    @property
    def pages(self) -> tuple[tuple[int, ...], ...]:
        """Ids by page."""
        each = 1 if self.single else layout.ON_A_SHEET
        return tuple(self.ids[i : i + each] for i in range(0, len(self.ids), each))


def write_marker_sheets(sheets: MarkerSheets, path: str | Path) -> None:
    """Write a PDF, 1:1, with the same bytes for the same sheets.

    E174 when they do not fit on the page, or the family has no such markers; E305 without OpenCV;
    E206 when the file cannot be written.
    """
    write_whole(Path(path), pdf_bytes(marker_page(sheets, ids).figure for ids in sheets.pages))


def marker_page(sheets: MarkerSheets, ids: Sequence[int]) -> SheetPage:
    """Draw one page; places of markers are mm from its upper left corner, y down."""
    page, size = SheetPage(layout.page_mm(sheets.page)), sheets.size_m * 1000.0
    if sheets.single:
        places = layout.single_position_m(sheets.page, sheets.size_m)[None] * 1000.0
    else:
        places = layout.sheet_positions_m(sheets.page, sheets.size_m) * 1000.0
    for marker_id, (x, y) in zip(ids, places.tolist(), strict=True):
        black = marker_modules(sheets.dictionary, marker_id)
        # One area: printers and viewers leave hairlines between squares.
        step, corner = size / len(black), (x, page.height - y - size)
        loops = tuple(loop * step + corner for loop in pixel_loops(black))
        page.draw(Surface("", loops, "#000000", "none", width_pt=0.0))
        # Its number is beyond its white border, toward the page's middle.
        upper, away = y + size / 2 < page.height / 2, layout.margin_mm(size) * 0.92
        below = y + size + away if upper else y - away
        page.write(x + size / 2, page.height - below, f"marker {marker_id}", 8.0, color="#444444",
                   ha="center", va="top" if upper else "bottom")  # fmt: skip
    margin = layout.margin_mm(size)
    below, lower = places[0, 1] + size + margin, places[-1, 1] - margin
    middle = below + layout.MIDDLE_MM / 2 if sheets.single else (below + lower) / 2
    x, top = page.width / 2, page.height - middle + layout.MIDDLE_MM / 2 - 10.0
    left, right = x - layout.CHECK_LINE_MM / 2, x + layout.CHECK_LINE_MM / 2
    page.line([(left, top), (right, top)], colour="#000000")
    for end in (left, right):
        page.line([(end, top - 2.5), (end, top + 2.5)], colour="#000000")
    said = f"measure me: {layout.CHECK_LINE_MM:g} mm"
    page.write(x, top + 1.5, said, 9.0, ha="center", va="bottom", color="black")
    for i, line in enumerate(_lines(sheets, ids, places, size)):
        weight = "bold" if i == 0 else "normal"
        page.write(x - 72.0, top - 8.0 - i * 5.5, line, 9.0, va="center", weight=weight,
                   color="black")  # fmt: skip
    return page


def _lines(
    sheets: MarkerSheets, ids: Sequence[int], places: NDArray[np.float64], size: float
) -> list[str]:
    what = f"marker{'' if len(ids) == 1 else 's'} {', '.join(map(str, ids))}"
    lines = [
        f"drystone: {what} of {FAMILIES[sheets.dictionary][0]}, {size:g} mm, on {sheets.page}",
        "1. Print at 100 % (not 'fit to page') and measure the line above.",
    ]
    if sheets.single:
        lines += [
            "2. Lay this and at least one other marker flat on the ground beside the stones,",
            "    all white around the black visible; photograph from above, without glare.",
        ]
    else:
        across, down = places[2] + size - places[0]
        lines += [
            "2. Lay the whole sheet flat beside the stones; photograph from above, without glare.",
            f"Outer corners of the black squares: {across:.1f} mm across, {down:.1f} mm down, "
            f"{np.hypot(across, down):.1f} mm diagonally.",
        ]
    return lines
