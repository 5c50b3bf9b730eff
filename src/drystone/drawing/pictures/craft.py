"""What masons' rules find in a wall: one panel a rule."""

from collections.abc import Mapping
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from drystone.craft.finding import Finding, Verdict
from drystone.craft.look import UNSEEN, CraftReport
from drystone.craft.masonry import Masonry
from drystone.drawing.canvas import draw_block, draw_ground, fit_axes, write_number
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.drawing.scene import PALE

FAULT, BESIDE, MARK = "#f0a848", "#dcebf7", "#0b3d66"
"""Stones that do not keep a rule, stones beside a joint that does not, and the joint or edge."""

FAULT_HATCH, BESIDE_HATCH = "////", "...."
MARKS: Mapping[Verdict, str] = {"good": "✓", "fair": "~", "broken": "✗", "not judged": "-"}
INKS: Mapping[Verdict, str] = {
    "good": "#00573b", "fair": "#6b4e00", "broken": "#8b0000", "not judged": "#5a5a5a",
}  # fmt: skip

PANEL_IN, TITLE_IN, EDGE_IN, LEGEND_IN = 6.0, 0.42, 0.15, 0.35
TALLEST_IN = 5.0

NEAR = 0.01
"""Stones of a plan settle a little above the ground, mean stone heights."""


def plot_finding(report: CraftReport, name: str, ax: Axes | None = None) -> Axes:
    """Draw what one rule finds.

    Parameters
    ----------
    report : CraftReport
        From :func:`drystone.craft.look`.
    name : str
        Of the rule.
    ax : Axes, optional
        Where to draw; None makes a figure, with a legend.

    Returns
    -------
    ax : Axes
        In the unit of the outlines.  Numbers on stones are steps of a plan, else ids.
    """
    masonry, finding = report.masonry, report.findings[name]
    alone = ax is None
    ax = fit_axes(ax, _view(masonry))
    ax.set_axis_off()
    x0, y0, x1, _ = _view(masonry)
    if masonry.stones and y0 < 0 and masonry.box[1] <= NEAR * masonry.mean_height:
        draw_ground(ax, x0, x1, -0.8 * y0)
    _draw_stones(ax, masonry, finding)
    halo = [withStroke(linewidth=3.4, foreground="white")]
    for case in finding.cases:
        for line in case.lines:
            ax.plot(*line.T, color=MARK, linewidth=1.9, solid_capstyle="round", zorder=6,
                    path_effects=halo, gid=f"mark-{name}")  # fmt: skip
    ax.set_title(_title(finding), loc="left", fontsize=8.5, pad=3, color=INKS[finding.verdict])
    if alone:
        ax.legend(handles=_legend(masonry), loc="upper left", bbox_to_anchor=(0.0, -0.02),
                  ncols=4, fontsize=7, frameon=False, borderaxespad=0.0)  # fmt: skip
    return ax


def plot_craft(report: CraftReport) -> Figure:
    """Draw all rules on one sheet, two panels in a row.

    Parameters
    ----------
    report : CraftReport
        From :func:`drystone.craft.look`.
    """
    x0, y0, x1, y1 = _view(report.masonry)
    panel = min(PANEL_IN * (y1 - y0) / (x1 - x0), TALLEST_IN)
    rows = (len(report.findings) + 1) // 2
    width = 2 * PANEL_IN + 3 * EDGE_IN
    height = rows * (panel + TITLE_IN) + LEGEND_IN + EDGE_IN
    figure = Figure(figsize=(width, height))
    for place, name in enumerate(report.findings):
        row, column = divmod(place, 2)
        left = EDGE_IN + column * (PANEL_IN + EDGE_IN)
        bottom = height - (row + 1) * (panel + TITLE_IN)
        box = (left / width, bottom / height, PANEL_IN / width, panel / height)
        plot_finding(report, name, figure.add_axes(box))
    left = 2 * EDGE_IN + PANEL_IN  # beside the last panel: there is an odd number of rules
    figure.text(left / width, (LEGEND_IN + EDGE_IN + panel) / height, fill(UNSEEN, 80), fontsize=8,
                va="top", color=INKS["not judged"])  # fmt: skip
    figure.legend(handles=_legend(report.masonry), loc="lower left", ncols=4, fontsize=8,
                  frameon=False, bbox_to_anchor=(EDGE_IN / width, 0.02 / height))  # fmt: skip
    return figure


def _view(masonry: Masonry) -> tuple[float, float, float, float]:
    """Return what a picture shows: the wall and a strip of ground."""
    if not masonry.loops:
        return -0.1, -0.1, 1.1, 1.1
    points = np.concatenate(list(masonry.loops.values()))
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    pad = 0.02 * (x1 - x0)
    return x0 - pad, y0 - pad, x1 + pad, y1 + pad


def _draw_stones(ax: Axes, masonry: Masonry, finding: Finding) -> None:
    fault = {i for case in finding.cases for i in case.stones[: case.at_fault]}
    beside = {i for case in finding.cases for i in case.stones if not case.at_fault}
    for stone, loop in masonry.loops.items():
        colour, hatch = PALE, None
        if stone in fault:
            colour, hatch = FAULT, FAULT_HATCH
        elif stone in beside:
            colour, hatch = BESIDE, BESIDE_HATCH
        wedge = stone in masonry.wedge_ids
        if wedge and stone not in fault:
            colour = WEDGE_COLOUR
        draw_block(ax, (loop,), f"stone-{stone}", fill=colour, linewidth=0.5,
                   edgecolor=OUTLINE_COLOUR if hatch else GREY, zorder=2 + 2 * wedge)  # fmt: skip
        if hatch:
            draw_block(ax, (loop,), f"found-{stone}", linewidth=0.0, hatch=hatch,
                       edgecolor="#8a5a10" if hatch == FAULT_HATCH else "#7fa6c4",
                       zorder=2.5 + 2 * wedge)  # fmt: skip
        if not wedge:
            middle = 0.5 * (loop.min(axis=0) + loop.max(axis=0))
            number = masonry.steps.get(stone, stone)
            write_number(ax, number, (float(middle[0]), float(middle[1])), (loop,), colour)


def _title(finding: Finding) -> str:
    rule = finding.rule
    said = f"{MARKS[finding.verdict]} {rule.title}: {finding.verdict}"
    if finding.number is None:
        return f"{said}. {finding.note}"
    sign = "≥" if rule.higher_is_better else "≤"
    limit = finding.limit
    limits = f"(good {sign} {limit.good:g}, fair {sign} {limit.fair:g})"
    return f"{said}, {finding.amount}   {limits}"


def _legend(masonry: Masonry) -> list[Patch | Line2D]:
    handles: list[Patch | Line2D] = [
        Patch(facecolor=FAULT, edgecolor="#8a5a10", hatch=FAULT_HATCH, linewidth=0.4,
              label="does not keep the rule"),
        Patch(facecolor=BESIDE, edgecolor="#7fa6c4", hatch=BESIDE_HATCH, linewidth=0.4,
              label="beside such a joint"),
        Line2D([], [], color=MARK, linewidth=1.9, label="the joint, lap, bed or edge"),
    ]  # fmt: skip
    if masonry.wedge_ids:
        handles.append(Patch(facecolor=WEDGE_COLOUR, label="wedge"))
    return handles
