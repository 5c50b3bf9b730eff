"""Drawings by Matplotlib: axes that fit the thing, what is on them, and their files.

Figures are made without pyplot, so nothing global changes and no window opens.
"""

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path as FilePath
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from drystone.drawing.drawing import (
    Dots,
    Drawable,
    Drawing,
    Legend,
    Lines,
    Surface,
    Words,
    letters_pt,
)
from drystone.drawing.lettering import drawable, fitted
from drystone.drawing.outlines import Bounds, Loop
from drystone.drawing.palette import OUTLINE_COLOUR, text_colour
from drystone.whole_files import write_whole

WIDTH_IN = 9.0
"""Width of the drawing area; a picture with margins then fits the text width of a page."""

HEIGHT_IN = 9.0  # largest height of the drawing area
MARGIN_IN = 0.6
LARGEST_PT, SMALLEST_PT, TITLE_PT = 10.0, 3.5, 9.0
BESIDE_PT = ((10.0, 9.0), (-10.0, 9.0), (10.0, -9.0), (-10.0, -9.0))
"""Where words beside a thing may be, from its middle."""

SIZE_BESIDE_PT = 6.5


def draw(drawing: Drawing, ax: Axes | None = None) -> Axes:
    """Draw all of a drawing, on axes of its own when there are none."""
    ax = fit_axes(ax, drawing.box)
    add(ax, drawing.items)
    if drawing.unit:
        ax.set_xlabel(drawing.unit, fontsize=7, labelpad=1)
    else:
        ax.set_axis_off()
    if drawing.title:
        room = ax.get_window_extent().width * 72.0 / ax.figure.dpi
        # What users call things is text, also with dollar signs in it.
        said = fitted(drawable(drawing.title), TITLE_PT, room)
        ax.set_title(said, fontsize=TITLE_PT, loc="left", pad=4, parse_math=False)
    draw_legend(ax, drawing.legend)
    return ax


def add(ax: Axes, items: Iterable[Drawable]) -> None:
    """Draw items on axes that show them already; their names become gids."""
    words: list[Words] = []
    for item in items:
        if isinstance(item, Surface):
            dashes: dict[str, Any] = {"linestyle": (0, item.dashes)} if item.dashes else {}
            draw_block(ax, item.loops, item.name, fill=item.fill, edgecolor=item.line,
                       linewidth=item.width_pt, hatch=item.hatch or None, zorder=item.z,
                       **dashes)  # fmt: skip
        elif isinstance(item, Lines):
            _add_lines(ax, item)
        elif isinstance(item, Dots):
            ax.plot(*item.points.T, linestyle="none", gid=item.name, zorder=item.z,
                    **_marker(item))  # fmt: skip
        else:
            words.append(item)
    ax.apply_aspect()
    for one in words:
        if one.beside:
            _write_beside(ax, one, words)
        else:
            _write(ax, one)


def _add_lines(ax: Axes, item: Lines) -> None:
    if item.head:
        for start, end in item.lines:
            ax.annotate(
                "", xy=end, xytext=start, gid=item.name,
                arrowprops={"arrowstyle": "-|>,head_width=.35,head_length=.7", "shrinkA": 0,
                            "shrinkB": 0, "linewidth": item.width_pt, "color": item.colour},
            )  # fmt: skip
        return
    effects = [withStroke(linewidth=np.max(item.width_pt) + 1.5, foreground="white")]
    drawn = LineCollection(
        [np.asarray(line) for line in item.lines], colors=item.colour, linewidths=item.width_pt,
        linestyles=(0, item.dashes) if item.dashes else "solid", gid=item.name, zorder=item.z,
        capstyle="butt" if item.layer == "SITE" else "round",
        path_effects=effects if item.halo else None,
    )  # fmt: skip
    ax.add_collection(drawn, autolim=False)


def _marker(item: Dots) -> dict[str, Any]:
    edge = {"markerfacecolor": "none", "markeredgewidth": 1.6} if item.open else {}
    return {"color": item.colour, "marker": "o", "markersize": item.size_pt,
            "markeredgewidth": 0.0, **edge}  # fmt: skip


def _write(ax: Axes, words: Words) -> None:
    left, right = ax.get_xlim()
    per_unit = ax.get_window_extent().width / ax.figure.dpi * 72 / (right - left)
    width, height = (float(side * per_unit) for side in words.room)
    size = float(np.clip(letters_pt(words.text, width, height), SMALLEST_PT, LARGEST_PT))
    ax.text(
        *words.at, words.text, size=size, color=words.colour or text_colour(words.on), ha="center",
        va="center_baseline", zorder=words.z, gid=words.name, clip_on=True,
        path_effects=[withStroke(linewidth=0.12 * size, foreground=words.on)],
    )  # fmt: skip


def _write_beside(ax: Axes, words: Words, all_words: Iterable[Words]) -> None:
    """Write beside a thing, away from the words on other things and from the ground."""

    def on_page(points: Any) -> Loop:
        return np.asarray(ax.transData.transform(points) * 72.0 / ax.figure.dpi)

    taken = on_page(np.array([one.at for one in all_words if not one.beside]).reshape(-1, 2))
    places = on_page(words.at) + np.array(BESIDE_PT)
    lowest = ax.get_ylim()[0] if words.at[1] < 0 else 0.0
    ground = on_page((0.0, lowest))[1] + 4.0
    free = [
        float(np.hypot(*(taken - place).T).min(initial=1e9)) if place[1] > ground else 0.0
        for place in places
    ]
    ax.annotate(
        words.text, words.at, BESIDE_PT[int(np.argmax(free))], textcoords="offset points",
        size=SIZE_BESIDE_PT, weight="bold", color=words.colour, ha="center", va="center",
        zorder=words.z, gid=words.name,
        path_effects=[withStroke(linewidth=1.4, foreground=words.on)],
        arrowprops={"arrowstyle": "-", "linewidth": 0.6, "color": words.colour, "shrinkA": 3,
                    "shrinkB": 0},
    )  # fmt: skip


def fit_axes(ax: Axes | None, box: Bounds) -> Axes:
    """Return axes of equal scales that show the box; on a figure of its own when ax is None."""
    width, height = box[2] - box[0], box[3] - box[1]
    if ax is None:
        inches = min(WIDTH_IN / width, HEIGHT_IN / height)
        size = (width * inches + 2 * MARGIN_IN, height * inches + 2 * MARGIN_IN)
        figure = Figure(figsize=size)
        left, bottom = MARGIN_IN / size[0], MARGIN_IN / size[1]
        ax = figure.add_axes((left, bottom, 1 - 2 * left, 1 - 2 * bottom))
    ax.set_xlim(box[0], box[2])
    ax.set_ylim(box[1], box[3])
    ax.set_aspect("equal")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator(nbins="auto", steps=[1, 2, 5, 10]))
    ax.tick_params(labelsize=7, length=2.5, width=0.5)
    for spine in ax.spines.values():
        spine.set_visible(False)
    return ax


def name_axes(ax: Axes, across: str, up: str) -> None:
    """Write what is drawn at both axes of a chart."""
    ax.set_xlabel(across, fontsize=8)
    ax.set_ylabel(up, fontsize=8)
    ax.tick_params(labelsize=7)


def block_path(loops: Iterable[Loop]) -> Path:
    """Join loops into one path; clockwise loops are holes."""
    return Path.make_compound_path(*(Path([*loop, loop[0]], closed=True) for loop in loops))


def draw_block(
    ax: Axes, loops: Iterable[Loop], gid: str, *, fill: str = "none", **style: Any
) -> None:
    """Add a block to axes that are fitted; `gid` names it (in SVG files too)."""
    drawn = {"linewidth": 0.6, "edgecolor": OUTLINE_COLOUR, "joinstyle": "round", **style}
    # Not as a patch of the axes, which are fitted: limits of a thousand paths take seconds.
    ax.add_artist(PathPatch(block_path(loops), facecolor=fill, gid=gid, **drawn))


def draw_legend(ax: Axes, entries: Legend, size: float = 7.0) -> None:
    """Write the meaning of colours and lines in rows under all that belongs to the axes."""
    if not entries:
        return
    around = ax.get_tightbbox() or ax.get_window_extent()
    ends = ax.transAxes.inverted().transform((around.x0, around.y0 - 4))
    ax.legend(
        handles=legend_handles(entries), loc="upper left", bbox_to_anchor=(0.0, ends[1]),
        ncols=9, fontsize=size, frameon=False, borderaxespad=0.0, handlelength=1.4,
        handleheight=1.0, columnspacing=1.3,
    )  # fmt: skip


def legend_handles(entries: Legend) -> list[Patch | Line2D]:
    """Return samples of areas, lines and dots with what they mean."""
    handles: list[Patch | Line2D] = []
    for label, item in entries.items():
        if isinstance(item, Surface):
            handles.append(
                Patch(facecolor=item.fill, edgecolor=item.line, hatch=item.hatch or None,
                      linewidth=0.4, label=label)
            )  # fmt: skip
        elif isinstance(item, Lines):
            style: Any = (0, item.dashes) if item.dashes else "solid"
            handles.append(Line2D([], [], color=item.colour, linewidth=float(np.max(item.width_pt)),
                                  linestyle=style, label=label))  # fmt: skip
        else:
            handles.append(Line2D([], [], linestyle="none", label=label, **_marker(item)))
    return handles


DPI = 200

_UNDATED: dict[str, dict[str, None]] = {
    ".png": {"Software": None},
    ".pdf": {"CreationDate": None, "Producer": None, "Creator": None},
    ".svg": {"Date": None, "Creator": None},
}


def save(figure: Figure | SubFigure, path: str | FilePath, dpi: float = DPI) -> None:
    """Write a figure as PNG, PDF or SVG by the ending, without dates or versions in the file.

    The file is whole or as it was at any time; E206 when it cannot be written.  A subfigure is
    written with the figure that it belongs to.
    """
    suffix = FilePath(path).suffix.lower()
    if suffix not in _UNDATED:
        raise ValueError(f"{path}: pictures end in {', '.join(_UNDATED)}")
    write_whole(FilePath(path), figure_bytes(figure, suffix, dpi))


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
