"""Fig. 12: Pic-to-Ri, from the pixels of three stones to rigid blocks (§4.2)."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.canvas import draw_legend
from drystone.drawing.drawing import Lines
from drystone.drawing.palette import PALE
from drystone.drawing.pictures.forces import JOINT, NORMAL, plot_contacts
from drystone.drawing.pictures.stones import plot_labels
from drystone.kernels.boundary import EMPTY, boundary_of
from drystone.model.wall import Labels, Wall
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from drystone_lab.pictures.walls import plot_landscape
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.table import Rows
from drystone_lab.walls import PR, Target

NORMAL_PX = 2.5
"""Length of the normal of a pixel edge."""


def plot_boundary_edges(
    ax: Axes, labels: Labels, starts: NDArray[np.floating], ends: NDArray[np.floating]
) -> None:
    """Draw the pixel edges on which blocks touch, each with its normal.

    `starts` and `ends` are (n, 2), px, y up from the ground; the normal is to the left of the way.
    """
    plot_landscape(ax, labels, PALE, ground=0.06, framed=False)
    ax.set_axis_off()
    way = ends - starts
    normals = np.column_stack([-way[:, 1], way[:, 0]])
    middles = (starts + ends) / 2.0
    edges = np.stack([starts, ends], axis=1)
    arrows = np.stack([middles, middles + NORMAL_PX * normals], axis=1)
    for lines, colour, thick, gid in (
        (edges, JOINT, 1.6, "edges"),
        (arrows, NORMAL, 0.6, "normals"),
    ):
        drawn = LineCollection(list(lines), colors=colour, linewidths=thick, gid=gid, zorder=4)
        ax.add_collection(drawn, autolim=False)
    legend = {
        "pixel edge between blocks": Lines("", [], JOINT, 1.6),
        "its normal": Lines("", [], NORMAL, 0.8),
    }
    draw_legend(ax, legend)


MARGIN_PX = 2


@dataclass(frozen=True, eq=False)
class Blocks:
    """Three stones of a wall as pixels, edges and rigid blocks; and the model of the whole."""

    wall: Target
    labels: Labels
    model: RigidBlockModel
    whole: RigidBlockModel

    @cached_property
    def edges(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Pixel edges between two of them or one and the ground: starts and ends."""
        return boundary_edges(self.labels)


def blocks(context: Context, wall: Target = PR) -> Blocks:
    """Take three stones of a wall to rigid blocks."""
    built = context.wall(wall.run(context.seed))
    labels = three_stones(built)
    model, whole = (model_from_labels(each).model for each in (labels, built.labels))
    return Blocks(wall, labels, model, whole)


def three_stones(wall: Wall) -> Labels:
    """Return the picture of three stones of a wall: two on the ground, and one on both."""
    touches: dict[int, set[int]] = defaultdict(set)
    for interface in model_from_labels(wall.labels).model.interfaces:
        touches[interface.block].add(interface.other)
        touches[interface.other].add(interface.block)
    order = [placement.stone_id for placement in wall.placements]
    on_ground = [stone for stone in order if GROUND in touches[stone]]
    group = set(order[:3])
    for top in order:
        below = sorted(touches[top].intersection(on_ground), key=order.index)
        if top not in on_ground and len(below) >= 2:
            group = {top, *below[:2]}
            break
    kept = np.where(np.isin(wall.labels, sorted(group)), wall.labels, 0).astype(np.uint32)
    rows, cols = (np.flatnonzero((kept > 0).any(axis=axis)) for axis in (1, 0))
    inside = np.pad(kept, ((MARGIN_PX, 0), (MARGIN_PX, MARGIN_PX)))
    # The margin is above, left and right of the stones only: they stand on the last row.
    return inside[rows[0] : rows[-1] + 1 + MARGIN_PX, cols[0] : cols[-1] + 1 + 2 * MARGIN_PX]


def boundary_edges(labels: Labels) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the pixel edges between two stones or a stone and the ground.

    >>> starts, ends = boundary_edges(np.array([[5], [3]]))
    >>> starts.tolist(), ends.tolist()
    ([[0.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [1.0, 1.0]])
    """
    height, width = labels.shape
    cells = np.full((height + 1, width), GROUND, np.int64)
    cells[:-1] = np.where(labels > 0, labels.astype(np.int64), EMPTY)
    boundary = boundary_of(cells)
    points = np.column_stack([boundary.nodes[:, 1], height - boundary.nodes[:, 0]]).astype(float)
    last = boundary.begins[1:] - 1
    return np.delete(points, last, axis=0), np.delete(points, boundary.begins[:-1], axis=0)


def _mean_normal(interface: Interface) -> NDArray[np.float64]:
    # The mean over its pixel edges, each turned by a quarter: their sum is the way from end to
    # end, turned.
    way = interface.points[-1] - interface.points[0]
    normal = np.array([-way[1], way[0]]) / np.hypot(*way)
    return np.asarray(normal if normal @ np.array(interface.normal) >= 0 else -normal)


def _apart_deg(interface: Interface) -> float:
    cosine = float(_mean_normal(interface) @ np.array(interface.normal))
    return float(np.degrees(np.arccos(min(1.0, cosine))))


def _interfaces(found: Blocks) -> Rows:
    for interface in found.model.interfaces:
        long = len(interface.points) == 2
        ends = [*interface.points[0].tolist(), *interface.points[-1].tolist()]
        yield (
            interface.block, interface.other or "ground", *ends, round(interface.length, 4),
            *(round(value, 4) for value in interface.normal),
            round(_apart_deg(interface), 3) if long else None,
        )  # fmt: skip


def _picture(found: Blocks) -> ItemFigure:
    labels, model = found.labels, found.model
    figure = Figure(figsize=(6.4, 7.5), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    plot_labels(labels, first, title="(a) labels")
    plot_boundary_edges(second, labels, *found.edges)
    second.set_title("(b) edges between blocks, and their normals", fontsize=9, loc="left")
    plot_contacts(labels, model, third)
    for block in model.blocks:
        gid = f"centre-{block.id}"
        third.plot(*block.centroid, "^", color="#0072b2", markersize=7, gid=gid, zorder=5)
    third.set_title("(c) rigid blocks", fontsize=9, loc="left")
    return ItemFigure("fig12", figure)


def _claims(found: Blocks) -> Iterator[Claimed]:
    angles = [_apart_deg(i) for i in found.whole.interfaces if len(i.points) == 2]
    tilted = sum(angle > 1.0 for angle in angles)
    values = {"tilted": tilted, "count": len(angles), "most": max(angles)}
    yield Claimed("normal", None, values)


PIC_TO_RI = PaperItem(
    study=blocks,
    claims=_claims,
    tables={
        "blocks": lambda found: [
            (block.id, block.area, *(round(value, 4) for value in block.centroid))
            for block in found.model.blocks
        ],
        "interfaces": _interfaces,
    },
    pictures=lambda found: [_picture(found)],
)
