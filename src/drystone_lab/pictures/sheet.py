"""Pictures of several scales in rows on one sheet, each with a title."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

FIGURE_IN = 11.0
"""Width of the sheet where that leaves room for its panels."""

NARROWEST_IN = 3.2
"""Width of a panel at least."""

LEFT_IN, BELOW_IN = 0.4, 0.38
"""Beside a panel and below it, for its ticks."""

LINE_IN, ABOVE_IN = 0.16, 0.12
"""Above it: a line of its title, and some room."""

TITLE_PT = 8


@dataclass(frozen=True, eq=False)
class Panel:
    """A picture on a sheet.

    Parameters
    ----------
    title : str
        Written above, in lines, or "".
    aspect : float
        Height over width of what is drawn.
    draw : callable
        Draws it on axes; without it the place stays empty.
    """

    title: str
    aspect: float
    draw: Callable[[Axes], object] | None


EMPTY = Panel("", 0.0, None)
"""A place without a picture."""


def sheet_of(panels: Sequence[Panel], columns: int) -> Figure:
    """Draw panels in rows, all of one width.

    Parameters
    ----------
    panels : sequence of Panel
        At least one.
    columns : int
        Panels in a row.

    Returns
    -------
    Figure
        An axes a panel that is not empty, in their order, without legends: one below every small
        picture would say the same again and again.

    Raises
    ------
    ValueError
        There is no panel, or no column.

    Examples
    --------
    >>> figure = sheet_of([Panel("a", 0.5, lambda ax: ax.plot([1, 2])), EMPTY], 2)
    >>> [ax.get_title(loc="left") for ax in figure.axes]
    ['a']
    """
    if not panels or columns < 1:
        raise ValueError("there must be a panel and a column")
    columns = min(columns, len(panels))
    across = max(NARROWEST_IN, FIGURE_IN / columns - LEFT_IN)
    rows = [panels[first : first + columns] for first in range(0, len(panels), columns)]
    above = [ABOVE_IN + LINE_IN * max(len(p.title.splitlines()) for p in row) for row in rows]
    tall = [across * max(panel.aspect for panel in row) for row in rows]
    width = columns * (across + LEFT_IN)
    height = sum(above) + sum(tall) + BELOW_IN * len(rows)
    figure = Figure(figsize=(width, height))
    bottom = height
    for row, up, high in zip(rows, above, tall, strict=True):
        bottom -= up + high
        for column, panel in enumerate(row):
            left = LEFT_IN + column * (across + LEFT_IN)
            box = (left / width, bottom / height, across / width, high / height)
            _draw(figure, box, panel)
        bottom -= BELOW_IN
    return figure


def _draw(figure: Figure, box: tuple[float, float, float, float], panel: Panel) -> None:
    if panel.draw is None:
        return
    ax = figure.add_axes(box)
    # Pictures lower than their row hang from its title.
    ax.set_anchor("NW")
    panel.draw(ax)
    legend = ax.get_legend()
    if legend is not None:
        legend.remove()
    ax.tick_params(labelsize=6)
    ax.set_title(panel.title, fontsize=TITLE_PT, loc="left", pad=3)
