"""Figs. 6 and 7: what indices measure (§3.5); Fig. 8: where a stone may be put (§3.6)."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray
from scipy import ndimage, signal

from drystone.drawing.canvas import draw_block
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.indices import peak_columns, swept_pixels
from drystone.kernels.lowering import Positions
from drystone.kernels.raster import Mask
from drystone.kernels.spots import Eq12, eq12_merits
from drystone.model.landscape import Box
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels
from drystone.stabilise.stabilise import falls_to
from drystone_lab.cells import rounded
from drystone_lab.pictures import plot_landscape
from drystone_lab.reproduce.construction import Moment, RestingPlace, amid_course, construction
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.table import Cell, Rows
from drystone_lab.walls import PR, Target

NAMES = ("SF", "LFR", "GDS", "NHR", "IWR", "IS")

BUILT, LAID = "#e4e0d8", "#dedad2"
STONE, NEIGHBOUR, BELOW, RAYS, BEGUN = "#d55e00", "#009e73", "#56b4e9", "#f0e442", "#0072b2"
"""Okabe and Ito's colours, apart for colour-blind readers; roles as in Fig. 7."""


def plot_indices(place: RestingPlace, names: Collection[str], ax: Axes, title: str = "") -> None:
    """Draw a stone on the landscape with what some of its indices measure."""
    labels, landscape = place.moment.wall.labels, place.moment.landscape
    height, width = labels.shape
    fills: dict[int, str] = {}
    if "IWR" in names:
        fills |= {_id(place, box): BELOW for box in place.below if box is not None}
    if "NHR" in names and place.neighbour is not None:
        fills[_id(place, place.neighbour)] = NEIGHBOUR
    plot_landscape(ax, labels, BUILT, fills=fills)
    if "LFR" in names:
        # Pale where it is empty, stronger over what is filled.
        image = np.zeros((height, width, 4))
        swept = swept_pixels(landscape, place.posed, place.row, place.col)
        image[swept] = to_rgba(RAYS, 0.9)
        image[swept & (labels > 0)] = to_rgba("#a08500", 0.55)
        extent = (0, width, 0, height)
        ax.imshow(image, extent=extent, interpolation="nearest", zorder=2, gid="rays")
    (region,) = label_regions(place.pixels.astype(np.uint32))
    draw_block(ax, region.loops, "stone", fill=STONE, zorder=3)
    if "SF" in names:
        left, right, bottom, top = place.box
        ax.add_patch(Rectangle((left, bottom), right - left, top - bottom, fill=False, gid="box",
                               linewidth=1.0, edgecolor=OUTLINE_COLOUR, linestyle=(0, (2, 1.5)),
                               zorder=4))  # fmt: skip
    if "GDS" in names:
        ax.add_patch(Rectangle((0, 0), width, landscape.built_height_px, fill=False, gid="begun",
                               linewidth=1.6, edgecolor=BEGUN, zorder=4))  # fmt: skip
    if "NHR" in names and place.neighbour is not None:
        _draw_tops(ax, place.box, place.neighbour)
    if "IWR" in names:
        _draw_joints(ax, place)
    if "IS" in names and (peaks := peak_columns(place.posed)) is not None:
        x = [place.col + column + 0.5 for column in peaks]
        y = [height - place.row - int(place.posed.top[column]) for column in peaks]
        ax.plot(x, y, color=OUTLINE_COLOUR, gid="slope", marker="o", markersize=3.5, linewidth=1.2,
                zorder=5)  # fmt: skip
    if {"NHR", "IWR"} <= {*names}:
        _name_stones(ax, place)
    ax.set_title(title, fontsize=7, loc="left", pad=2)


def _id(place: RestingPlace, box: Box) -> int:
    """Return the id of the placed stone that has a box."""
    moment = place.moment
    return moment.wall.placements[moment.landscape.boxes.index(box)].stone_id


def _name_stones(ax: Axes, place: RestingPlace) -> None:
    below1, below2 = place.below
    named = {
        "left neighbour": place.neighbour, "below1": below1, "below2": below2, "stone": place.box,
    }  # fmt: skip
    told = {name: box for name, box in named.items() if box is not None}
    for name, (left, right, bottom, top) in told.items():
        ax.text(
            (left + right) / 2, (bottom + top) / 2, name, size=7, ha="center", va="center",
            zorder=6, gid="name", path_effects=[withStroke(linewidth=1.5, foreground="white")],
        )  # fmt: skip


def _draw_tops(ax: Axes, stone: Box, beside: Box) -> None:
    """Draw the heights of both tops, and how far they are apart."""
    ends = (min(stone.left, beside.left), max(stone.right, beside.right))
    for top in (stone.top, beside.top):
        ax.plot(ends, (top, top), color=OUTLINE_COLOUR, gid="top", linewidth=0.8,
                linestyle=(0, (4, 2)), zorder=4)  # fmt: skip
    middle = (ends[0] + ends[1]) / 2
    ax.plot((middle, middle), (stone.top, beside.top), color=OUTLINE_COLOUR, gid="difference",
            linewidth=2.0, zorder=5, solid_capstyle="butt")  # fmt: skip


def _draw_joints(ax: Axes, place: RestingPlace) -> None:
    """Draw how far the ends of the stone are from the joints below."""
    below1, below2 = place.below
    stone = place.box
    joints = [(stone.left, below1.right, below1.top)] if below1 is not None else []
    joints += [(stone.right, below2.left, below2.top)] if below2 is not None else []
    for x_end, x_joint, y_joint in joints:
        ax.plot((x_end, x_joint), (stone.bottom, stone.bottom), color=OUTLINE_COLOUR, gid="offset",
                linewidth=1.8, zorder=5, solid_capstyle="butt")  # fmt: skip
        ax.plot((x_joint, x_joint), (stone.bottom, y_joint), color=OUTLINE_COLOUR, linewidth=0.6,
                zorder=5)  # fmt: skip
        ax.plot((x_joint,), (y_joint,), color=OUTLINE_COLOUR, gid="joint", marker="o",
                markersize=3, zorder=5, linestyle="")  # fmt: skip


def recounted(place: RestingPlace, name: str) -> float | None:
    """Return an index counted in the label image; None where the picture does not show it.

    SF is that of the working pixels; the planner's is that of the source image.
    """
    posed, labels, stone = place.posed, place.moment.wall.labels, place.pixels
    found: float | None = None
    match name:
        case "SF":
            found = posed.mask.mean()
        case "LFR":
            swept = labels[swept_pixels(place.moment.landscape, posed, place.row, place.col)]
            found = (swept > 0).mean() if swept.size else 1.0
        case "GDS":
            built = np.zeros(labels.shape, bool)
            built[np.maximum.accumulate(labels.any(axis=1))] = True
            inside, both = np.count_nonzero(stone & built), np.count_nonzero(stone | built)
            found = np.count_nonzero(built) / np.count_nonzero(stone) * inside / both
        case "NHR" if place.neighbour is not None:
            (top, foot), (other, _) = _rows(stone), _rows(labels == _id(place, place.neighbour))
            found = abs(top - other) / (foot - top)
        case "IWR" if len(below := [box for box in place.below if box is not None]) == 2:
            left, right = _rows(stone.T)
            (start1, end1), (start2, end2) = (_rows((labels == _id(place, b)).T) for b in below)
            terms = (abs(left - end1) / (end1 - start1), abs(right - start2) / (end2 - start2))
            found = sum(min(1.0, term) for term in terms) / 2
        case "IS" if len({*(peaks := peak_columns(posed) or ())}) == 2:
            left, right = (place.col + column for column in peaks)
            fall = int(np.argmax(stone[:, right])) - int(np.argmax(stone[:, left]))
            side = np.sign(place.col + posed.anchor[0] - labels.shape[1] / 2)
            found = np.clip(fall / (left - right) * side, -1.0, 1.0)
    return None if found is None else float(found)


def _rows(pixels: Mask) -> tuple[int, int]:
    """Return the first row of some pixels and the row after the last."""
    rows = np.flatnonzero(pixels.any(axis=1))
    return int(rows[0]), int(rows[-1]) + 1


def resting_places(moment: Moment) -> tuple[RestingPlace, ...]:
    """Return every feasible position of every stone that is left at which it rests by itself."""
    occupied, settings = moment.wall.occupied, moment.settings.stabilise
    found = []
    for stone_id in moment.remaining:
        for posed in moment.workshop.poses(stone_id):
            found += [
                RestingPlace(moment, posed, row, col)
                for row, col in moment.positions(posed).tolist()
                if falls_to(occupied, (posed, row, col), settings) == 0
            ]
    return tuple(found)


@dataclass(frozen=True, eq=False)
class MomentPlaces:
    """A moment of a run, where stones that are left would rest, and a stone amid a course."""

    place: RestingPlace
    all: tuple[RestingPlace, ...]

    @property
    def cases(self) -> Iterator[tuple[str, str, RestingPlace]]:
        """The best and the worst place by each index: index, verdict and place.

        Of equal ones the lowest, then that furthest to the left, then that of the smaller id.
        """
        for name, verdict in product(NAMES, ("favourable", "unfavourable")):
            meant = [place for place in self.all if name in place.values]
            # NHR is best at 0, the others when they are large.
            sign = 1.0 if (name == "NHR") == (verdict == "favourable") else -1.0
            if meant:
                yield name, verdict, min(meant, key=lambda p: (sign * p.values[name], p.order))


def _cells(place: RestingPlace, name: str) -> tuple[Cell, ...]:
    """Return stone, place, an index, and the index counted again."""
    values = rounded(place.values[name]), rounded(recounted(place, name))
    return place.posed.stone.id, place.box.left, place.box.bottom, *values


def places(context: Context, wall: Target = PR) -> MomentPlaces:
    """Find the places of all stones that are left at a moment of a run."""
    place = amid_course(construction(context, wall))
    return MomentPlaces(place, resting_places(place.moment))


def _ranges(found: MomentPlaces) -> Rows:
    for name in NAMES:
        values = sorted(place.values[name] for place in found.all if name in place.values)
        if values:
            cells = (values[0], values[len(values) // 2], values[-1])
            yield name, len(values), *map(rounded, cells)


def _pictures(found: MomentPlaces) -> Iterator[ItemFigure]:
    cases = list(found.cases)
    rows = -(-len(cases) // 2)
    figure = Figure(figsize=(7.2, rows * 1.28), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False).ravel().tolist()
    for ax, (index, verdict, place) in zip(panels, cases, strict=True):
        title = f"{index} = {place.values[index]:.3f}, {verdict}: stone {place.posed.stone.id}"
        plot_indices(place, {index}, ax, title)
        ax.set_axis_off()
    yield ItemFigure("fig6", figure)
    place = found.place
    values = ", ".join(f"{name} {value:.2f}" for name, value in place.values.items())
    figure = Figure(figsize=(8.4, 3.1), layout="constrained")
    title = f"stone {place.posed.stone.id}: {values}"
    plot_indices(place, NAMES, figure.add_subplot(), title)
    yield ItemFigure("fig7", figure)


INDICES = PaperItem(
    study=places,
    tables={
        "extremes": lambda found: [
            (name, verdict, *_cells(place, name)) for name, verdict, place in found.cases
        ],
        "ranges": _ranges,
        "fig7": lambda found: [(name, *_cells(found.place, name)) for name in found.place.values],
    },
    pictures=_pictures,
)

OPACITY = 0.85


def plot_position_layers(
    ax: Axes, labels: Labels, posed: PosedStone, layers: Sequence[tuple[str, str, Mask]]
) -> None:
    """Draw sets of positions of a stone as areas; a position is where its centroid is.

    A layer is label, colour, and positions by row and column of the mask's top-left corner.
    """
    plot_landscape(ax, labels, LAID, edgecolor=OUTLINE_COLOUR, linewidth=0.3)
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
    plot_landscape(ax, labels, LAID, edgecolor=OUTLINE_COLOUR, linewidth=0.3)
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
class PositionTrial(RestingPlace):
    """A stone on a landscape, where the rule of placement puts it."""

    @cached_property
    def maps(self) -> tuple[Mask, Mask, Mask]:
        """The paper's positions: free, floating, and touching, the difference of both."""
        free, floating = position_maps(self.moment.wall.occupied, self.posed.mask)
        return free, floating, free & ~floating

    @property
    def built(self) -> int:
        """Stones of the landscape."""
        return len(self.moment.wall.placements)

    @cached_property
    def resting(self) -> Positions:
        """Where it rests on something from below."""
        return self.moment.positions(self.posed)

    def merits(self, positions: Positions) -> NDArray[np.float64]:
        """Return Eq. 12 at some positions."""
        landscape, beta = self.moment.landscape, self.moment.settings.placement.beta
        eq12 = Eq12(landscape.built_height_px, self.posed.anchor[0], beta)
        return eq12_merits(positions, self.posed.silhouette, landscape.rays, eq12)


def trial(context: Context, wall: Target = PR) -> PositionTrial:
    """Find the positions of a stone of the run on what was built before it."""
    place = amid_course(construction(context, wall))
    found = place.moment.trial(place.posed.stone.id)
    if found is None:
        raise RuntimeError("a stone of the run fits nowhere where it was placed")
    return PositionTrial(place.moment, *found)


def _positions(found: PositionTrial) -> Rows:
    free, floating, touching = found.maps
    yield "all inside the wall", free.size, None, None, None
    yield "no overlap (red)", int(free.sum()), None, None, None
    yield "floating (blue)", int(floating.sum()), None, None, None
    for name, positions in (
        ("touching: the difference (pink)", np.argwhere(touching).astype(np.int64)),
        ("resting on something from below", found.resting),
        ("chosen", np.array([(found.row, found.col)], np.int64)),
    ):
        # The place of the largest value; of equal ones the lower, then the left one.
        values = found.merits(positions)
        best = np.lexsort((positions[:, 1], -positions[:, 0], -np.round(values, 12)))[0]
        row, col = positions[best].tolist()
        bottom = found.moment.landscape.height_px - row - found.posed.height_px
        yield name, len(positions), col, bottom, round(float(values[best]), 4)


def _drawn(found: PositionTrial) -> ItemFigure:
    resting, (free, floating, touching) = found.resting, found.maps
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
        plot_position_layers(ax, found.moment.wall.labels, found.posed, layers)
    plot_position_values(third, found, resting, found.merits(resting))
    return ItemFigure("fig8", figure)


def _claims(found: PositionTrial) -> Iterator[Claimed]:
    resting, (*_, touching) = found.resting, found.maps
    inside, count = int(touching[resting[:, 0], resting[:, 1]].sum()), int(touching.sum())
    same = inside == len(resting) == count
    yield Claimed("difference", same, inside=inside, resting=len(resting), more=count - inside)


POSITIONS = PaperItem(
    study=trial,
    claims=_claims,
    tables={"positions": _positions},
    pictures=lambda found: [_drawn(found)],
)
