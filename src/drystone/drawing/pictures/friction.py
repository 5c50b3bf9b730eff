"""The load multiplier over the coefficient of friction."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.drawing.palette import CLUSTER_COLOURS, GREY
from drystone.statics.sensitivity import AtFriction

LEFT, RIGHT = CLUSTER_COLOURS[0], CLUSTER_COLOURS[1]


def plot_friction(
    curve: Sequence[AtFriction],
    mu: float | None = None,
    ax: Axes | None = None,
    *,
    slides_at_mu: bool = True,
) -> Axes:
    """Draw what a wall carries in both directions at several coefficients of friction, ascending.

    Where there is no load multiplier the line is broken.  `mu` is the coefficient of the analysis,
    marked.  On a level tilting table the whole wall slides at a load multiplier of mu; that is
    drawn too.
    """
    if ax is None:
        ax = Figure(figsize=(4.2, 2.9), layout="constrained").add_subplot()
    mus = [at.mu for at in curve]
    if slides_at_mu:
        words = "the whole wall slides"
        ax.plot(mus, mus, color=GREY, linestyle="dotted", linewidth=1.0, label=words)
    for name, colour, marker in (("left", LEFT, "<"), ("right", RIGHT, ">")):
        values = [getattr(at, f"alpha_{name}") for at in curve]
        drawn = [float("nan") if value is None else value for value in values]
        ax.plot(mus, drawn, color=colour, marker=marker, markersize=5, label=f"to the {name}")
    if mu is not None:
        ax.axvline(mu, color=GREY, linewidth=0.8)
        ax.annotate(
            f"mu = {mu:g}", (mu, 0.02), xycoords=("data", "axes fraction"), fontsize=7,
            xytext=(3, 0), textcoords="offset points",
        )  # fmt: skip
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("coefficient of friction", fontsize=8)
    ax.set_ylabel("load multiplier", fontsize=8)
    ax.tick_params(labelsize=7)
    ax.legend(fontsize=7, frameon=False)
    ax.spines[["top", "right"]].set_visible(False)
    return ax
