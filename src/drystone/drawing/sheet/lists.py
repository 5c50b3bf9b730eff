"""The last pages of a build sheet: where the stones lie, wedges to cut, what is left over."""

from collections.abc import Sequence
from textwrap import wrap

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.drawing import Surface, letters_pt
from drystone.drawing.palette import GREY, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.drawing.sheet.page import (
    EDGE_MM,
    NOT_TO_SCALE,
    PLAIN_PT,
    PT_PER_MM,
    SMALL_PT,
    SheetPage,
)
from drystone.drawing.sheet.words import length_words, size_words, wedge_place
from drystone.model.plan import StoneStep

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


def list_pages(assembly: Assembly) -> list[SheetPage]:
    """Draw where the stones lie, list them, and draw the wedges to cut.

    The wedges are below the list when all of them have room there, else on pages of their own.
    """
    pages, foot = _fetch_pages(assembly)
    wedges = list(assembly.wedges)
    if wedges and _wedge_room(foot) >= len(wedges):
        _draw_wedges(pages[-1], assembly, wedges, foot)
        return pages
    while wedges:
        page = SheetPage()
        count = _wedge_room(page.top)
        _draw_wedges(page, assembly, wedges[:count], page.top)
        pages.append(page)
        wedges = wedges[count:]
    return pages


def _fetch_pages(assembly: Assembly) -> tuple[list[SheetPage], float]:
    """Return pages with the stones in the order in which one walks past them, and their foot."""
    stones, pages, foot = in_photo_order(assembly), list[SheetPage](), 0.0
    while stones or not pages:
        page = SheetPage()
        page.write(EDGE_MM, page.top - 4.5, "Fetch list", 13.0, weight="bold")
        top = page.top - 11.0
        if not pages:
            page.write(
                EDGE_MM, top,
                "The stones as they lie in the picture that they were found in, from the top "
                "left. Chalk on each the number of its step.", PLAIN_PT,
            )  # fmt: skip
            top = _map(page, assembly, top - 4.0) - 8.0
        rows = int((top - EDGE_MM - 20.0) // LINE_MM)
        here, stones = stones[: COLUMNS * rows], stones[COLUMNS * rows :]
        # Columns of the same length, when there is room.
        rows = min(rows, -(-len(here) // COLUMNS))
        wide = (page.right - EDGE_MM - GAP_MM * (COLUMNS - 1)) / COLUMNS
        for column in range(COLUMNS):
            _list(page, assembly, here[column * rows : (column + 1) * rows],
                  (EDGE_MM + column * (wide + GAP_MM), top), wide)  # fmt: skip
        foot = top - (rows + 1) * LINE_MM - 3.0
        if not stones:
            foot = _left_over(page, assembly, foot)
        pages.append(page)
    return pages, foot


def _wedge_room(top: float) -> int:
    return CARDS_ACROSS * max(0, int((top - WEDGE_HEAD_MM - EDGE_MM) // CARD_MM[1]))


def _draw_wedges(page: SheetPage, assembly: Assembly, wedges: Sequence[Part], top: float) -> None:
    page.write(EDGE_MM, top - 4.5, "Wedges to cut", 13.0, weight="bold")
    said = (
        "Each at the scale that stands below it, as it is seen from the front; mm."
        if assembly.unit == "m" else f"{NOT_TO_SCALE}: each as large as there is room; px."
    )  # fmt: skip
    page.write(EDGE_MM, top - 10.5, said, PLAIN_PT)
    for place, wedge in enumerate(wedges):
        row, column = divmod(place, CARDS_ACROSS)
        corner = (EDGE_MM + column * CARD_MM[0], top - WEDGE_HEAD_MM - (row + 1) * CARD_MM[1])
        _card(page, assembly, wedge, corner)


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


def _place(part: Part) -> tuple[float, float]:
    step = part.plan_step
    return step.source_centroid if isinstance(step, StoneStep) else (0.0, 0.0)


def _map(page: SheetPage, assembly: Assembly, top: float) -> float:
    """Draw the photograph's frame with the outlines and steps of the stones; return its foot."""
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


def _list(
    page: SheetPage,
    assembly: Assembly,
    stones: Sequence[Part],
    at: tuple[float, float],
    wide: float,
) -> None:
    x, y = at
    if not stones:
        return
    columns = (x + 7.0, x + 19.0, x + 33.0, x + 64.0)
    for place, name in zip(columns, ("step", "stone", "across, down", "long, wide"), strict=True):
        page.write(place, y, name, SMALL_PT, weight="bold")
    page.line([(x, y - 1.6), (x + wide, y - 1.6)], colour=GREY)
    height = float(assembly.plan.source.get("height_px") or 0.0)
    for row, part in enumerate(stones):
        base = y - (row + 1) * LINE_MM
        across, up = _place(part)
        down = (height - up) / assembly.px_per_unit
        page.tick_box(x + 1.0, base - 0.8, 3.6)
        texts = (
            str(part.step), str(part.id),
            length_words(assembly, across / assembly.px_per_unit, down),
            length_words(assembly, *_sides(part)),
        )  # fmt: skip
        for place, text, weight in zip(columns, texts, ("bold", "normal", "normal", "normal"),
                                       strict=True):  # fmt: skip
            page.write(place, base, text, PLAIN_PT, weight=weight)


def _sides(part: Part) -> tuple[float, float]:
    """Return length and least width of a part, which do not depend on how it lies."""
    width, across_deg = part.grip
    along = np.radians(across_deg + 90.0)
    length = np.ptp(part.own_corners @ np.array([np.cos(along), np.sin(along)]))
    return float(length), width


def _left_over(page: SheetPage, assembly: Assembly, top: float) -> float:
    """Name the stones that the wall is built without; return the foot."""
    unused = assembly.plan.unused
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


def _card(page: SheetPage, assembly: Assembly, wedge: Part, corner: tuple[float, float]) -> None:
    """Draw a wedge with its dimensions, the steps it belongs to, and a box for a tick."""
    x, y = corner
    page.box(x, y, *CARD_MM, line=GREY, width_pt=0.4)
    stone = assembly.part(wedge.under or 0)
    size = [float(side) for side in np.ptp(wedge.corners, axis=0)]
    page.write(x + 2.0, y + CARD_MM[1] - 6.0, str(wedge.step), 13.0, weight="bold",
               color=WEDGE_COLOUR)  # fmt: skip
    words = f"under {stone.step}, {wedge_place(assembly, wedge)}"
    page.write(x + 13.0, y + CARD_MM[1] - 5.6, words, SMALL_PT)
    page.tick_box(x + CARD_MM[0] - 7.0, y + CARD_MM[1] - 7.0)
    factor = drawn_factor(assembly, wedge)
    per_unit = factor * (1000.0 if assembly.unit == "m" else 1.0)
    shown = [side * per_unit for side in size]
    left, foot = x + 12.0 + (SHAPE_MM[0] - shown[0]) / 2, y + 11.0 + (SHAPE_MM[1] - shown[1]) / 2
    low = wedge.corners.min(axis=0)
    shape = (wedge.corners - low) * per_unit + (left, foot)
    page.draw(Surface("", (shape,), "#f3d9d9"))
    texts = [f"{1000 * side:.0f}" if assembly.unit == "m" else f"{side:.0f}" for side in size]
    page.dimension((left, foot - 4.0), (left + shown[0], foot - 4.0), texts[0])
    page.dimension((left - 4.5, foot), (left - 4.5, foot + shown[1]), texts[1], upright=True)
    page.write(x + 2.0, y + 2.0, size_words(assembly, *size), SMALL_PT)
    if assembly.unit == "m":
        scale = f"{factor:g}:1" if factor > 1.0 else f"1:{1 / factor:g}"
        page.write(x + CARD_MM[0] - 2.0, y + 2.0, f"drawn {scale}", SMALL_PT, ha="right")
