"""The method itself: Table 1, and Figs. 3, 4, 10, 11 and 12 on a real run."""

from collections.abc import Iterator, Sequence
from itertools import islice
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.canvas import draw_legend
from drystone.drawing.drawing import Lines
from drystone.drawing.palette import CLUSTER_COLOURS, PALE
from drystone.drawing.pictures.forces import JOINT, NORMAL, plot_contacts, plot_forces
from drystone.drawing.pictures.stones import plot_labels
from drystone.kernels.boundary import EMPTY, boundary_of
from drystone.model.site import Site
from drystone.model.wall import Labels, Wall
from drystone.planner.attempt import Attempt
from drystone.planner.build import Candidate
from drystone.planner.choose import action_of
from drystone.planner.planner import Planner
from drystone.selection.algorithm2 import Selected, select_action, weighted_sum
from drystone.selection.policies.table1 import ENGINE, MARKS
from drystone.selection.sampling import sample_stones
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Interface, RigidBlockModel
from drystone.statics.result import LateralResistance
from drystone_lab import pictures
from drystone_lab.cells import rounded
from drystone_lab.reproduce.construction import Moment, construction
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.reproduce.items import ITEMS
from drystone_lab.table import Rows
from drystone_lab.walls import PR, Target


def _table1(_: object) -> Rows:
    for name, (part, count, *said) in ITEMS["table1"]["marks"].items():
        whose = (
            ["paper"] * (policy in said) + ["ours"] * (part in MARKS[policy]) for policy in MARKS
        )
        yield name, count, *map(" and ".join, whose)


TABLE1 = PaperItem(
    study=lambda _: SimpleNamespace(engine=" and ".join(ENGINE)),
    tables={"table1": _table1},
)


def _steps(run: Sequence[Moment]) -> Rows:
    filled = 0.0
    for moment in run:
        group, clusters = moment.stage.group, moment.workshop.clusters
        placement = group.placement
        filled += placement.posed.area_px / moment.wall.labels.size
        yield (
            moment.number, placement.stone_id, clusters[placement.stone_id],
            placement.posed.angle_deg, placement.rotation_moves, len(group.wedges),
            rounded(filled),
        )  # fmt: skip


def _workflow(run: Sequence[Moment]) -> Iterator[ItemFigure]:
    stones, clusters, count = run[0].workshop.stones, run[0].workshop.clusters, len(run)
    walls = [
        pictures.wall_panel(f"after {number} stones", run[number - 1].stage.after, clusters)
        for number in sorted({1, max(1, count // 3), max(1, 2 * count // 3), count})
    ]
    yield ItemFigure("fig3", pictures.sheet_of(walls, 2), {"placed": count, "count": len(stones)})
    free = "the landscape before the first stone: free between its bounds"
    panels = [
        pictures.stones_panel("the stones", stones, clusters),
        pictures.wall_panel(free, run[0].wall, {}),
    ]
    yield ItemFigure("fig4", pictures.sheet_of(panels, 2))


WORKFLOW = PaperItem(study=construction, tables={"steps": _steps}, pictures=_workflow)

FILTERS = ("LLC > 0", "LLC", "NHR", "IWR or IS", "GDS", "LFR")


class Selection(NamedTuple):
    """A step of Algorithm 2: candidates after which the wall stands, and who passed what."""

    tried: int
    candidates: tuple[Candidate, ...]
    selected: Selected

    @property
    def passed(self) -> list[int]:
        """How many filters each candidate passed."""
        return [
            sum(k in survivors for survivors in self.selected.survivors)
            for k in range(len(self.candidates))
        ]


def selection_step(context: Context, wall: Target = PR) -> Selection:
    """Build half of a wall, and look at what Algorithm 2 does next."""
    stones, settings = wall.source.stones(context.data), wall.run(context.seed).settings()
    site = Site.from_source(*wall.size(stones), wall.scale)
    planner = Planner(stones, site, seed=context.seed, settings=settings)
    for _ in islice(planner.steps(), len(stones) // 2):
        pass
    shop, build = planner.workshop, planner.build
    attempt = Attempt(shop, settings, build)
    rng = np.random.default_rng([context.seed, len(build.actions), 0])  # as the planner's own
    sample = sample_stones(settings.sampling, shop.remaining(build), shop.clusters, rng)
    standing = tuple(attempt.standing(sample))
    selected = select_action([action_of(c, settings.selection) for c in standing])
    if selected is None:
        raise ValueError("no candidate stands")
    return Selection(attempt.candidates, standing, selected)


def _filters(step: Selection) -> Rows:
    settings = PR.run(0).settings().selection
    for k, (candidate, passed) in enumerate(zip(step.candidates, step.passed, strict=True)):
        action = action_of(candidate, settings)
        yield (
            candidate.stone_id, candidate.proposal.trial_angle_deg, *map(rounded, action.terms),
            "IS" if candidate.indices.boundary else "IWR", rounded(weighted_sum(action, settings)),
            FILTERS[passed - 1], k == step.selected.position,
        )  # fmt: skip


def _selection_picture(step: Selection) -> ItemFigure:
    figure = Figure(figsize=(6.4, 0.4 + 0.22 * len(step.candidates)), layout="constrained")
    ax = figure.add_subplot()
    for k, passed in enumerate(step.passed):
        ax.barh(k, passed, color=CLUSTER_COLOURS[k == step.selected.position])
    names = [f"{c.stone_id} at {c.proposal.trial_angle_deg:g}" for c in step.candidates]
    ax.set_yticks(range(len(names)), names, fontsize=6)
    ax.set_xticks(range(1, len(FILTERS) + 1), FILTERS, fontsize=7)
    ax.set_ylabel("stone, angle in degrees")
    counts = " > ".join(str(len(survivors)) for survivors in step.selected.survivors)
    return ItemFigure("fig10", figure, counts)


SELECTION = PaperItem(
    study=selection_step,
    tables={"candidates": _filters},
    pictures=lambda step: [_selection_picture(step)],
)


class TwoStones(NamedTuple):
    """Fig. 11: a stone on another one, and the forces at the most that they carry."""

    labels: Labels
    model: RigidBlockModel
    both: LateralResistance


def two_stones(_: Context) -> TwoStones:
    """Load one brick on another."""
    labels = np.zeros((44, 64), np.uint32)
    labels[24:, 2:62], labels[4:24, 22:62] = 1, 2
    model = model_from_labels(labels).model
    return TwoStones(labels, model, lateral_resistance(model, mechanism=True))


def _contact_forces(found: TwoStones) -> Rows:
    forces = found.both.right.forces
    each = iter(() if forces is None else forces.tolist())
    for face in found.model.interfaces:
        for x, y in face.points.tolist():
            n, t = next(each)
            share = rounded(abs(t) / (found.model.mu * n)) if n else None
            under = "the ground" if not face.other else f"stone {face.other}"
            yield f"stone {face.block}", under, x, y, rounded(n), rounded(t), share


def _two_claims(found: TwoStones) -> Iterator[Claimed]:
    alpha, mu = found.both.right.alpha, found.model.mu
    holds = alpha is not None and abs(alpha - mu) < 1e-9
    yield Claimed("sliding", holds, alpha=alpha, mu=mu)


def _two_picture(found: TwoStones) -> ItemFigure:
    figure = Figure(figsize=(5.0, 3.6), layout="constrained")
    if found.both.right.forces is not None:
        plot_forces(found.labels, found.model, found.both.right.forces, figure.add_subplot())
    return ItemFigure("fig11", figure)


RIGID = PaperItem(
    study=two_stones,
    claims=_two_claims,
    tables={"forces": _contact_forces},
    pictures=lambda found: [_two_picture(found)],
)

NORMAL_PX = 2.5
"""Length of the normal of a pixel edge."""


def plot_boundary_edges(
    ax: Axes, labels: Labels, starts: NDArray[np.floating], ends: NDArray[np.floating]
) -> None:
    """Draw the pixel edges on which blocks touch, each with its normal.

    `starts` and `ends` are (n, 2), px, y up from the ground; the normal is to the left of the way.
    """
    pictures.plot_landscape(ax, labels, PALE, ground=0.06, framed=False)
    ax.set_axis_off()
    way = ends - starts
    normals = np.column_stack([-way[:, 1], way[:, 0]])
    middles = (starts + ends) / 2.0
    edges = np.stack([starts, ends], axis=1)
    arrows = np.stack([middles, middles + NORMAL_PX * normals], axis=1)
    looks = (edges, JOINT, 1.6, "edges"), (arrows, NORMAL, 0.6, "normals")
    for lines, colour, thick, gid in looks:
        drawn = LineCollection(list(lines), colors=colour, linewidths=thick, gid=gid, zorder=4)
        ax.add_collection(drawn, autolim=False)
    legend = {
        "pixel edge between blocks": Lines("", [], JOINT, 1.6),
        "its normal": Lines("", [], NORMAL, 0.8),
    }
    draw_legend(ax, legend)


class Blocks(NamedTuple):
    """Three stones of a wall as pixels, edges and rigid blocks; and the model of the whole."""

    labels: Labels
    edges: tuple[NDArray[np.float64], NDArray[np.float64]]  # Starts and ends
    model: RigidBlockModel
    whole: RigidBlockModel


def blocks(context: Context, wall: Target = PR) -> Blocks:
    """Take three stones of a wall to rigid blocks."""
    built = context.wall(wall.run(context.seed))
    labels = three_stones(built)
    model, whole = (model_from_labels(each).model for each in (labels, built.labels))
    return Blocks(labels, boundary_edges(labels), model, whole)


def three_stones(wall: Wall) -> Labels:
    """Return the picture of three stones of a wall: two on the ground, and one on both."""
    model = model_from_labels(wall.labels).model
    order = [placement.stone_id for placement in wall.placements]
    on_ground = [stone for stone in order if GROUND in model.touched_by(stone)]
    group = set(order[:3])
    for top in order:
        below = sorted({*model.touched_by(top)}.intersection(on_ground), key=order.index)
        if top not in on_ground and len(below) >= 2:
            group = {top, *below[:2]}
            break
    kept = np.where(np.isin(wall.labels, sorted(group)), wall.labels, 0).astype(np.uint32)
    rows, cols = (np.flatnonzero((kept > 0).any(axis=axis)) for axis in (1, 0))
    # A margin of 2 px is above, left and right of the stones only: they stand on the last row.
    inside = np.pad(kept, ((2, 0), (2, 2)))
    return inside[rows[0] : rows[-1] + 3, cols[0] : cols[-1] + 5]


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


def _apart_deg(interface: Interface) -> float:
    """Return how far its normal is from the mean of those of its pixel edges.

    That mean is across the way from end to end, which is the sum of the edges.
    """
    way = interface.points[-1] - interface.points[0]
    return float(np.degrees(np.arcsin(abs(way @ interface.normal) / np.hypot(*way))))


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
    yield Claimed("normal", None, tilted=tilted, count=len(angles), most=max(angles))


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
