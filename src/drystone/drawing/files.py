"""Pictures as files, with the same bytes for the same picture."""

from collections.abc import Iterable, Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure, SubFigure

from drystone.drawing.drawing import step_by_id
from drystone.drawing.pictures.mechanism import plot_mechanism
from drystone.drawing.pictures.wall import plot_wall
from drystone.model.wall import Wall
from drystone.statics.model import Direction
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.whole_files import write_whole

PICTURE = "picture.png"
MECHANISMS: dict[Direction, str] = {"left": "mechanism_left.png", "right": "mechanism_right.png"}

DPI = 200

_UNDATED: dict[str, dict[str, None]] = {
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
    ".svg": {"Date": None, "Creator": None},
}


def save(figure: Figure | SubFigure, path: str | Path, dpi: float = DPI) -> None:
    """Write a figure as PNG, PDF or SVG by the ending, without dates or versions in the file.

    The file is whole or as it was at any time; E206 when it cannot be written.  A subfigure is
    written with the figure that it belongs to.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in _UNDATED:
        raise ValueError(f"{path}: pictures end in {', '.join(_UNDATED)}")
    write_whole(Path(path), figure_bytes(figure, suffix, dpi))


def figure_bytes(figure: Figure | SubFigure, suffix: str, dpi: float = DPI) -> bytes:
    """Return a figure as the file of an ending; see :func:`save`."""
    whole = figure.get_figure(root=True)
    # SVG files name their parts by a hash with a random salt unless one is given.
    with mpl.rc_context({"svg.hashsalt": "drystone"}), BytesIO() as file:
        whole.savefig(file, format=suffix[1:], dpi=dpi, bbox_inches="tight", pad_inches=0.08,
                      facecolor="white", metadata=_UNDATED[suffix])  # fmt: skip
        return file.getvalue()


def pdf_bytes(figures: Iterable[Figure]) -> bytes:
    """Return a PDF with a page a figure, each as large as it is."""
    # Letters are kept as letters, for this file alone: they can be searched for and copied.
    letters: dict[Any, int] = {"pdf.fonttype": 42, "pdf.compression": 6}
    with mpl.rc_context(letters), BytesIO() as file:
        with PdfPages(file, metadata=_UNDATED[".pdf"]) as pages:
            for figure in figures:
                pages.savefig(figure)
        return file.getvalue()


def write_pictures(
    folder: str | Path,
    wall: Wall,
    clusters: Mapping[int, int] | None = None,
    *,
    resistance: LateralResistance | None = None,
) -> None:
    """Write picture.png, and mechanism_left.png and mechanism_right.png where they exist (§2).

    A picture of a mechanism that an earlier run left in the folder is removed when this wall has
    none: it would belong to another wall.
    """
    folder = Path(folder)
    save(plot_wall(wall, clusters).figure, folder / PICTURE)
    for direction, name in MECHANISMS.items():
        path = folder / name
        result = None if resistance is None else getattr(resistance, direction)
        if result is None or result.mechanism is None:
            path.unlink(missing_ok=True)
            continue
        side = None if result.status is LimitStatus.UNSTABLE else result.direction
        shown = wall.labels if wall.outlines is None else dict(wall.outlines.blocks)
        ax = plot_mechanism(shown, result.mechanism, side, result.alpha, numbers=step_by_id(wall))
        save(ax.figure, path)
