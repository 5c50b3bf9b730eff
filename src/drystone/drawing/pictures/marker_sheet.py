"""Sheets of markers to be printed at 1:1."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from numpy.typing import NDArray
from shapely import Polygon, box, union_all
from shapely.geometry.polygon import orient

from drystone.drawing.canvas import block_path
from drystone.drawing.files import pdf_bytes
from drystone.photo.dictionaries import FAMILIES, marker_modules
from drystone.photo.layout import (
    CHECK_LINE_MM,
    MIDDLE_MM,
    ON_A_SHEET,
    margin_mm,
    page_mm,
    sheet_positions_m,
    single_position_m,
)
from drystone.whole_files import write_whole

_MM_PER_INCH = 25.4
_LINE_MM = 5.5
_GREY = "#444444"


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
        each = 1 if self.single else ON_A_SHEET
        return tuple(self.ids[i : i + each] for i in range(0, len(self.ids), each))


def write_marker_sheets(sheets: MarkerSheets, path: str | Path) -> None:
    """Write a PDF, 1:1, with the same bytes for the same sheets.

    E174 when they do not fit on the page, or the family has no such markers; E305 without OpenCV;
    E206 when the file cannot be written.
    """
    write_whole(Path(path), pdf_bytes(marker_page(sheets, ids) for ids in sheets.pages))


def marker_page(sheets: MarkerSheets, ids: Sequence[int]) -> Figure:
    """Draw one page; the axes are millimetres from its upper left corner, y down."""
    width, height = page_mm(sheets.page)
    if sheets.single:
        places = single_position_m(sheets.page, sheets.size_m)[None] * 1000.0
    else:
        places = sheet_positions_m(sheets.page, sheets.size_m) * 1000.0
    figure = Figure(figsize=(width / _MM_PER_INCH, height / _MM_PER_INCH))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set_xlim(0.0, width)
    ax.set_ylim(height, 0.0)
    ax.set_axis_off()
    size = sheets.size_m * 1000.0
    for marker_id, place in zip(ids, places, strict=True):
        _draw_marker(ax, marker_modules(sheets.dictionary, marker_id), place, size)
        # Its number is beyond its white border, toward the page's middle.
        upper, away = place[1] + size / 2 < height / 2, margin_mm(size) * 0.92
        ax.text(
            place[0] + size / 2, place[1] + size + away if upper else place[1] - away,
            f"marker {marker_id}", size=8, color=_GREY, ha="center",
            va="top" if upper else "bottom",
        )  # fmt: skip
    below = places[0, 1] + size + margin_mm(size)
    lower = height if sheets.single else places[-1, 1] - margin_mm(size)
    middle = below + MIDDLE_MM / 2 if sheets.single else (below + lower) / 2
    _write_text(ax, _lines(sheets, ids, places, size), (width / 2, middle))
    return figure


def _draw_marker(
    ax: Axes, black: NDArray[np.bool_], place: NDArray[np.float64], size: float
) -> None:
    """Draw the black squares as one area: printers and viewers leave hairlines between squares."""
    step = size / len(black)
    squares = [
        box(x + column * step, y + row * step, x + (column + 1) * step, y + (row + 1) * step)
        for (x, y) in [place]
        for row, column in np.argwhere(black)
    ]
    area = union_all(squares, grid_size=1e-6)
    parts = [area] if isinstance(area, Polygon) else list(area.geoms)
    loops = [
        np.asarray(ring.coords)[:-1]
        for part in map(orient, parts)
        for ring in (part.exterior, *part.interiors)
    ]
    ax.add_patch(PathPatch(block_path(loops), facecolor="black", edgecolor="none", linewidth=0))


def _lines(
    sheets: MarkerSheets, ids: Sequence[int], places: NDArray[np.float64], size: float
) -> list[str]:
    one = len(ids) == 1
    what = f"marker{'' if one else 's'} {', '.join(map(str, ids))}"
    lines = [
        f"drystone: {what} of {FAMILIES[sheets.dictionary]}, {size:g} mm, on {sheets.page}",
        "1. Print at 100 % (not 'fit to page') and measure the line above.",
    ]
    if one:
        return [
            *lines,
            "2. Lay this and at least one other marker flat on the ground beside the stones,",
            "    all white around the black visible; photograph from above, without glare.",
        ]
    across, down = places[2] + size - places[0]
    return [
        *lines,
        "2. Lay the whole sheet flat beside the stones; photograph from above, without glare.",
        f"Outer corners of the black squares: {across:.1f} mm across, {down:.1f} mm down, "
        f"{np.hypot(across, down):.1f} mm diagonally.",
    ]


def _write_text(ax: Axes, lines: Sequence[str], middle: tuple[float, float]) -> None:
    x, y = middle
    top = y - MIDDLE_MM / 2 + 10.0
    left, right = x - CHECK_LINE_MM / 2, x + CHECK_LINE_MM / 2
    ax.plot([left, right], [top, top], color="black", linewidth=0.5, solid_capstyle="butt")
    for end in (left, right):
        ax.plot([end, end], [top - 2.5, top + 2.5], color="black", linewidth=0.5)
    ax.text(x, top - 1.5, f"measure me: {CHECK_LINE_MM:g} mm", size=9, ha="center", va="bottom")
    for i, line in enumerate(lines):
        ax.text(
            x - 72.0, top + 8.0 + i * _LINE_MM, line, size=9, ha="left", va="center",
            weight="bold" if i == 0 else "normal",
        )  # fmt: skip
