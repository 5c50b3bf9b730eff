"""build-sheet.pdf: what a mason needs on the scaffold, on A4."""

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_pdf import PdfPages

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.formats import ExportSettings
from drystone.drawing.photo import Photo
from drystone.drawing.sheet.lists import list_pages
from drystone.drawing.sheet.page import Page
from drystone.drawing.sheet.rows import Rows
from drystone.drawing.sheet.wall import first_page, plan_sha256

_UNDATED = {"CreationDate": None, "Producer": None, "Creator": None}
_TRUETYPE: dict[Any, int] = {"pdf.fonttype": 42, "pdf.compression": 6}
"""Letters as letters: they can be searched for and copied."""


def sheet(assembly: Assembly, settings: ExportSettings, photo: Photo | None) -> list[Page]:
    """Draw the pages: the wall, a line a stone, the fetch list, wedges to cut."""
    source = str(assembly.plan.source.get("path") or "")
    title = settings.title or (f"Build sheet for {source}" if source else "Build sheet")
    pages = [
        first_page(assembly, settings, title),
        *Rows(assembly, photo).pages(),
        *list_pages(assembly),
    ]
    # What tells plans apart is first: a long title is cut.
    foot = f"plan {plan_sha256(assembly)[:16]}   {title}"
    for number, page in enumerate(pages, 1):
        page.foot(foot, number, len(pages))
    return pages


def sheet_bytes(pages: Sequence[Page]) -> bytes:
    """Return the PDF of pages."""
    # Whoever draws sets how letters are kept, and only for this file.
    with mpl.rc_context(_TRUETYPE), BytesIO() as file:
        with PdfPages(file, metadata=_UNDATED) as out:
            for page in pages:
                out.savefig(page.figure)
        return file.getvalue()
