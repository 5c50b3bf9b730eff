"""What masons' rules find in a wall: one panel a rule."""

from collections.abc import Mapping
from dataclasses import replace
from textwrap import fill

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.craft.finding import Finding, Verdict
from drystone.craft.look import UNSEEN, CraftReport
from drystone.craft.masonry import Masonry
from drystone.drawing.canvas import add, draw_legend, fit_axes, legend_handles
from drystone.drawing.drawing import Drawable, Lines, Surface, Words, ground
from drystone.drawing.outlines import Bounds, regions_box
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PALE, WEDGE_COLOUR

FAULT = Surface("", (), "#f0a848", "#8a5a10", hatch="////")
BESIDE = Surface("", (), "#dcebf7", "#7fa6c4", hatch="....")
MARK = "#0b3d66"
"""Stones that do not keep a rule, stones beside a joint that does not, and the joint or edge."""

MARKS: Mapping[Verdict, str] = {"good": "✓", "fair": "~", "broken": "✗", "not judged": "-"}
INKS: Mapping[Verdict, str] = {
    "good": "#00573b", "fair": "#6b4e00", "broken": "#8b0000", "not judged": "#5a5a5a",
}  # fmt: skip

PANEL_IN, TITLE_IN, EDGE_IN, LEGEND_IN = 6.0, 0.42, 0.15, 0.35
TALLEST_IN = 5.0

NEAR = 0.01  # stones of a plan settle a little above the ground, mean stone heights


def plot_finding(report: CraftReport, name: str, ax: Axes | None = None) -> Axes:
    """Draw what one rule finds, in the unit of the outlines; a figure of its own has a legend.

    Numbers on stones are steps of a plan, else ids.
    """
    masonry, finding = report.masonry, report.findings[name]
    alone = ax is None
    ax = fit_axes(ax, _view(masonry))
    ax.set_axis_off()
    x0, y0, x1, _ = _view(masonry)
    if masonry.stones and y0 < 0 and masonry.box[1] <= NEAR * masonry.mean_height:
        add(ax, ground((x0, 0.8 * y0, x1, 0.0)))
    marks = (
        Lines(f"mark-{name}", case.lines, MARK, 1.9, halo=True, z=6.0)
        for case in finding.cases if case.lines
    )  # fmt: skip
    add(ax, [*_stones(masonry, finding), *marks])
    ax.set_title(_title(finding), loc="left", fontsize=8.5, pad=3, color=INKS[finding.verdict])
    if alone:
        draw_legend(ax, _legend(masonry))
    return ax


def plot_craft(report: CraftReport) -> Figure:
    """Draw all rules on one sheet, two panels in a row."""
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
    handles = legend_handles(_legend(report.masonry))
    figure.legend(handles=handles, loc="lower left", ncols=4, fontsize=8, frameon=False,
                  bbox_to_anchor=(EDGE_IN / width, 0.02 / height))  # fmt: skip
    return figure


def _view(masonry: Masonry) -> Bounds:
    """Return what a picture shows: the wall and a strip of ground."""
    if not masonry.loops:
        return -0.1, -0.1, 1.1, 1.1
    x0, y0, x1, y1 = regions_box([masonry.loops.values()])
    pad = 0.02 * (x1 - x0)
    return x0 - pad, y0 - pad, x1 + pad, y1 + pad


def _stones(masonry: Masonry, finding: Finding) -> list[Drawable]:
    fault = {i for case in finding.cases for i in case.stones[: case.at_fault]}
    beside = {i for case in finding.cases for i in case.stones if not case.at_fault}
    items: list[Drawable] = []
    for stone, loop in masonry.loops.items():
        found = FAULT if stone in fault else BESIDE if stone in beside else None
        wedge = stone in masonry.wedge_ids
        fill = WEDGE_COLOUR if wedge and stone not in fault else found.fill if found else PALE
        area = Surface(f"stone-{stone}", (loop,), fill, OUTLINE_COLOUR if found else GREY,
                    width_pt=0.5, z=4.0 if wedge else 2.0)  # fmt: skip
        items.append(area)
        if found:
            items.append(replace(area, name=f"found-{stone}", fill="none", line=found.line,
                                 width_pt=0.0, hatch=found.hatch, z=area.z + 0.5))  # fmt: skip
        if not wedge:
            x, y = (0.5 * (loop.min(axis=0) + loop.max(axis=0))).tolist()
            number = str(masonry.steps.get(stone, stone))
            items.append(Words(f"number-{stone}", number, (x, y), area.room, fill))
    return items


def _title(finding: Finding) -> str:
    rule = finding.rule
    said = f"{MARKS[finding.verdict]} {rule.title}: {finding.verdict}"
    if finding.number is None:
        return f"{said}. {finding.note}"
    sign = "≥" if rule.higher_is_better else "≤"
    limit = finding.limit
    limits = f"(good {sign} {limit.good:g}, fair {sign} {limit.fair:g})"
    return f"{said}, {finding.amount}   {limits}"


def _legend(masonry: Masonry) -> dict[str, Surface | Lines]:
    legend: dict[str, Surface | Lines] = {
        "does not keep the rule": FAULT,
        "beside such a joint": BESIDE,
        "the joint, lap, bed or edge": Lines("", [], MARK, 1.9),
    }
    if masonry.wedge_ids:
        legend["wedge"] = Surface("", (), WEDGE_COLOUR)
    return legend
