"""A planned wall, every stone in the colour of its risk to fall."""

from matplotlib.axes import Axes

from drystone.drawing.canvas import draw
from drystone.drawing.drawing import Drawable, Drawing, Surface, Words, ground
from drystone.drawing.outlines import polygon_regions, regions_box
from drystone.drawing.palette import PALE, rgb
from drystone.drawing.words.rehearsed import Rehearsed

SURE, UNSURE, FALLS = "#d5e8d4", "#f0c050", "#b03030"
"""Stones that never fall, fall in half of the runs, and in all."""


def plot_risk(card: Rehearsed, ax: Axes | None = None) -> Axes:
    """Draw a plan, in source px; numbers are in how many of 100 runs a stone falls."""
    planned = {block: corners for group in card.groups for block, corners in group}
    regions = polygon_regions(planned)
    x0, y0, x1, y1 = regions_box([region.loops for region in regions])
    pad = 0.03 * (y1 - y0)
    box = x0 - pad, min(y0, 0.0) - 2 * pad, x1 + pad, y1 + pad
    items: list[Drawable] = [*ground(box)]
    for region in regions:
        risk = card.risk.get(region.id)
        fill = PALE if risk is None else risk_colour(risk)
        area = Surface(f"block-{region.id}", region.loops, fill)
        items.append(area)
        if risk:
            text = f"{100 * risk:.0f}"
            items.append(Words(f"risk-{region.id}", text, region.centroid, area.room, fill))
    legend = {
        "never falls": Surface("", (), SURE),
        "in half of the runs": Surface("", (), UNSURE),
        "always": Surface("", (), FALLS),
    }
    title = f"Stones that fall, of 100 rehearsals; {card.verdict}"
    return draw(Drawing(tuple(items), box, title=title, legend=legend), ax)


def risk_colour(risk: float) -> str:
    """Return the colour of a risk in [0, 1]."""
    low, high, share = (SURE, UNSURE, 2 * risk) if risk < 0.5 else (UNSURE, FALLS, 2 * risk - 1)
    mixed = (a + share * (b - a) for a, b in zip(rgb(low), rgb(high), strict=True))
    return "#" + "".join(f"{round(255 * part):02x}" for part in mixed)
