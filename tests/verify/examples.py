"""Small walls made by hand, with plans that claim what is true of them."""

from dataclasses import dataclass, replace

import numpy as np

from drystone.clusters import cluster_stones
from drystone.contacts.blocks import model_from_labels
from drystone.kernels.outline import pixel_polygon
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Side, Wedge
from drystone.model.plan import Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.stone import Source, Stone, StoneSet
from drystone.model.wall import Wall
from drystone.planner.assemble import Frame, plan_metrics
from drystone.planner.build import Build
from drystone.planner.evaluate import action_indices
from drystone.planner.settings import PlannerSettings
from drystone.poses import PoseBook
from drystone.statics.limit import lateral_resistance

SETTINGS = PlannerSettings(orientations="quarter", two_sided=True)
WEDGE, SLAB, L_STONE = 301, 7, 12
NARROWEST_PX = 4
"""Of the stones below: stone 9 is 4 px wide."""


@dataclass(frozen=True)
class Example:
    """A plan that is true, its stones and its wall."""

    plan: Plan
    stones: StoneSet
    wall: Wall


def stone_set() -> StoneSet:
    """Two pillars of different height, a slab, an L, and a small stone that is not used."""
    l_shape = np.ones((8, 12), bool)
    l_shape[:4, 6:] = False
    masks = {
        3: np.ones((20, 20), bool),
        5: np.ones((16, 20), bool),
        SLAB: np.ones((6, 40), bool),
        L_STONE: l_shape,
        300: np.ones((10, 12), bool),
        9: np.ones((4, 4), bool),
    }
    stones, left = [], 2
    for stone_id, mask in masks.items():
        stones.append(Stone(stone_id, mask, left_px=left, bottom_px=3))
        left += mask.shape[1] + 2
    return StoneSet(tuple(stones), Source("stones.png", "ab" * 32, left, 30))


def example(scale: float = 1.0, px_per_m: float | None = None) -> Example:
    """Return a slab on two pillars with a wedge on the lower one, an L beside them turned by 90.

    At a scale of 1 the site is 84 x 30 px; other scales must keep all edges on whole px.
    """
    stones, site = stone_set(), Site.from_source(84, 30, scale, px_per_m)
    built = Wall.empty(site)
    for stone_id, angle_deg, left, bottom in (
        (3, 0.0, 0, 0),
        (5, 0.0, 40, 0),
        (SLAB, 180.0, 10, 20),
        (L_STONE, 90.0, 64, 0),
        (300, -90.0, 74, 0),
    ):
        posed = PoseBook(scale).pose(stones.by_id(stone_id), angle_deg)
        row = site.height_px - round(bottom * scale) - posed.height_px
        side: Side = "right" if stone_id == 300 else "left"
        wedges: tuple[Wedge, ...] = ()
        if stone_id == SLAB:
            shape, at = np.array([[4, 8], [14 - 4, 42]]) * scale
            mask = np.ones(shape.astype(int), bool)
            wedges = (Wedge(WEDGE, SLAB, mask, int(at[0]), int(at[1])),)
        built = built.add(Placement(posed, row, round(left * scale), side), wedges)
    return Example(true_plan(built, stones), stones, built)


def true_plan(built: Wall, stones: StoneSet) -> Plan:
    """Return a plan of a wall that claims what is true of it."""
    site, settings = built.site, SETTINGS
    clusters = cluster_stones(stones, PoseBook(site.scale), settings.clusters)
    steps: list[StoneStep | WedgeStep] = []
    wall = Wall.empty(site)
    for group in built.groups:
        placement = group.placement
        before, wall = wall, wall.add(placement, group.wedges)
        carried = lateral_resistance(model_from_labels(wall.labels, settings.mu).model)
        indices, course_height = action_indices(
            Landscape.of(before, placement.side),
            group,
            carried,
            11.5 * site.scale,
            NARROWEST_PX * site.scale,
        )
        x, y = placement.centroid(site.height_px)
        unit = site.units_per_px
        steps.append(
            StoneStep(
                step=len(steps) + 1,
                stone=placement.stone_id,
                angle_deg=placement.posed.angle_deg,
                source_centroid=placement.posed.stone.centroid,
                centroid=(x * unit, y * unit),
                side=placement.side,
                cluster=clusters[placement.stone_id],
                rotation_moves=0,
                indices=indices.as_dict(),
                course_height=None if course_height is None else course_height * unit,
                alpha_left=None,
                alpha_right=None,
            )
        )
        for wedge in group.wedges:
            bottom = site.height_px - wedge.row - wedge.mask.shape[0]
            corners = (pixel_polygon(wedge.mask) + np.array([wedge.col, bottom])) * unit
            polygon = tuple((float(x), float(y)) for x, y in corners)
            steps.append(WedgeStep(len(steps) + 1, wedge.id, wedge.under, polygon, None, None))
        steps[-1] = replace(
            steps[-1], alpha_left=carried.left.alpha, alpha_right=carried.right.alpha
        )
    return _plan(built, stones, steps)


def _plan(built: Wall, stones: StoneSet, steps: list[StoneStep | WedgeStep]) -> Plan:
    site, source = built.site, stones.source
    placed = {placement.stone_id for placement in built.placements}
    to_units = site.units_per_px * site.scale
    return Plan(
        version="0.1.0",
        method="paper",
        seed=1,
        settings=SETTINGS.as_dict(),
        length_unit="m" if site.px_per_m else "px",
        px_per_m=site.px_per_m,
        working_scale=site.scale,
        source={
            "path": source.path,
            "sha256": source.sha256,
            "stones": len(stones),
            "width_px": source.width_px,
            "height_px": source.height_px,
        },
        width=84 * to_units,
        height=30 * to_units,
        steps=tuple(steps),
        unused=tuple(stone.id for stone in stones if stone.id not in placed),
        stopped="all stones that fit are placed",
        metrics=_metrics(built),
    )


def _metrics(built: Wall) -> PlanMetrics:
    model = model_from_labels(built.labels, SETTINGS.mu).model
    frame = Frame(84, 30, built.site)
    return plan_metrics(Build(built, model), frame, lateral_resistance(model))
