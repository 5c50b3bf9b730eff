"""Fig. 6 and Fig. 7: what the indices measure, on real stones (§3.5)."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.canvas import draw_block
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.indices import peak_columns, swept_pixels
from drystone.kernels.raster import Mask
from drystone.model.landscape import Box
from drystone.model.wall import Labels
from drystone.stabilise.stabilise import falls_to
from drystone_lab.pictures.walls import plot_landscape
from drystone_lab.reproduce.cells import rounded
from drystone_lab.reproduce.construction import Moment, RestingPlace, amid_course, construction
from drystone_lab.reproduce.item import Context, ItemFigure, PaperItem, Rows
from drystone_lab.table import Cell
from drystone_lab.walls import PR, Target

NAMES = ("SF", "LFR", "GDS", "NHR", "IWR", "IS")

BUILT = "#e4e0d8"
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
        _draw_line(ax, x, y, "slope", marker="o", markersize=3.5, linewidth=1.2, zorder=5)
    if {"NHR", "IWR"} <= {*names}:
        _name_stones(ax, place)
    ax.set_title(title, fontsize=7, loc="left", pad=2)


def _id(place: RestingPlace, box: Box) -> int:
    """Return the id of the placed stone that has a box."""
    moment = place.moment
    return moment.wall.placements[moment.landscape.boxes.index(box)].stone_id


def _draw_line(
    ax: Axes, x: Sequence[float], y: Sequence[float], gid: str | None, **look: object
) -> None:
    ax.plot(x, y, color=OUTLINE_COLOUR, gid=gid, **look)  # type: ignore[arg-type]


def _name_stones(ax: Axes, place: RestingPlace) -> None:
    below1, below2 = place.below
    told = {
        "left neighbour": place.neighbour, "below1": below1, "below2": below2, "stone": place.box,
    }  # fmt: skip
    for name, box in told.items():
        if box is None:
            continue
        left, right, bottom, top = box
        ax.text(
            (left + right) / 2, (bottom + top) / 2, name, size=7, ha="center", va="center",
            zorder=6, gid="name", path_effects=[withStroke(linewidth=1.5, foreground="white")],
        )  # fmt: skip


def _draw_tops(ax: Axes, stone: Box, beside: Box) -> None:
    """Draw the heights of both tops, and how far they are apart."""
    ends = (min(stone.left, beside.left), max(stone.right, beside.right))
    for top in (stone.top, beside.top):
        _draw_line(ax, ends, (top, top), "top", linewidth=0.8, linestyle=(0, (4, 2)), zorder=4)
    middle = (ends[0] + ends[1]) / 2
    _draw_line(ax, (middle, middle), (stone.top, beside.top), "difference", linewidth=2.0,
               zorder=5, solid_capstyle="butt")  # fmt: skip


def _draw_joints(ax: Axes, place: RestingPlace) -> None:
    """Draw how far the ends of the stone are from the joints below."""
    below1, below2 = place.below
    stone = place.box
    pairs = []
    if below1 is not None:
        pairs.append((stone.left, below1.right, below1.top))
    if below2 is not None:
        pairs.append((stone.right, below2.left, below2.top))
    for x_end, x_joint, y_joint in pairs:
        _draw_line(ax, (x_end, x_joint), (stone.bottom, stone.bottom), "offset", linewidth=1.8,
                   zorder=5, solid_capstyle="butt")  # fmt: skip
        _draw_line(ax, (x_joint, x_joint), (stone.bottom, y_joint), None, linewidth=0.6, zorder=5)
        _draw_line(ax, (x_joint,), (y_joint,), "joint", marker="o", markersize=3, zorder=5,
                   linestyle="")  # fmt: skip


def recounted(place: RestingPlace, name: str) -> float | None:
    """Return an index counted in the label image; None where the picture does not show it.

    SF is that of the working pixels; the planner's is that of the source image.
    """
    if name == "SF":
        return float(place.posed.mask.mean())
    labels, stone = place.moment.wall.labels, place.pixels
    if name == "LFR":
        swept = labels[swept_pixels(place.moment.landscape, place.posed, place.row, place.col)] > 0
        return float(swept.mean()) if swept.size else 1.0
    if name == "GDS":
        return _dice(labels, stone)
    return {"NHR": _height, "IWR": _joints, "IS": _slope}[name](place, labels, stone)


def _dice(labels: Labels, stone: Mask) -> float:
    built = np.zeros(labels.shape, bool)
    filled = np.flatnonzero((labels > 0).any(axis=1))
    built[filled[0] if filled.size else len(built) :] = True
    area = np.count_nonzero(stone)
    inside = np.count_nonzero(stone & built)
    return float(np.count_nonzero(built) / area * inside / np.count_nonzero(stone | built))


def _height(place: RestingPlace, labels: Labels, stone: Mask) -> float | None:
    if place.neighbour is None:
        return None
    top, other = _rows(stone), _rows(labels == _id(place, place.neighbour))
    return abs(top[0] - other[0]) / (top[1] - top[0])


def _joints(place: RestingPlace, labels: Labels, stone: Mask) -> float | None:
    below1, below2 = place.below
    if below1 is None or below2 is None:
        return None
    left, right = _rows(stone.T)
    start1, end1 = _rows((labels == _id(place, below1)).T)
    start2, end2 = _rows((labels == _id(place, below2)).T)
    terms = (abs(left - end1) / (end1 - start1), abs(right - start2) / (end2 - start2))
    return sum(min(1.0, term) for term in terms) / 2


def _slope(place: RestingPlace, labels: Labels, stone: Mask) -> float | None:
    peaks = peak_columns(place.posed)
    if peaks is None or peaks[0] == peaks[1]:
        return None
    left, right = (place.col + column for column in peaks)
    fall = int(np.argmax(stone[:, right])) - int(np.argmax(stone[:, left]))
    side = np.sign(place.col + place.posed.anchor[0] - labels.shape[1] / 2)
    return float(np.clip(fall / (left - right) * side, -1.0, 1.0))


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


def extreme(places: Sequence[RestingPlace], name: str, *, best: bool) -> RestingPlace | None:
    """Return the place where an index is best, or worst; None when it has a meaning nowhere.

    Of equal ones the lowest, then that furthest to the left, then that of the smaller id.
    """
    meant = [place for place in places if name in place.values]
    # NHR is best at 0, the others when they are large.
    sign = 1.0 if (name == "NHR") == best else -1.0
    return min(meant, key=lambda p: (sign * p.values[name], p.order), default=None)


@dataclass(frozen=True, eq=False)
class MomentPlaces:
    """A moment of a run, where stones that are left would rest, and a stone amid a course."""

    wall: Target
    place: RestingPlace
    all: tuple[RestingPlace, ...]

    @property
    def cases(self) -> Sequence[tuple[str, str, RestingPlace]]:
        """The best and the worst place by each index: index, verdict and place."""
        return [
            (name, verdict, place)
            for name in NAMES
            for verdict in ("favourable", "unfavourable")
            if (place := extreme(self.all, name, best=verdict == "favourable")) is not None
        ]


def _cells(place: RestingPlace, name: str) -> tuple[Cell, ...]:
    """Return stone, place, an index, and the index counted again."""
    values = rounded(place.values[name]), rounded(recounted(place, name))
    return place.posed.stone.id, place.box.left, place.box.bottom, *values


def places(context: Context, wall: Target = PR) -> MomentPlaces:
    """Find the places of all stones that are left at a moment of a run."""
    place = amid_course(construction(context, wall))
    return MomentPlaces(wall, place, resting_places(place.moment))


def _ranges(found: MomentPlaces) -> Rows:
    for name in NAMES:
        values = sorted(place.values[name] for place in found.all if name in place.values)
        if values:
            cells = (values[0], values[len(values) // 2], values[-1])
            yield name, len(values), *map(rounded, cells)


def _pictures(found: MomentPlaces) -> Iterator[ItemFigure]:
    rows = -(-len(found.cases) // 2)
    figure = Figure(figsize=(7.2, rows * 1.28), layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False).ravel().tolist()
    for ax, (index, verdict, place) in zip(panels, found.cases, strict=True):
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
