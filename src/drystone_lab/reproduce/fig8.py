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
from drystone.kernels.spots import eq12_merits
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels
from drystone_lab.pictures.walls import plot_landscape
from drystone_lab.reproduce.construction import Moment, amid_course, construction
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
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
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
    ax: Axes,
    labels: Labels,
    posed: PosedStone,
    positions: Positions,
    values: NDArray[np.floating],
    chosen: tuple[int, int],
) -> None:
    """Draw what positions of a stone are worth, and the stone where it was put.

    `positions` (n, 2) and `chosen` are rows and columns of the mask's top-left corner.
    """
    plot_landscape(ax, labels, BUILT, edgecolor=OUTLINE_COLOUR, linewidth=0.3)
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    height = labels.shape[0]
    stone = np.zeros(labels.shape, np.uint32)
    row, col = chosen
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    (region,) = label_regions(stone)
    draw_block(ax, region.loops, "chosen", fill="#ffffff", linewidth=1.4, zorder=2)
    x = positions[:, 1] + posed.anchor[0]
    y = height - positions[:, 0] - posed.height_px + posed.anchor[1]
    drawn = ax.scatter(x, y, c=values, cmap="cividis", s=4, marker="s", linewidths=0, zorder=3,
                       gid="values")  # fmt: skip
    at = (col + posed.anchor[0], height - row - posed.height_px + posed.anchor[1])
    ax.plot(*at, "x", color=FREE, markersize=7, markeredgewidth=2, zorder=4, gid="best")
    bar = ax.figure.colorbar(drawn, ax=ax, fraction=0.02, pad=0.01)
    bar.set_label("LFR + H(GDS) - $x_c$/w", size=7)
    bar.ax.tick_params(labelsize=6, length=2)


FREE, FLOATING, TOUCHING = "#d55e00", "#0072b2", "#cc79a7"
"""The paper's red, blue and pink in Okabe and Ito's colours, apart for colour-blind readers."""


@dataclass(frozen=True, eq=False)
class PositionMaps:
    """All positions of a stone on a landscape, by row and column of its mask's top-left corner."""

    free: Mask  # No pixel overlaps
    # None would overlap the landscape, with the bounds of the wall, dilated by one pixel
    floating: Mask

    @classmethod
    def of(cls, occupied: Mask, mask: Mask) -> "PositionMaps":
        """Find them as the paper does, by convolution.

        The landscape (L_0 of the paper) has bounds on all four sides (Fig. 4b).
        """
        dilated = ndimage.binary_dilation(occupied, border_value=1)
        overlaps = (
            signal.correlate(picture.astype(float), mask.astype(float), "valid", "fft")
            for picture in (occupied, dilated)
        )
        return cls(*(np.rint(pixels) == 0 for pixels in overlaps))

    @property
    def touching(self) -> Mask:
        """The paper's feasible positions: the difference of both."""
        return self.free & ~self.floating


@dataclass(frozen=True, eq=False)
class PositionTrial:
    """A stone on a landscape, and where the rule of placement puts it."""

    wall: Target
    moment: Moment
    posed: PosedStone
    chosen: tuple[int, int]

    @cached_property
    def maps(self) -> PositionMaps:
        """The paper's positions."""
        return PositionMaps.of(self.moment.wall.occupied, self.posed.mask)

    @property
    def built(self) -> int:
        """Stones of the landscape."""
        return len(self.moment.wall.placements)

    @cached_property
    def resting(self) -> Positions:
        """Where it rests on something from below."""
        return self.moment.positions(self.posed)

    @cached_property
    def touching(self) -> Positions:
        """Where it touches something."""
        return np.argwhere(self.maps.touching).astype(np.int64)

    def values(self, positions: Positions) -> NDArray[np.float64]:
        """Return Eq. 12 at some positions."""
        landscape, posed = self.moment.landscape, self.posed
        built, beta = landscape.built_height_px, self.moment.settings.placement.beta
        return eq12_merits(
            positions, posed.silhouette, landscape.rays, built, posed.anchor[0], beta
        )


def trial(context: Context, wall: Target = PR) -> PositionTrial:
    """Find the positions of a stone of the run on what was built before it."""
    moment, place = amid_course(construction(context, wall))
    found = moment.trial(place.posed.stone.id)
    if found is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    return PositionTrial(wall, moment, found[0], found[1:])


def _positions(found: PositionTrial) -> Rows:
    maps = found.maps
    yield "all inside the wall", maps.free.size, None, None, None
    yield "no overlap (red)", int(maps.free.sum()), None, None, None
    yield "floating (blue)", int(maps.floating.sum()), None, None, None
    for name, positions in (
        ("touching: the difference (pink)", found.touching),
        ("resting on something from below", found.resting),
        ("chosen", np.array([found.chosen], np.int64)),
    ):
        # The place of the largest value; of equal ones the lower, then the left one.
        values = found.values(positions)
        best = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))[0]
        row, col = positions[best].tolist()
        bottom = found.moment.landscape.height_px - row - found.posed.height_px
        yield name, len(positions), col, bottom, round(float(values[best]), 4)


def _drawn(found: PositionTrial) -> ItemFigure:
    posed, maps, resting = found.posed, found.maps, found.resting
    labels = found.moment.wall.labels
    figure = Figure(figsize=(7.2, 7.05), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    bearing = np.zeros_like(maps.free)
    bearing[resting[:, 0], resting[:, 1]] = True
    apart = (
        ("no overlap", FREE, maps.free),
        ("floating: no overlap when dilated", FLOATING, maps.floating),
    )
    near = (
        ("touching: the difference", TOUCHING, maps.touching),
        ("resting on something from below", "#000000", bearing),
    )
    plot_position_layers(first, labels, posed, apart)
    plot_position_layers(second, labels, posed, near)
    plot_position_values(third, labels, posed, resting, found.values(resting), found.chosen)
    return ItemFigure("fig8", figure)


def _claims(found: PositionTrial) -> Iterator[Claimed]:
    resting, touching = found.resting, len(found.touching)
    inside = int(np.count_nonzero(found.maps.touching[resting[:, 0], resting[:, 1]]))
    values = {"inside": inside, "resting": len(resting), "more": touching - inside}
    yield Claimed("difference", inside == len(resting) == touching, values)


POSITIONS = PaperItem(
    study=trial,
    claims=_claims,
    tables={"positions": _positions},
    pictures=lambda found: [_drawn(found)],
)
