"""The method itself: Table 1, and Figs. 3, 4, 10 and 11 on a real run."""

from collections.abc import Iterator, Mapping
from itertools import islice
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.palette import CLUSTER_COLOURS
from drystone.drawing.pictures.forces import plot_forces
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
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance
from drystone_lab.pictures.walls import plot_walls, sheet_of, stones_panel, wall_panel
from drystone_lab.reproduce.cells import rounded
from drystone_lab.reproduce.construction import Construction, construction
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem
from drystone_lab.table import Rows
from drystone_lab.walls import PR, Target

ROWS: Mapping[str, tuple[str, int, tuple[str, ...]]] = {
    "packing": ("tight packing", 6, ("paper",)),
    "course": ("straight course", 3, ("paper",)),
    "interlocking": ("interlocking", 4, ("paper", "thangavelu")),
    "wedging": ("wedging", 1, ("paper",)),
    "footing": ("stable footing", 3, ()),
    "sloping": ("inward sloping", 4, ("paper", "liu2021")),
    "gravity": ("gravity", 6, ("paper", "johns", "liu2021")),
    "lateral": ("lateral load", 3, ("paper", "thangavelu", "liu2018")),
}
"""Rows of Table 1: name, number of marks, and whose they are as far as the text says it."""


def _table1(_: object) -> Rows:
    for part, (name, count, said) in ROWS.items():
        whose = (
            ["paper"] * (policy in said) + ["ours"] * (part in MARKS[policy]) for policy in MARKS
        )
        yield name, count, *map(" and ".join, whose)


TABLE1 = PaperItem(
    study=lambda _: SimpleNamespace(engine=" and ".join(ENGINE)),
    tables={"table1": _table1},
)


def _steps(run: Construction) -> Rows:
    area = float(run.wall.site.width_px * run.wall.site.height_px)
    filled = 0.0
    for number, stage in enumerate(run.stages, 1):
        placement = stage.group.placement
        filled += placement.posed.area_px / area
        yield (
            number, placement.stone_id, run.workshop.clusters[placement.stone_id],
            placement.posed.angle_deg, placement.rotation_moves, len(stage.group.wedges),
            rounded(filled),
        )  # fmt: skip


def _workflow(run: Construction) -> Iterator[ItemFigure]:
    stones, count = run.workshop.stones, len(run.stages)
    walls = [
        (f"after {number} stones", run.stages[number - 1].after, run.workshop.clusters)
        for number in sorted({1, max(1, count // 3), max(1, 2 * count // 3), count})
    ]
    yield ItemFigure("fig3", plot_walls(walls, 2), {"placed": count, "count": len(stones)})
    free = "the landscape before the first stone: free between its bounds"
    panels = [
        stones_panel("the stones", stones, run.workshop.clusters),
        wall_panel(free, Wall.empty(run.wall.site), {}),
    ]
    yield ItemFigure("fig4", sheet_of(panels, 2))


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
    yield Claimed("sliding", holds, {"alpha": alpha, "mu": mu})


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
