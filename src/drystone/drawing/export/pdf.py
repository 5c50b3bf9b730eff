"""build-sheet.pdf: what a mason needs on the scaffold, on A4."""

from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_pdf import PdfPages

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.sheet.lists import list_pages
from drystone.drawing.sheet.page import Page
from drystone.drawing.sheet.photo import read_photo
from drystone.drawing.sheet.rows import Rows
from drystone.drawing.sheet.wall import first_page, plan_sha256
from drystone.whole_files import write_whole

NAME = "build-sheet.pdf"

_UNDATED = {"CreationDate": None, "Producer": None, "Creator": None}
_TRUETYPE: dict[Any, int] = {"pdf.fonttype": 42, "pdf.compression": 6}
"""Letters as letters: they can be searched for and copied."""


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E189 when the photograph cannot be used."""
    read_photo(assembly)
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write the build sheet; equal plans give equal bytes.

    Raises
    ------
    InputError
        E189 when the photograph of the stones cannot be used.
    """
    path = folder / NAME
    write_whole(path, sheet_bytes(sheet(assembly, settings)))
    return (path,)


def sheet(assembly: Assembly, settings: ExportSettings) -> list[Page]:
    """Draw the pages: the wall, a line a stone, the fetch list, wedges to cut."""
    source = str(assembly.plan.source.get("path") or "")
    title = settings.title or (f"Build sheet for {source}" if source else "Build sheet")
    pages = [
        first_page(assembly, settings, title),
        *Rows(assembly, read_photo(assembly)).pages(),
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
