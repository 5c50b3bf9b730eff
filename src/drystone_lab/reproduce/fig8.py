"""Fig. 8: the feasible positions of a stone by two convolutions, and the best (§3.6)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.drawing.canvas import draw_block
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.spots import Eq12, eq12_merits
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels
from drystone_lab.pictures.walls import plot_landscape
from drystone_lab.reproduce.construction import RestingPlace, amid_course, construction
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem, Rows
from drystone_lab.walls import PR, Target

BUILT = "#dedad2"
OPACITY = 0.85


def plot_position_layers(
    ax: Axes, labels: Labels, posed: PosedStone, layers: Sequence[tuple[str, str, Mask]]
) -> None:
    """Draw sets of positions of a stone as areas; a position is where its centroid is.

    A layer is label, colour, and positions by row and column of the mask's top-left corner.
    """
    plot_landscape(ax, labels, BUILT, edgecolor=OUTLINE_COLOUR, linewidth=0.3)
    height = labels.shape[0]
    x, y = posed.anchor
    for label, colour, positions in layers:
        rows, cols = positions.shape
        image = np.zeros((rows, cols, 4))
        image[positions] = to_rgba(colour, OPACITY)
        top = height - posed.height_px + y + 0.5
        ax.imshow(image, extent=(x - 0.5, x + cols - 0.5, top - rows, top), zorder=3,
                  interpolation="nearest", gid=f"layer-{label}")  # fmt: skip
    handles = [
        Patch(facecolor=to_rgba(colour, OPACITY), label=label) for label, colour, _ in layers
    ]
    ax.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(layers),
              fontsize=7, frameon=False, borderaxespad=0.1, handlelength=1.0)  # fmt: skip


def plot_position_values(
    ax: Axes, place: RestingPlace, positions: Positions, values: NDArray[np.floating]
) -> None:
    """Draw what positions of a stone are worth, and the stone where it was put.

    `positions` (n, 2) are rows and columns of the mask's top-left corner.
    """
    labels, posed = place.moment.wall.labels, place.posed
    plot_landscape(ax, labels, BUILT, edgecolor=OUTLINE_COLOUR, linewidth=0.3)
    (region,) = label_regions(place.pixels.astype(np.uint32))
    draw_block(ax, region.loops, "chosen", fill="#ffffff", linewidth=1.4, zorder=2)
    rows, cols = np.vstack([positions, [place.row, place.col]]).T
    x = cols + posed.anchor[0]
    y = labels.shape[0] - rows - posed.height_px + posed.anchor[1]
    drawn = ax.scatter(x[:-1], y[:-1], c=values, cmap="cividis", s=4, marker="s", linewidths=0,
                       zorder=3, gid="values")  # fmt: skip
    ax.plot(x[-1], y[-1], "x", color=FREE, markersize=7, markeredgewidth=2, zorder=4, gid="best")
    bar = ax.figure.colorbar(drawn, ax=ax, fraction=0.02, pad=0.01)
    bar.set_label("LFR + H(GDS) - $x_c$/w", size=7)
    bar.ax.tick_params(labelsize=6, length=2)


FREE, FLOATING, TOUCHING = "#d55e00", "#0072b2", "#cc79a7"
"""The paper's red, blue and pink in Okabe and Ito's colours, apart for colour-blind readers."""


def position_maps(occupied: Mask, mask: Mask) -> tuple[Mask, Mask]:
    """Return at which positions of a stone nothing overlaps, and which of them float.

    By row and column of its mask's top-left corner.  As the paper does it, by convolution: with the
    landscape, and with the landscape dilated by one pixel, bounds and all.  The landscape (L_0 of
    the paper) has bounds on all four sides (Fig. 4b).
    """
    dilated = ndimage.binary_dilation(occupied, border_value=1)
    overlaps = (
        signal.correlate(picture.astype(float), mask.astype(float), "valid", "fft")
        for picture in (occupied, dilated)
    )
    free, floating = (np.rint(pixels) == 0 for pixels in overlaps)
    return free, floating


@dataclass(frozen=True, eq=False)
class PositionTrial:
    """A stone on a landscape, where the rule of placement puts it."""

    wall: Target
    place: RestingPlace

    @cached_property
    def maps(self) -> tuple[Mask, Mask, Mask]:
        """The paper's positions: free, floating, and touching, the difference of both."""
        free, floating = position_maps(self.place.moment.wall.occupied, self.place.posed.mask)
        return free, floating, free & ~floating

    @property
    def built(self) -> int:
        """Stones of the landscape."""
        return len(self.place.moment.wall.placements)

    @cached_property
    def resting(self) -> Positions:
        """Where it rests on something from below."""
        return self.place.moment.positions(self.place.posed)

    def values(self, positions: Positions) -> NDArray[np.float64]:
        """Return Eq. 12 at some positions."""
        moment, posed = self.place.moment, self.place.posed
        landscape, beta = moment.landscape, moment.settings.placement.beta
        eq12 = Eq12(landscape.built_height_px, posed.anchor[0], beta)
        return eq12_merits(positions, posed.silhouette, landscape.rays, eq12)


def trial(context: Context, wall: Target = PR) -> PositionTrial:
    """Find the positions of a stone of the run on what was built before it."""
    place = amid_course(construction(context, wall))
    found = place.moment.trial(place.posed.stone.id)
    if found is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    return PositionTrial(wall, RestingPlace(place.moment, *found))


def _positions(found: PositionTrial) -> Rows:
    place, (free, floating, touching) = found.place, found.maps
    yield "all inside the wall", free.size, None, None, None
    yield "no overlap (red)", int(free.sum()), None, None, None
    yield "floating (blue)", int(floating.sum()), None, None, None
    for name, positions in (
        ("touching: the difference (pink)", np.argwhere(touching).astype(np.int64)),
        ("resting on something from below", found.resting),
        ("chosen", np.array([(place.row, place.col)], np.int64)),
    ):
        # The place of the largest value; of equal ones the lower, then the left one.
        values = found.values(positions)
        best = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))[0]
        row, col = positions[best].tolist()
        bottom = place.moment.landscape.height_px - row - place.posed.height_px
        yield name, len(positions), col, bottom, round(float(values[best]), 4)


def _drawn(found: PositionTrial) -> ItemFigure:
    place, resting, (free, floating, touching) = found.place, found.resting, found.maps
    figure = Figure(figsize=(7.2, 7.05), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    bearing = np.zeros_like(free)
    bearing[resting[:, 0], resting[:, 1]] = True
    apart = (
        ("no overlap", FREE, free),
        ("floating: no overlap when dilated", FLOATING, floating),
    )
    near = (
        ("touching: the difference", TOUCHING, touching),
        ("resting on something from below", "#000000", bearing),
    )
    for ax, layers in ((first, apart), (second, near)):
        plot_position_layers(ax, place.moment.wall.labels, place.posed, layers)
    plot_position_values(third, place, resting, found.values(resting))
    return ItemFigure("fig8", figure)


def _claims(found: PositionTrial) -> Iterator[Claimed]:
    resting, (*_, touching) = found.resting, found.maps
    inside, count = int(touching[resting[:, 0], resting[:, 1]].sum()), int(touching.sum())
    values = {"inside": inside, "resting": len(resting), "more": count - inside}
    yield Claimed("difference", inside == len(resting) == count, values)


POSITIONS = PaperItem(
    study=trial,
    claims=_claims,
    tables={"positions": _positions},
    pictures=lambda found: [_drawn(found)],
)
