"""Fig. 8: the feasible positions of a stone by two convolutions, and the best (§3.6)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.drawing.canvas import draw_block, draw_ground, fit_axes
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import GREY, OUTLINE_COLOUR
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.spots import eq12_merits
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels
from drystone_lab.reproduce.cells import ClaimCheck
from drystone_lab.reproduce.construction import Moment, amid_course, construction
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.table import Cell, Table
from drystone_lab.walls import PR, Target

BUILT = "#dedad2"
OPACITY = 0.85
VALUES = "cividis"
"""Colour map of values: even in lightness, the same for colour-blind readers."""


@dataclass(frozen=True, eq=False)
class Layer:
    """A set of positions of a mask."""

    positions: Mask  # By row and column of the mask's top-left corner
    colour: str
    label: str


def plot_position_layers(
    labels: Labels, posed: PosedStone, layers: Sequence[Layer], ax: Axes | None = None
) -> Axes:
    """Draw sets of positions of a stone as areas; a position is where its centroid is."""
    ax = _landscape(labels, ax)
    height = labels.shape[0]
    x, y = posed.anchor
    for layer in layers:
        rows, cols = layer.positions.shape
        image = np.zeros((rows, cols, 4))
        image[layer.positions] = to_rgba(layer.colour, OPACITY)
        top = height - posed.height_px + y + 0.5
        ax.imshow(image, extent=(x - 0.5, x + cols - 0.5, top - rows, top), zorder=3,
                  interpolation="nearest", gid=f"layer-{layer.label}")  # fmt: skip
    _show_all(ax, labels)
    handles = [Patch(facecolor=to_rgba(one.colour, OPACITY), label=one.label) for one in layers]
    ax.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(layers),
              fontsize=7, frameon=False, borderaxespad=0.1, handlelength=1.0)  # fmt: skip
    return ax


def plot_position_values(
    labels: Labels,
    posed: PosedStone,
    positions: Positions,
    values: NDArray[np.floating],
    chosen: tuple[int, int],
    ax: Axes | None = None,
) -> Axes:
    """Draw what positions of a stone are worth, and the stone where it was put.

    `positions` (n, 2) and `chosen` are rows and columns of the mask's top-left corner.
    """
    ax = _landscape(labels, ax)
    height = labels.shape[0]
    stone = np.zeros(labels.shape, np.uint32)
    row, col = chosen
    stone[row : row + posed.height_px, col : col + posed.width_px] = posed.mask
    (region,) = label_regions(stone)
    draw_block(ax, region.loops, "chosen", fill="#ffffff", linewidth=1.4, zorder=2)
    x = positions[:, 1] + posed.anchor[0]
    y = height - positions[:, 0] - posed.height_px + posed.anchor[1]
    drawn = ax.scatter(x, y, c=values, cmap=VALUES, s=4, marker="s", linewidths=0, zorder=3,
                       gid="values")  # fmt: skip
    at = (col + posed.anchor[0], height - row - posed.height_px + posed.anchor[1])
    ax.plot(*at, "x", color="#d55e00", markersize=7, markeredgewidth=2, zorder=4, gid="best")
    bar = ax.figure.colorbar(drawn, ax=ax, fraction=0.02, pad=0.01)
    bar.set_label("LFR + H(GDS) - $x_c$/w", size=7)
    bar.ax.tick_params(labelsize=6, length=2)
    _show_all(ax, labels)
    return ax


def _landscape(labels: Labels, ax: Axes | None) -> Axes:
    height, width = labels.shape
    depth = _depth(labels)
    ax = fit_axes(ax, (-2.0, -depth, width + 2.0, height + 2.0))
    draw_ground(ax, -2.0, width + 2.0, depth)
    ax.add_patch(Rectangle((0, 0), width, height, fill=False, edgecolor=GREY, linewidth=0.6,
                           linestyle=(0, (5, 4)), gid="frame"))  # fmt: skip
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=BUILT, edgecolor=OUTLINE_COLOUR,
                   linewidth=0.3)  # fmt: skip
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    return ax


def _depth(labels: Labels) -> float:
    height, width = labels.shape
    return float(0.04 * max(height, 0.2 * width))


def _show_all(ax: Axes, labels: Labels) -> None:
    """Show the whole site: an image or dots would take the limits of the axes for their own."""
    height, width = labels.shape
    ax.set_xlim(-2.0, width + 2.0)
    ax.set_ylim(-_depth(labels), height + 2.0)
    ax.set_aspect("equal")


FREE, FLOATING, TOUCHING = "#d55e00", "#0072b2", "#cc79a7"
"""The paper's red, blue and pink in Okabe and Ito's colours, apart for colour-blind readers."""

PANEL_IN = (7.2, 2.35)


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
        bounded = np.pad(occupied, 1, constant_values=True)
        dilated = ndimage.binary_dilation(bounded)[1:-1, 1:-1]
        return cls(_overlap(occupied, mask) == 0, _overlap(dilated, mask) == 0)

    @property
    def touching(self) -> Mask:
        """The paper's feasible positions: the difference of both."""
        return self.free & ~self.floating


def _overlap(picture: Mask, mask: Mask) -> NDArray[np.int64]:
    """Return how many pixels overlap at each position."""
    counts = signal.correlate(picture.astype(float), mask.astype(float), "valid", "fft")
    return np.asarray(np.rint(counts), np.int64)


@dataclass(frozen=True, eq=False)
class PositionTrial:
    """A stone of a run on what was built before it: its positions, and the one that is tried."""

    wall: Target
    moment: Moment
    posed: PosedStone
    chosen: tuple[int, int]

    @cached_property
    def maps(self) -> PositionMaps:
        """The paper's positions."""
        return PositionMaps.of(self.moment.wall.occupied, self.posed.mask)

    @cached_property
    def resting(self) -> Positions:
        """Where it rests on something from below."""
        return self.moment.positions(self.posed)

    def values(self, positions: Positions) -> NDArray[np.float64]:
        """Return Eq. 12 at some positions."""
        landscape, posed = self.moment.landscape, self.posed
        built, beta = landscape.built_height_px, self.moment.settings.placement.beta
        return eq12_merits(
            positions, posed.silhouette, landscape.rays, built, posed.anchor[0], beta
        )

    @cached_property
    def touching(self) -> Positions:
        """Where it touches something."""
        return np.argwhere(self.maps.touching).astype(np.int64)


def trial(context: Context, wall: Target = PR) -> PositionTrial:
    """Find the positions of a stone of the run on what was built before it."""
    spec = wall.run(context.seed)
    moment, place = amid_course(construction(context, spec))
    found = moment.trial(place.posed.stone.id)
    if found is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    return PositionTrial(wall, moment, found[0], found[1:])


def _table(found: PositionTrial) -> Table:
    posed, maps, height = found.posed, found.maps, found.moment.landscape.height_px
    value = float(found.values(np.array([found.chosen], np.int64))[0])
    sets: list[tuple[str, int, tuple[int, int, float] | None]] = [
        ("all inside the wall", maps.free.size, None),
        ("no overlap (red)", int(maps.free.sum()), None),
        ("floating (blue)", int(maps.floating.sum()), None),
        ("touching: the difference (pink)", len(found.touching), _best(found, found.touching)),
        ("resting on something from below", len(found.resting), _best(found, found.resting)),
        ("chosen", 1, (*found.chosen, value)),
    ]
    rows: list[tuple[Cell, ...]] = []
    for name, count, at in sets:
        told: tuple[Cell, ...] = (None, None, None)
        if at is not None:
            told = (at[1], height - at[0] - posed.height_px, round(at[2], 4))
        rows.append((name, count, *told))
    return Table(
        f"Positions of stone {posed.stone.id}, {posed.width_px} x {posed.height_px} working px",
        ("positions", "count", "best: left px", "best: bottom px", "best: Eq. 12"),
        tuple(rows),
    )


def _best(found: PositionTrial, positions: Positions) -> tuple[int, int, float]:
    """Return the position of the largest value; of equal ones the lower, then the left one."""
    values = found.values(positions)
    order = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))
    row, col = positions[order[0]].tolist()
    return row, col, float(values[order[0]])


def _drawn(found: PositionTrial) -> ItemPicture:
    moment, posed, maps, resting = found.moment, found.posed, found.maps, found.resting
    figure = Figure(figsize=(PANEL_IN[0], 3 * PANEL_IN[1]), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    labels = moment.wall.labels
    bearing = np.zeros_like(maps.free)
    bearing[resting[:, 0], resting[:, 1]] = True
    free = Layer(maps.free, FREE, "no overlap")
    floating = Layer(maps.floating, FLOATING, "floating: no overlap when dilated")
    plot_position_layers(labels, posed, (free, floating), first)
    touching = Layer(maps.touching, TOUCHING, "touching: the difference")
    rests = Layer(bearing, "#000000", "resting on something from below")
    plot_position_layers(labels, posed, (touching, rests), second)
    plot_position_values(labels, posed, resting, found.values(resting), found.chosen, third)
    return ItemPicture(
        "fig8", figure,
        f"Positions of stone {posed.stone.id} on {len(moment.wall.placements)} stones of "
        f"{found.wall.name}, each drawn where the stone's centroid would be. Top: no overlap, and "
        "of these floating. Middle: the difference, and of it resting on something from below. "
        "Bottom: Eq. 12 at the resting positions, and the stone at the best (cross).",
    )  # fmt: skip


def _claims(found: PositionTrial) -> Iterator[ClaimCheck]:
    resting = found.resting
    inside = int(np.count_nonzero(found.maps.touching[resting[:, 0], resting[:, 1]]))
    yield ClaimCheck(
        "The difference of both convolutions gives the feasible positions.",
        f"it holds {inside} of the {len(resting)} at which the stone rests on something, and "
        f"{len(found.touching) - inside} more.",
        inside == len(resting) == len(found.touching),
    )


POSITIONS = PaperItem(
    **paper("fig8"),
    study=trial,
    claims=_claims,
    tables={"positions": _table},
    pictures=lambda found: (_drawn(found),),
    needs=(PR.source.name,),
)
