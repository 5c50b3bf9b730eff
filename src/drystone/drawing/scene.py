"""A pale wall to draw contacts and forces on."""

from collections.abc import Iterable, Sequence

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.transforms import ScaledTranslation

from drystone.drawing.canvas import draw_block, draw_ground, fit_axes
from drystone.drawing.outlines import Loop, Region, regions_box, stands_on_ground
from drystone.drawing.palette import GREY
from drystone.statics.model import RigidBlockModel

PALE = "#efece6"
FIXED = "#c9c9c9"


def wall_size(regions: Iterable[Region]) -> float:
    """Return the height of a wall, or a fifth of its length if that is more."""
    x0, y0, x1, y1 = regions_box(region.loops for region in regions)
    return max(y1 - y0, 0.2 * (x1 - x0))


def pale_wall(
    regions: Sequence[Region],
    model: RigidBlockModel,
    ax: Axes | None,
    reach: Sequence[Loop] = (),
) -> Axes:
    """Draw the blocks of a wall pale, and the fixed ones grey.

    Parameters
    ----------
    regions : sequence of Region
        From :func:`drystone.drawing.outlines.wall_regions`.
    model : RigidBlockModel
        Of this wall.
    ax : Axes or None
        Where to draw; None makes a figure.
    reach : sequence of (n, 2) float arrays
        Points that must be in view as well.

    Returns
    -------
    ax : Axes
        Wall frame: y = 0 is the ground of the model.

    Raises
    ------
    ValueError
        When the model has a block that the wall does not have.
    """
    missing = sorted({block.id for block in model.blocks} - {region.id for region in regions})
    if missing:
        raise ValueError(f"the model has blocks that the wall lacks: {missing}")
    size = wall_size(regions)
    pad, depth = 0.04 * size, 0.06 * size
    x0, y0, x1, y1 = regions_box((region.loops for region in regions), [reach])
    grounded = stands_on_ground(regions)
    bottom = min(y0 - 0.01 * size, -depth if grounded else y0 - pad)
    ax = fit_axes(ax, (x0 - pad, bottom, x1 + pad, y1 + pad))
    ax.set_axis_off()
    if grounded:
        draw_ground(ax, x0 - pad, x1 + pad, depth)
    fixed = {block.id for block in model.blocks if block.fixed}
    for region in regions:
        fill = FIXED if region.id in fixed else PALE
        draw_block(ax, region.loops, f"block-{region.id}", fill=fill, edgecolor=GREY, linewidth=0.4)
    return ax


def legend_below(ax: Axes, handles: Sequence[Line2D], down_pt: float = 5.0) -> None:
    """Write what lines and dots mean in a row under the axes."""
    ax.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=ax.transAxes + points_down(ax, down_pt),
        ncols=len(handles),
        fontsize=7,
        frameon=False,
        borderaxespad=0.0,
        handlelength=1.6,
        columnspacing=1.4,
    )


def points_down(ax: Axes, points: float) -> ScaledTranslation:
    """Return the transform that moves by some points (1/72 inch) down the page."""
    return ScaledTranslation(0.0, -points / 72.0, ax.figure.dpi_scale_trans)
