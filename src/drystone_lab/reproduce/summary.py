"""Medians and ranges of the walls of several seeds, as cells of a row."""

from collections.abc import Sequence
from statistics import median

from drystone_lab.runs.outcome import Outcome
from drystone_lab.table import Cell

FORMATS = {"placed": ".0f", "F_SF": ".3f", "F_AV": ".1f", "F_AH": ".2f", "F_LR": ".2f"}
"""Figures of a summary, and how the ends of their ranges are written."""

COLUMNS = (
    "walls", "stones",
    *(f"{name}{end}" for name in FORMATS for end in (" median", " range")),
)  # fmt: skip
"""Names of the cells of :func:`summary`; the best of each figure is an end of its range."""

DIGITS = 4
"""Decimals of a number in a table, which all machines agree on."""

METRICS = ("F_SF", "F_AV", "F_AH", "F_LR")


def summary(outcomes: Sequence[Outcome]) -> tuple[Cell, ...]:
    """Return the cells of :data:`COLUMNS`.

    Parameters
    ----------
    outcomes : sequence of Outcome
        At least one, of the same stones.

    Returns
    -------
    tuple of cells
        Walls, stones in the set, then median and range of each figure over the walls that have
        it; None where no wall has.
    """
    cells: list[Cell] = [len(outcomes), outcomes[0].figures["stones"]]
    for name, written in FORMATS.items():
        found = figures_of(outcomes, name)
        cells.append(rounded(median(found)) if found else None)
        cells.append(f"{min(found):{written}} to {max(found):{written}}" if found else None)
    return tuple(cells)


def figures_of(outcomes: Sequence[Outcome], name: str) -> list[float]:
    """Return a figure of the walls that have it, in their order."""
    values = (outcome.figures[name] for outcome in outcomes)
    return [float(value) for value in values if value is not None]


def median_of(outcomes: Sequence[Outcome], name: str) -> float | None:
    """Return the median of a figure over the walls that have it; None when none has."""
    found = figures_of(outcomes, name)
    return median(found) if found else None


def metric_cells(outcome: Outcome) -> tuple[Cell, ...]:
    """Return F_SF, F_AV, F_AH and F_LR of a wall as cells of a table."""
    return tuple(rounded(outcome.figures[name]) for name in METRICS)


def rounded(value: float | None) -> float | None:
    """Return a number as tables hold it; an integer stays what it is."""
    return None if value is None else round(value, DIGITS)
