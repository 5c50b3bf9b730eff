"""Fig. 6 and Fig. 7: what the indices measure, on real stones (§3.5)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from matplotlib.figure import Figure

from drystone.kernels.raster import Mask
from drystone.model.wall import Labels
from drystone_lab.pictures.action import ActionView, Mark, plot_action
from drystone_lab.reproduce.construction import (
    Moment,
    RestingPlace,
    action_at,
    amid_course,
    construction,
    extreme,
    resting_places,
)
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.table import Cell, Table
from drystone_lab.walls import PR, Target


def recounted(action: ActionView, name: str) -> float | None:
    """Return an index counted in the label image; None where the picture does not show it.

    SF is that of the working pixels; the planner's is that of the source image.
    """
    counts = {"SF": _shape, "LFR": _filling, "GDS": _dice, "NHR": _height, "IWR": _joints,
              "IS": _slope}  # fmt: skip
    return counts[name](action)


def _shape(action: ActionView) -> float:
    return float(action.posed.mask.mean())


def _filling(action: ActionView) -> float:
    swept = action.labels[action.swept] > 0
    return float(swept.mean()) if swept.size else 1.0


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
    top, other = _rows(action.stone_pixels), _rows(_pixels(action.labels, action.neighbour.id))
    return abs(top[0] - other[0]) / (top[1] - top[0])


def _joints(action: ActionView) -> float | None:
    below1, below2 = action.below
    if below1 is None or below2 is None:
        return None
    left, right = _cols(action.stone_pixels)
    start1, end1 = _cols(_pixels(action.labels, below1.id))
    start2, end2 = _cols(_pixels(action.labels, below2.id))
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


def _pixels(labels: Labels, block: int) -> Mask:
    return np.asarray(labels == block)


def _rows(pixels: Mask) -> tuple[int, int]:
    """Return the first row of some pixels and the row after the last."""
    rows = np.flatnonzero(pixels.any(axis=1))
    return int(rows[0]), int(rows[-1]) + 1


def _cols(pixels: Mask) -> tuple[int, int]:
    return _rows(pixels.T)


MARKS: Mapping[str, Mark] = MappingProxyType(
    {
        "SF": "box", "LFR": "rays", "GDS": "begun", "NHR": "neighbour", "IWR": "joints",
        "IS": "slope",
    }
)  # fmt: skip
"""What shows each index."""

PANEL_IN = (3.6, 1.28)
WIDE_IN = (8.4, 3.1)

Cases = Sequence[tuple[str, bool, RestingPlace]]
"""Index, whether it is best there, and the place."""


@dataclass(frozen=True, eq=False)
class MomentPlaces:
    """A moment of a run, where stones that are left would rest, and a stone amid a course."""

    wall: Target
    moment: Moment
    place: RestingPlace
    all: tuple[RestingPlace, ...]

    @property
    def cases(self) -> Cases:
        """The best and the worst place by each index."""
        found = [
            (name, best, extreme(self.all, name, best=best))
            for name in MARKS
            for best in (True, False)
        ]
        return [(name, best, place) for name, best, place in found if place is not None]


def places(context: Context, wall: Target = PR) -> MomentPlaces:
    """Find the places of all stones that are left at a moment of a run."""
    spec = wall.run(context.seed)
    moment, place = amid_course(construction(context, spec))
    return MomentPlaces(wall, moment, place, resting_places(moment))


def _row(moment: Moment, place: RestingPlace, name: str) -> tuple[Cell, ...]:
    action = action_at(moment, place.posed, place.row, place.col)
    again, box = recounted(action, name), action.box
    value = round(place.values[name], 4)
    return (
        place.posed.stone.id, box.left, box.bottom, value,
        None if again is None else round(again, 4),
    )  # fmt: skip


def _extremes(moment: Moment, cases: Cases) -> Table:
    return Table(
        "The best and the worst place by each index",
        ("index", "case", "stone", "left px", "bottom px", "value", "counted again"),
        tuple(
            (name, "favourable" if best else "unfavourable", *_row(moment, place, name))
            for name, best, place in cases
        ),
        ("Places in working px of the wall; of equal ones the lowest, then the leftmost.",),
    )


def _ranges(places: Sequence[RestingPlace]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for name in MARKS:
        values = sorted(place.values[name] for place in places if name in place.values)
        if values:
            cells = (values[0], values[len(values) // 2], values[-1])
            rows.append((name, len(values), *(round(value, 4) for value in cells)))
    return Table(
        "Indices over all places where a stone that is left would rest",
        ("index", "places", "least", "upper median", "largest"),
        tuple(rows),
    )


def _one(moment: Moment, place: RestingPlace) -> Table:
    return Table(
        f"Indices of the stone of Fig. 7, number {moment.number} of the run",
        ("index", "stone", "left px", "bottom px", "value", "counted again"),
        tuple((name, *_row(moment, place, name)) for name in place.values),
    )


def _picture6(moment: Moment, cases: Cases, name: str) -> ItemPicture:
    rows = -(-len(cases) // 2)
    size = (2 * PANEL_IN[0], rows * PANEL_IN[1])
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(rows, 2, squeeze=False).ravel().tolist()
    for ax, (index, best, place) in zip(panels, cases, strict=True):
        action = action_at(moment, place.posed, place.row, place.col)
        verdict = "favourable" if best else "unfavourable"
        title = f"{index} = {place.values[index]:.3f}, {verdict}: stone {place.posed.stone.id}"
        plot_action(action, {MARKS[index]}, ax, title=title)
        ax.set_axis_off()
    return ItemPicture(
        "fig6", figure,
        f"The best and the worst place by each index among all at which a stone that is left of "
        f"{name} would rest. Orange: the stone. SF: its bounding box. LFR: what the rays sweep, "
        "darker where it is filled. GDS: the box B of what is built. NHR: the left neighbour "
        "(green), both tops. IWR: the stones below (blue), distances to the joints. IS: highest "
        "points of the halves.",
    )  # fmt: skip


def _picture7(moment: Moment, place: RestingPlace) -> ItemPicture:
    action = action_at(moment, place.posed, place.row, place.col)
    values = ", ".join(f"{name} {value:.2f}" for name, value in place.values.items())
    figure = Figure(figsize=WIDE_IN, layout="constrained")
    title = f"stone {place.posed.stone.id}: {values}"
    ax = plot_action(action, set(MARKS.values()), figure.add_subplot(), title=title)
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    return ItemPicture(
        "fig7", figure,
        "What the indices of one stone (orange) are computed from: swept by its rays (yellow, "
        "darker where filled), box B (dark blue), left neighbour (green) and the tops; the two "
        "stones below (light blue) and the distances to their joints; its bounding box (dashed).",
    )  # fmt: skip


INDICES = PaperItem(
    **paper("fig6-7"),
    study=places,
    tables={
        "extremes": lambda found: _extremes(found.moment, found.cases),
        "ranges": lambda found: _ranges(found.all),
        "fig7": lambda found: _one(found.moment, found.place),
    },
    pictures=lambda found: (
        _picture6(found.moment, found.cases, found.wall.name),
        _picture7(found.moment, found.place),
    ),
    needs=(PR.source.name,),
)
