"""Walls of runs as panels, with their figures in the titles."""

from collections.abc import Mapping

from drystone_lab.pictures.wall_grid import TitledWall
from drystone_lab.reproduce.item import Context
from drystone_lab.reproduce.trials import Trials

WRITTEN = {"F_SF": ".3f", "F_AV": ".1f", "F_AH": ".2f", "F_LR": ".2f"}


def titled_wall(context: Context, trials: Trials, title: str, which: int = 0) -> TitledWall:
    """Return one wall of some trials for :func:`drystone_lab.pictures.wall_grid.plot_walls`.

    Parameters
    ----------
    context : Context
        With the folder of the published data.
    trials : Trials
        The walls.
    title : str
        First line; the second are the wall's figures.
    which : int
        Place of the seed.
    """
    figures = trials.outcomes[which].figures
    placed = f"{figures['placed']} of {figures['stones']} stones"
    return f"{title}: {placed}\n{in_words(figures)}", *trials.drawn(context, which)


def in_words(figures: Mapping[str, float | None]) -> str:
    """Write F_SF, F_AV, F_AH and F_LR in a line.

    Examples
    --------
    >>> in_words({"F_SF": 0.8123, "F_AV": 20.0, "F_AH": 2.345, "F_LR": None})
    'F_SF 0.812  F_AV 20.0  F_AH 2.35  F_LR -'
    """
    return "  ".join(
        f"{name} {'-' if figures[name] is None else format(figures[name], written)}"
        for name, written in WRITTEN.items()
    )
