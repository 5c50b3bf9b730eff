"""A plan that was just made as an assembly, without reading its files."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.assembly.read import scaled
from drystone.drawing.outlines import wall_outlines
from drystone.drawing.report.view_statics import scaled_resistance
from drystone.drawing.report.viewer_data import View, view_of_assembly
from drystone.errors import Notice
from drystone.kernels.polygons import area_and_centroid
from drystone.model.plan import StoneStep
from drystone.search.plan_result import PlanResult


def assembly_of_result(result: PlanResult, photo: Path | None = None) -> Assembly:
    """Return the parts of a plan in its unit.

    Parameters
    ----------
    result : PlanResult
        From :func:`drystone.plan_wall`.
    photo : Path, optional
        A picture of the stones in the frame of the source image.

    Notes
    -----
    The thickness of the wall is the median square root of the areas of its stones.
    """
    plan, site = result.plan, result.wall.site
    # Models of outlines are in source px, those of pixels in working px.
    exact = result.wall.outlines is not None
    factor = 1.0 / (site.px_per_m or 1.0) if exact else site.units_per_px
    outlines = wall_outlines(result.wall)
    parts = []
    for step in plan.steps:
        corners = outlines[step.stone if isinstance(step, StoneStep) else step.id]
        centroid = step.centroid if isinstance(step, StoneStep) else area_and_centroid(corners)[1:]
        parts.append(Part(step, corners, (float(centroid[0]), float(centroid[1]))))
    sides = [np.sqrt(part.area) for part in parts if part.kind == "stone"]
    return Assembly(
        plan,
        tuple(parts),
        scaled(result.model, factor),
        scaled_resistance(result.resistance, factor),
        plan.length_unit,
        plan.px_per_m,
        float(np.median(sides)) if sides else 1.0,
        photo=photo,
    )


def view_of_result(
    result: PlanResult,
    *,
    photo: Path | None = None,
    notices: Sequence[Notice] | None = None,
) -> View:
    """Show a plan that was just made.

    Parameters
    ----------
    result : PlanResult
        From :func:`drystone.plan_wall`.
    photo : Path, optional
        A picture of the stones in the frame of the source image.
    notices : sequence of Notice, optional
        Those of reading the stones and of planning; the result's alone when missing.
    """
    return view_of_assembly(
        assembly_of_result(result, photo),
        notices=result.notices if notices is None else notices,
        timings={"planning": result.seconds},
    )
