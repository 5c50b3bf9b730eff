"""build-sheet.pdf: what a mason needs on the scaffold, on A4.

The first page has the wall to scale and the title block.
"""

import hashlib
import json
from dataclasses import dataclass

import numpy as np

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.drawing import placed
from drystone.drawing.export.formats import ExportSettings
from drystone.drawing.palette import GREY, WEDGE_COLOUR
from drystone.drawing.photo import StonePhoto
from drystone.drawing.sheet.lists import list_pages
from drystone.drawing.sheet.page import (
    EDGE_MM,
    LARGE_PT,
    NOT_TO_SCALE,
    PLAIN_PT,
    SMALL_PT,
    SheetPage,
)
from drystone.drawing.sheet.rows import Rows
from drystone.drawing.wall import FRAME_DASHES, drawing_of_assembly
from drystone.io.plan_json import plan_to_json

USUAL_SCALES = (1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0, 250.0, 500.0, 1000.0)

DRAWING_MM = (297.0 - 2 * EDGE_MM - 18.0, 110.0)
"""Room for the wall itself on the first page; beside it are dimension lines, above it words."""

SCALE_MM = 60.0  # room for the scale at the right end of the head
BLOCK_MM = 33.0  # height of the title block


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


def paper_scale(assembly: Assembly, wished: float) -> Scale:
    """Return the scale of the drawing: 1 to what is wished when it fits, or the next usual one."""
    width, height = assembly.size
    if assembly.unit != "m":
        return Scale(None, min(DRAWING_MM[0] / width, DRAWING_MM[1] / height))
    least = 1000.0 * max(width / DRAWING_MM[0], height / DRAWING_MM[1])
    larger = [scale for scale in USUAL_SCALES if scale > wished]
    chosen = next((scale for scale in (wished, *larger) if scale >= least * (1 - 1e-9)), least)
    return Scale(chosen, 1000.0 / chosen)


def sheet(
    assembly: Assembly, settings: ExportSettings, photo: StonePhoto | None
) -> list[SheetPage]:
    """Draw the pages: the wall, a line a stone, the fetch list, wedges to cut."""
    source = str(assembly.plan.source.get("path") or "")
    title = settings.title or (f"Build sheet for {source}" if source else "Build sheet")
    # As drystone.io.plan_json.write_plan writes it.
    plan = json.dumps(plan_to_json(assembly.plan), ensure_ascii=False, allow_nan=False, indent=1)
    sha256 = hashlib.sha256(f"{plan}\n".encode()).hexdigest()[:16]
    pages = [
        _first_page(assembly, settings, title, sha256),
        *Rows(assembly, photo).pages(),
        *list_pages(assembly),
    ]
    for number, page in enumerate(pages, 1):
        # What tells plans apart is first: a long title is cut.
        page.foot(f"plan {sha256}   {title}", number, len(pages))
    return pages


def _first_page(assembly: Assembly, settings: ExportSettings, title: str, sha256: str) -> SheetPage:
    """Draw the wall with the numbers of the steps, its dimensions and the title block."""
    page = SheetPage(landscape=True)
    scale = paper_scale(assembly, settings.paper_scale)
    width, height = (side * scale.mm_per_unit for side in assembly.size)
    left = (page.width - width) / 2 + 5.0
    bottom = EDGE_MM + BLOCK_MM + 24.0 + (DRAWING_MM[1] - height) / 2
    page.write(EDGE_MM, page.top - 6.0, title, 18.0, weight="bold",
               room=page.right - EDGE_MM - SCALE_MM)  # fmt: skip
    page.write(
        EDGE_MM, page.top - 12.5,
        "Numbers are steps, in the order of building: set each stone, then push in its wedges.",
        PLAIN_PT,
    )  # fmt: skip
    loud = scale.denominator is None
    page.write(page.right, page.top - 6.0, scale.words, 14.0, ha="right", weight="bold",
               color=WEDGE_COLOUR if loud else "black")  # fmt: skip
    _earth(page, left, bottom, width)
    page.box(left, bottom, width, height, name="frame", line=GREY, dashes=FRAME_DASHES)
    blocks = drawing_of_assembly(assembly).layers("STONES", "WEDGES", "NUMBERS")
    page.draw(*placed(blocks, scale.mm_per_unit, (left, bottom)))
    across, up = (
        f"{side:.2f} m" if assembly.unit == "m" else f"{side:.0f} px" for side in assembly.size
    )
    page.dimension((left, bottom - 8.0), (left + width, bottom - 8.0), across)
    page.dimension((left - 8.0, bottom), (left - 8.0, bottom + height), up, upright=True)
    _title_block(page, assembly, settings, scale, sha256)
    return page


def _earth(page: SheetPage, left: float, bottom: float, width: float) -> None:
    """Draw the ground: a line, and strokes below it."""
    ends = max(EDGE_MM, left - 10.0), min(page.right, left + width + 10.0)
    page.line([(ends[0], bottom), (ends[1], bottom)], width_pt=1.2, z=4.0)
    for x in np.arange(ends[0] + 3.0, ends[1] + 1e-9, 3.0):
        page.line([(x, bottom), (x - 2.5, bottom - 2.5)], colour=GREY)


def _title_block(
    page: SheetPage, assembly: Assembly, settings: ExportSettings, scale: Scale, sha256: str
) -> None:
    plan = assembly.plan
    stones, wedges = len(plan.stone_steps), len(plan.wedge_steps)
    size = " \N{MULTIPLICATION SIGN} ".join(
        f"{side:.2f}" if assembly.unit == "m" else f"{side:.0f}" for side in assembly.size
    )
    source = str(plan.source.get("path") or "not from a file")
    on_paper = scale.words if scale.denominator is None else f"{scale.words} on A4"
    rows = [
        [("Title", settings.title or source), ("Stones", source),
         ("Date", ""), ("Built by", "")],
        [("Wall", f"{size} {assembly.unit}"), ("Scale", on_paper),
         ("Stones set", f"{stones}, and {len(plan.unused)} left over"), ("Wedges", str(wedges))],
        [("Seed", str(plan.seed)), ("Method", plan.method),
         ("Version", f"drystone {plan.version}"), ("Plan SHA-256", sha256)],
    ]  # fmt: skip
    wide = (page.right - EDGE_MM) / 4
    high = BLOCK_MM / len(rows)
    for row, cells in enumerate(rows):
        y = EDGE_MM + BLOCK_MM - (row + 1) * high + 2.0
        for column, (name, value) in enumerate(cells):
            x = EDGE_MM + column * wide
            page.box(x, y, wide, high, width_pt=0.5)
            page.write(x + 1.5, y + high - 3.4, name, 6.5, color="#555555")
            page.write(x + 1.5, y + 2.2, value, PLAIN_PT + 1, room=wide - 3.0)
    _ruler(page, EDGE_MM + BLOCK_MM + 7.0, scale)


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
        page.write(
            page.right, y - 0.5, "The size of a px is not known: all lengths are in px.",
            LARGE_PT - 2, ha="right", color=WEDGE_COLOUR,
        )  # fmt: skip
