"""The load multiplier over friction, and of shaken walls."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from drystone.drawing.canvas import name_axes
from drystone.drawing.palette import CLUSTER_COLOURS, GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.kernels.raster import Floats
from drystone.statics.result import LimitStatus
from drystone.statics.scatter.scatter import Quantiles, Scatter
from drystone.statics.sensitivity import AtFriction

PANEL_IN = 3.2  # width and height of a panel
GAP = 0.28  # between panels, in widths of a panel
LEAST_SPAN = 0.02  # A histogram of equal values still shows this much
BARS = CLUSTER_COLOURS[0]

_Style = dict[str, Any]

_QUANTILE: _Style = {"linestyle": (0, (4, 3)), "linewidth": 0.9}
_UNSHAKEN: _Style = {"marker": "D", "markersize": 5, "color": WEDGE_COLOUR, "linestyle": "none"}
_FALLING: _Style = {"marker": "x", "markersize": 4, "color": OUTLINE_COLOUR, "linestyle": "none"}
_SLIDING: _Style = {"linestyle": "dotted", "linewidth": 1.0, "color": GREY}


def plot_scatter(scatter: Scatter, ax: Axes | None = None) -> Axes:
    """Draw what the shaken walls carry, beside each other in the place of one picture.

    Histograms of min alpha and of F_LR with their quantiles, and min alpha against friction when
    it was varied.  Above stands in words what was shaken and how many walls do not stand.  The
    panels are ``child_axes`` of the axes.
    """
    alpha, shaken = scatter.unshaken, len(scatter.alpha) > 0
    unshaken = None
    if alpha.left.alpha is not None and alpha.right.alpha is not None:
        unshaken = min(alpha.left.alpha, alpha.right.alpha)
    panels: list[Callable[[Axes], None]] = []
    if scatter.alpha_quantiles is not None:
        found = (scatter.alpha, scatter.alpha_quantiles, unshaken)
        panels.append(lambda ax: _histogram(ax, "min alpha", *found))
    if scatter.value is not None and scatter.value_quantiles is not None:
        values = (scatter.value, scatter.value_quantiles, alpha.value)
        panels.append(lambda ax: _histogram(ax, "F_LR = min alpha / mu", *values))
    if shaken and np.ptp(scatter.mu) > 0:
        panels.append(lambda ax: _against_friction(ax, scatter, unshaken))
    count = max(1, len(panels))
    widths = count + GAP * (count - 1)
    if ax is None:
        ax = Figure(figsize=(PANEL_IN * widths, PANEL_IN)).add_axes((0, 0, 1, 1))
    ax.set_axis_off()
    for number in range(count):
        left = number * (1 + GAP) / widths
        inset = ax.inset_axes((left, 0, 1 / widths, 1), gid=f"panel-{number + 1}")
        inset.tick_params(labelsize=7, length=2.5, width=0.5)
        for axis in (inset.xaxis, inset.yaxis):
            axis.set_major_locator(MaxNLocator(nbins=5, steps=[1, 2, 5, 10]))
        inset.spines[["top", "right"]].set_visible(False)
        inset.spines[["left", "bottom"]].set_linewidth(0.5)
        if panels:
            panels[number](inset)
        else:
            inset.set_axis_off()
            inset.text(0.5, 0.5, "no wall stands", transform=inset.transAxes, ha="center", size=9)
    ax.set_title("\n".join(_words(scatter)), fontsize=8, loc="left", pad=22)
    if shaken:
        _legend(ax)
    return ax


def _words(scatter: Scatter) -> list[str]:
    settings, counts = scatter.settings, scatter.counts
    shaken = []
    if settings.mu is not None:
        low, high = settings.mu
        each = " for each interface" if settings.mu_per_interface else ""
        shaken.append(f"friction {low:g} to {high:g}{each}")
    if settings.outline_noise:
        shaken.append(f"outlines by {settings.outline_noise:g}")
    if settings.placement_noise:
        shaken.append(f"places by {settings.placement_noise:g}")
    if settings.outline_noise or settings.placement_noise:
        shaken[-1] += " (lengths of the model)"
    lines = [f"{len(scatter.status)} walls, shaken: {', '.join(shaken) or 'nothing'}"]
    falling, share = counts[LimitStatus.UNSTABLE], scatter.falling_share
    if share is not None:
        said = f"{falling} of {scatter.known} ({100 * share:.3g} %) do not stand"
        said += " under their own weight"
        lines.append(said if falling else "All of them stand under their own weight")
    if counts[LimitStatus.FAILED]:
        lines[-1] += f"; the solver gave up on {counts[LimitStatus.FAILED]}"
    return lines


def _histogram(
    ax: Axes, name: str, values: Floats, quantiles: Quantiles, unshaken: float | None
) -> None:
    least, greatest = float(values.min()), float(values.max())
    pad = max(0.0, LEAST_SPAN - (greatest - least)) / 2
    bins = int(np.clip(np.sqrt(len(values)), 5, 40))
    reach = (least - pad, greatest + pad)
    ax.hist(values, bins=bins, range=reach, color=BARS, edgecolor="white", linewidth=0.4)
    for quantile, share in zip(quantiles, ("5", "50", "95"), strict=True):
        ax.axvline(quantile, color=OUTLINE_COLOUR, gid=f"quantile-{share}", **_QUANTILE)
    if unshaken is not None:
        ax.axvline(unshaken, color=WEDGE_COLOUR, linewidth=1.2, gid="unshaken")
    low, median, high = quantiles
    ax.set_title(f"5 %: {low:.3f}    50 %: {median:.3f}    95 %: {high:.3f}", fontsize=7, pad=4)
    ax.set_xlabel(name, fontsize=7)
    ax.set_ylabel("walls", fontsize=7)


def _against_friction(ax: Axes, scatter: Scatter, unshaken: float | None) -> None:
    ax.plot(scatter.standing_mu, scatter.alpha, ".", color=BARS, markersize=3, gid="walls")
    if unshaken is not None:
        ax.plot(scatter.unshaken.mu, unshaken, gid="unshaken-point", **_UNSHAKEN)
    falling = scatter.mu[[status is LimitStatus.UNSTABLE for status in scatter.status]]
    if len(falling):
        low = np.full(len(falling), 0.02)
        ax.plot(falling, low, transform=ax.get_xaxis_transform(), gid="falling", **_FALLING)
    ends = np.array([scatter.mu.min(), scatter.mu.max()])
    limits = ax.get_ylim()
    if ends[0] < limits[1]:
        ax.plot(ends, ends, gid="sliding", **_SLIDING)
        ax.set_ylim(limits)
    ax.set_xlabel("mu", fontsize=7)
    ax.set_ylabel("min alpha", fontsize=7)


def _legend(ax: Axes) -> None:
    drawn = {line.get_gid() for panel in ax.child_axes for line in panel.lines}
    entries: list[Patch | Line2D] = [
        Patch(color=BARS, label="walls that stand"),
        Line2D([], [], color=OUTLINE_COLOUR, label="quantiles", **_QUANTILE),
    ]
    styles = (("unshaken", "not shaken", {**_UNSHAKEN, "linestyle": "solid"}),
              ("falling", "does not stand", _FALLING),
              ("sliding", "alpha = mu: sliding", _SLIDING))  # fmt: skip
    entries += [
        Line2D([], [], label=label, **style) for gid, label, style in styles if gid in drawn
    ]
    ax.legend(
        handles=entries, loc="upper left", bbox_to_anchor=(0.0, -0.14), ncols=len(entries),
        fontsize=7, frameon=False, borderaxespad=0.0, columnspacing=1.4,
    )  # fmt: skip


def plot_friction(
    curve: Sequence[AtFriction],
    mu: float,
    *,
    slides_at_mu: bool = True,
    sides: tuple[str, str] = ("to the left", "to the right"),
) -> Axes:
    """Draw what a wall carries in both directions at several coefficients of friction, ascending.

    Where there is no load multiplier the line is broken.  `mu` is the coefficient of the analysis,
    marked.  On a level tilting table the whole wall slides at a load multiplier of mu, that of the
    ground; `slides_at_mu` draws that too.  `sides` are words for both directions.
    """
    ax = Figure(figsize=(4.2, 2.9), layout="constrained").add_subplot()
    mus = [at.mu for at in curve]
    if slides_at_mu:
        words = "the whole wall slides"
        ax.plot(mus, mus, color=GREY, linestyle="dotted", linewidth=1.0, label=words)
    for values, said, colour, marker in (
        ([at.alpha_left for at in curve], sides[0], CLUSTER_COLOURS[0], "<"),
        ([at.alpha_right for at in curve], sides[1], CLUSTER_COLOURS[1], ">"),
    ):
        drawn = [float("nan") if value is None else value for value in values]
        ax.plot(mus, drawn, color=colour, marker=marker, markersize=5, label=said)
    ax.axvline(mu, color=GREY, linewidth=0.8)
    ax.annotate(
        f"mu = {mu:g}", (mu, 0.02), xycoords=("data", "axes fraction"), fontsize=7,
        xytext=(3, 0), textcoords="offset points",
    )  # fmt: skip
    ax.set_ylim(bottom=0.0)
    name_axes(ax, "coefficient of friction", "load multiplier")
    ax.legend(fontsize=7, frameon=False)
    ax.spines[["top", "right"]].set_visible(False)
    return ax
