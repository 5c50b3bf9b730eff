"""Fig. 6 and Fig. 7: what the indices measure, on real stones (§3.5)."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.canvas import draw_block
from drystone.drawing.outlines import label_regions
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.indices import joints_below, left_neighbour, peak_columns, shape_factor, swept_pixels
from drystone.kernels.raster import Mask
from drystone.model.landscape import Box, view_box
from drystone.model.pose import PosedStone
from drystone.model.wall import Labels
from drystone.stabilise.stabilise import falls_to
from drystone_lab.pictures.walls import plot_landscape
from drystone_lab.reproduce import construction
from drystone_lab.reproduce.cells import rounded
from drystone_lab.reproduce.construction import Moment, RestingPlace, place_of
from drystone_lab.reproduce.item import Context, ItemFigure, PaperItem, Rows
from drystone_lab.table import Cell
from drystone_lab.walls import PR, Target

Mark = Literal["box", "rays", "begun", "neighbour", "joints", "slope"]

MARKS: Mapping[str, Mark] = MappingProxyType(
    {
        "SF": "box", "LFR": "rays", "GDS": "begun", "NHR": "neighbour", "IWR": "joints",
        "IS": "slope",
    }
)  # fmt: skip
"""What shows each index."""

BUILT = "#e4e0d8"
STONE, NEIGHBOUR, BELOW, RAYS, BEGUN = "#d55e00", "#009e73", "#56b4e9", "#f0e442", "#0072b2"
"""Okabe and Ito's colours, apart for colour-blind readers; roles as in Fig. 7."""

NamedBox = tuple[int, Box]
"""A placed stone that an index looks at: id and box."""


@dataclass(frozen=True, eq=False)
class ActionView:
    """A stone at a place, and what its indices measure; working px, building side on the left."""

    labels: Labels  # The landscape before the stone, row 0 at the top
    posed: PosedStone  # The stone
    row: int  # row, col: Top-left corner of its mask
    col: int
    swept: Mask
    built_height: int  # Height of the box B of the landscape
    neighbour: NamedBox | None  # Left neighbour in its course
    below: tuple[NamedBox | None, NamedBox | None]  # below1 and below2
    # Columns of the mask in which the highest points of its halves are
    peaks: tuple[int, int] | None

    @property
    def box(self) -> Box:
        """Bounding box of the stone, y up from the ground."""
        return view_box(self.posed, self.row, self.col, int(self.labels.shape[0]))

    @property
    def stone_pixels(self) -> Mask:
        """The stone in an image as large as the landscape."""
        image = np.zeros(self.labels.shape, bool)
        height, width = self.posed.mask.shape
        image[self.row : self.row + height, self.col : self.col + width] = self.posed.mask
        return image


def action_at(moment: Moment, posed: PosedStone, row: int, col: int) -> ActionView:
    """Return what the indices of a stone at a place measure, to be drawn."""
    landscape, end_px = moment.landscape, moment.workshop.stock.narrowest_px
    box = view_box(posed, row, col, landscape.height_px)
    ids = [placement.stone_id for placement in moment.wall.placements]
    neighbour, below1, below2 = (
        None if found is None else (ids[landscape.boxes.index(found)], found)
        for found in (left_neighbour(landscape, box), *joints_below(landscape, box, end_px))
    )
    swept = swept_pixels(landscape, posed, row, col)
    return ActionView(
        moment.wall.labels, posed, row, col, swept, landscape.built_height_px, neighbour,
        (below1, below2), peak_columns(posed),
    )  # fmt: skip


def plot_action(
    action: ActionView, marks: Collection[Mark], ax: Axes | None = None, *, title: str = ""
) -> Axes:
    """Draw a stone on the landscape with what some of its indices measure."""
    height, width = action.labels.shape
    fills: dict[int, str] = {}
    if "joints" in marks:
        fills |= {beside[0]: BELOW for beside in action.below if beside is not None}
    if "neighbour" in marks and action.neighbour is not None:
        fills[action.neighbour[0]] = NEIGHBOUR
    ax = plot_landscape(ax, action.labels, BUILT, fills=fills)
    if "rays" in marks:
        # Pale where it is empty, stronger over what is filled.
        image = np.zeros((height, width, 4))
        image[action.swept] = to_rgba(RAYS, 0.9)
        image[action.swept & (action.labels > 0)] = to_rgba("#a08500", 0.55)
        extent = (0, width, 0, height)
        ax.imshow(image, extent=extent, interpolation="nearest", zorder=2, gid="rays")
    (region,) = label_regions(action.stone_pixels.astype(np.uint32))
    draw_block(ax, region.loops, "stone", fill=STONE, zorder=3)
    if "box" in marks:
        left, right, bottom, top = action.box
        _draw_frame(ax, (left, bottom), right - left, top - bottom, "box", linewidth=1.0,
                    edgecolor=OUTLINE_COLOUR, linestyle=(0, (2, 1.5)), zorder=4)  # fmt: skip
    if "begun" in marks:
        _draw_frame(ax, (0, 0), width, action.built_height, "begun", linewidth=1.6,
                    edgecolor=BEGUN, zorder=4)  # fmt: skip
    if "neighbour" in marks and action.neighbour is not None:
        _draw_tops(ax, action.box, action.neighbour[1])
    if "joints" in marks:
        _draw_joints(ax, action)
    if "slope" in marks and action.peaks is not None:
        x = [action.col + column + 0.5 for column in action.peaks]
        y = [height - action.row - int(action.posed.top[column]) for column in action.peaks]
        _draw_line(ax, x, y, "slope", marker="o", markersize=3.5, linewidth=1.2, zorder=5)
    if {"neighbour", "joints"} <= {*marks}:
        _name_stones(ax, action)
    if title:
        ax.set_title(title, fontsize=7, loc="left", pad=2)
    return ax


def _draw_frame(
    ax: Axes, corner: tuple[float, float], width: float, height: float, gid: str, **look: object
) -> None:
    ax.add_patch(Rectangle(corner, width, height, fill=False, gid=gid, **look))  # type: ignore[arg-type]


def _draw_line(
    ax: Axes, x: Sequence[float], y: Sequence[float], gid: str | None, **look: object
) -> None:
    ax.plot(x, y, color=OUTLINE_COLOUR, gid=gid, **look)  # type: ignore[arg-type]


def _name_stones(ax: Axes, action: ActionView) -> None:
    below1, below2 = action.below
    told = {"left neighbour": action.neighbour, "below1": below1, "below2": below2}
    boxes = {name: beside[1] for name, beside in told.items() if beside is not None}
    for name, (left, right, bottom, top) in {**boxes, "stone": action.box}.items():
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


def _draw_joints(ax: Axes, action: ActionView) -> None:
    """Draw how far the ends of the stone are from the joints below."""
    below1, below2 = action.below
    stone = action.box
    pairs = []
    if below1 is not None:
        pairs.append((stone.left, below1[1].right, below1[1].top))
    if below2 is not None:
        pairs.append((stone.right, below2[1].left, below2[1].top))
    for x_end, x_joint, y_joint in pairs:
        _draw_line(ax, (x_end, x_joint), (stone.bottom, stone.bottom), "offset", linewidth=1.8,
                   zorder=5, solid_capstyle="butt")  # fmt: skip
        _draw_line(ax, (x_joint, x_joint), (stone.bottom, y_joint), None, linewidth=0.6, zorder=5)
        _draw_line(ax, (x_joint,), (y_joint,), "joint", marker="o", markersize=3, zorder=5,
                   linestyle="")  # fmt: skip


def recounted(action: ActionView, name: str) -> float | None:
    """Return an index counted in the label image; None where the picture does not show it.

    SF is that of the working pixels; the planner's is that of the source image.
    """
    if name == "SF":
        return float(action.posed.mask.mean())
    if name == "LFR":
        swept = action.labels[action.swept] > 0
        return float(swept.mean()) if swept.size else 1.0
    return {"GDS": _dice, "NHR": _height, "IWR": _joints, "IS": _slope}[name](action)


def _dice(action: ActionView) -> float:
    built = np.zeros(action.labels.shape, bool)
    filled = np.flatnonzero((action.labels > 0).any(axis=1))
    built[filled[0] if filled.size else len(built) :] = True
    stone = action.stone_pixels
    area = np.count_nonzero(stone)
    inside = np.count_nonzero(stone & built)
    return float(np.count_nonzero(built) / area * inside / np.count_nonzero(stone | built))


def _height(action: ActionView) -> float | None:
    if action.neighbour is None:
        return None
    top, other = _rows(action.stone_pixels), _rows(action.labels == action.neighbour[0])
    return abs(top[0] - other[0]) / (top[1] - top[0])


def _joints(action: ActionView) -> float | None:
    below1, below2 = action.below
    if below1 is None or below2 is None:
        return None
    left, right = _rows(action.stone_pixels.T)
    start1, end1 = _rows((action.labels == below1[0]).T)
    start2, end2 = _rows((action.labels == below2[0]).T)
    terms = (abs(left - end1) / (end1 - start1), abs(right - start2) / (end2 - start2))
    return sum(min(1.0, term) for term in terms) / 2


def _slope(action: ActionView) -> float | None:
    if action.peaks is None or action.peaks[0] == action.peaks[1]:
        return None
    left, right = (action.col + column for column in action.peaks)
    stone = action.stone_pixels
    fall = int(np.argmax(stone[:, right])) - int(np.argmax(stone[:, left]))
    side = np.sign(action.col + action.posed.anchor[0] - action.labels.shape[1] / 2)
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
            factor = shape_factor(posed)
            found += [
                place_of(moment, posed, row, col, factor)
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
    moment: Moment
    place: RestingPlace
    all: tuple[RestingPlace, ...]

    @property
    def cases(self) -> Sequence[tuple[str, str, RestingPlace]]:
        """The best and the worst place by each index: index, verdict and place."""
        return [
            (name, verdict, place)
            for name in MARKS
            for verdict in ("favourable", "unfavourable")
            if (place := extreme(self.all, name, best=verdict == "favourable")) is not None
        ]

    def action(self, place: RestingPlace) -> ActionView:
        """Return a place to be drawn."""
        return action_at(self.moment, place.posed, place.row, place.col)

    def cells(self, place: RestingPlace, name: str) -> tuple[Cell, ...]:
        """Return stone, place, an index, and the index counted again."""
        action = self.action(place)
        box, value = action.box, rounded(place.values[name])
        again = rounded(recounted(action, name))
        return place.posed.stone.id, box.left, box.bottom, value, again


def places(context: Context, wall: Target = PR) -> MomentPlaces:
    """Find the places of all stones that are left at a moment of a run."""
    moment, place = construction.amid_course(construction.construction(context, wall))
    return MomentPlaces(wall, moment, place, resting_places(moment))


def _ranges(found: MomentPlaces) -> Rows:
    for name in MARKS:
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
        plot_action(found.action(place), {MARKS[index]}, ax, title=title).set_axis_off()
    yield ItemFigure("fig6", figure)
    place = found.place
    values = ", ".join(f"{name} {value:.2f}" for name, value in place.values.items())
    figure = Figure(figsize=(8.4, 3.1), layout="constrained")
    title = f"stone {place.posed.stone.id}: {values}"
    ax = plot_action(found.action(place), set(MARKS.values()), figure.add_subplot(), title=title)
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    yield ItemFigure("fig7", figure)


INDICES = PaperItem(
    study=places,
    tables={
        "extremes": lambda found: [
            (name, verdict, *found.cells(place, name)) for name, verdict, place in found.cases
        ],
        "ranges": _ranges,
        "fig7": lambda found: [
            (name, *found.cells(found.place, name)) for name in found.place.values
        ],
    },
    pictures=_pictures,
)
