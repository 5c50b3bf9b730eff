"""The stones and wedges of a plan as polygons, from its poses alone."""

from collections.abc import Mapping, Sequence

import numpy as np
import shapely

from drystone.errors import PlanError
from drystone.kernels.polygons import Points
from drystone.model.outlines import Outlined
from drystone.model.overlap import common_parts, shape_of
from drystone.model.plan import Plan, WedgeStep
from drystone.model.site import Site
from drystone.model.steps import Step, grouped, piece_id
from drystone.model.stone import OUTLINE_TOLERANCE_PX, StoneSet
from drystone.verify.lengths import plan_settings, plan_site, source_points
from drystone.verify.replay import settled_stone

NO_AREA_PX = 1e-9
"""A polygon with an area below this, in square px, has none but for rounding."""


def plan_polygons(plan: Plan, stones: StoneSet) -> tuple[tuple[Outlined, ...], ...]:
    """Return every stone, its wedges after it, where the plan puts them, in the order of placement.

    Corners (n, 2) are in the wall frame, source px, counter-clockwise and not closed.  A stone is
    its outline, also when the plan was made on the raster; what overlaps is not pushed apart. Steps
    that place nothing are left out: stones that are not there (E212), ids that came before (E213),
    polygons without an area (E222).  PlanError E215 as for the replay.
    """
    settings, _ = plan_settings(plan)
    exact = settings.geometry == "exact"
    outline_px = settings.settle.outline_px if exact else OUTLINE_TOLERANCE_PX
    site = plan_site(plan)
    found: list[tuple[Outlined, ...]] = []
    used: set[int] = set()
    for steps in grouped(plan.steps)[0]:
        group = []
        for step in steps:
            corners = None
            if piece_id(step) not in used:
                corners = _corners(step, stones, site, outline_px)
            if corners is not None:
                used.add(piece_id(step))
                group.append((piece_id(step), corners))
        if group:
            found.append(tuple(group))
    return tuple(found)


def common_areas(polygons: Mapping[int, Points], blocks: Sequence[int]) -> tuple[Points, ...]:
    """Return what the given blocks have in common with any others, as polygons."""
    shapes = {block: shape_of(corners) for block, corners in polygons.items()}
    areas: list[shapely.Polygon] = []
    for block in blocks:
        for other, shape in shapes.items():
            # Of two that are both asked for only one comes first.
            if other != block and not (other in blocks and other < block):
                areas += common_parts(shapes[block], shape)
    return tuple(map(_ring, areas))


def _corners(step: Step, stones: StoneSet, site: Site, outline_px: float) -> Points | None:
    """Return the polygon of a step; None when there is none."""
    if isinstance(step, WedgeStep):
        return _simple(source_points(step.polygon, site)) if len(step.polygon) > 2 else None
    try:
        return _simple(settled_stone(step, stones, site, outline_px).corners)
    except PlanError:
        # E201: the plan names a stone that is not there; the caller sees that it is missing.
        return None


def _simple(corners: Points) -> Points | None:
    """Return the polygon, or the largest part of one that crosses itself."""
    shape = shapely.Polygon(corners)
    if shape.is_valid and shape.exterior.is_ccw:
        return corners
    largest = max(shapely.get_parts(shape_of(corners)), key=lambda part: part.area, default=None)
    return None if largest is None or largest.area < NO_AREA_PX else _ring(largest)


def _ring(shape: shapely.Polygon) -> Points:
    return np.asarray(shapely.get_coordinates(shapely.orient_polygons(shape).exterior)[:-1])
