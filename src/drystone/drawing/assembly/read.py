"""From the files of a plan to its assembly."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import shapely

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.drawing.assembly.parts import DENSITY_KG_M3, Assembly, Part
from drystone.drawing.outlines import label_regions, wall_outlines
from drystone.errors import InputError, PlanError, UsageError
from drystone.io.photo_beside import photo_beside
from drystone.io.walls import GivenWall, read_wall
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.plan import Plan, StoneStep, WedgeStep
from drystone.model.steps import first_fault, piece_id
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult

if TYPE_CHECKING:
    from drystone.search.plan_result import PlanResult


def read_assembly(
    path: str | Path,
    *,
    px_per_m: float | None = None,
    thickness_m: float | None = None,
    density_kg_m3: float = DENSITY_KG_M3,
) -> Assembly:
    """Read a plan with the files beside it.

    Parameters
    ----------
    path : str or Path
        plan.json, or its folder.  Outlines are those of blocks.json; of a plan on pixels they
        follow the pixels of the wall image.
    px_per_m : float, optional
        Scale of a plan that has none.
    thickness_m : float, optional
        Of the wall.
    density_kg_m3 : float
        Of the stones.

    Raises
    ------
    InputError
        E133 when files are missing or do not belong together; E132 for what is no plan.
    PlanError
        E213, E214 for ids or an order of steps that cannot be.
    UsageError
        E131 for another scale than the plan's, or a thickness without a scale.
    """
    path = Path(path)
    folder = path if path.is_dir() else path.parent
    plan, polygons, model = _read(path)
    scale = _scale(plan, px_per_m, path)
    unit: Literal["px", "m"] = "px" if scale is None else "m"
    factor = 1.0 / scale if scale is not None and plan.length_unit == "px" else 1.0
    model, parts = scaled(model, factor), _parts(plan, polygons, factor)
    if thickness_m is not None and unit == "px":
        what = "a thickness is in metres, and this plan has no scale."
        raise UsageError("E131", what, where="--thickness", cure="Add --px-per-m or --ruler.")
    thickness = _usual_thickness(parts) if thickness_m is None else thickness_m
    resistance, photo = lateral_resistance(model, mechanism=True), photo_beside(folder)
    return Assembly(plan, parts, model, resistance, unit, scale, thickness, density_kg_m3, photo)


def assembly_of_result(result: "PlanResult", photo: Path | None = None) -> Assembly:
    """Return the parts of a plan that was just made, in its unit, without reading its files."""
    plan, wall = result.plan, result.wall
    # Models of outlines are in source px, those of pixels in working px.
    exact = wall.outlines is not None
    factor = 1.0 / (wall.site.px_per_m or 1.0) if exact else wall.site.units_per_px
    parts, unit = _parts(plan, wall_outlines(wall), 1.0), plan.length_unit
    model, resistance = scaled(result.model, factor), scaled_resistance(result.resistance, factor)
    thickness = _usual_thickness(parts)
    return Assembly(plan, parts, model, resistance, unit, plan.px_per_m, thickness, photo=photo)


def scaled(model: RigidBlockModel, factor: float) -> RigidBlockModel:
    """Return a model in another unit of length; friction and what carries what stay."""
    blocks = []
    for block in model.blocks:
        x, y = block.centroid
        moved = (x * factor, y * factor)
        blocks.append(replace(block, area=block.area * factor**2, centroid=moved))
    faces = tuple(replace(face, points=face.points * factor) for face in model.interfaces)
    return RigidBlockModel(tuple(blocks), faces, model.mu)


def scaled_resistance(resistance: LateralResistance, factor: float) -> LateralResistance:
    """Return a limit analysis in another unit of length, `factor` of them in an old one.

    Weights are areas, so forces grow by its square; the largest displacement of a mechanism stays
    1, so what turns does so slower in finer units.
    """

    def of(result: LimitResult) -> LimitResult:
        mechanism, forces = result.mechanism, result.forces
        if mechanism is not None:
            velocity = mechanism.velocity * np.array([1.0, 1.0, 1.0 / factor])
            mechanism = replace(mechanism, velocity=velocity)
        forces = None if forces is None else forces * factor**2
        return replace(result, mechanism=mechanism, forces=forces)

    return replace(resistance, left=of(resistance.left), right=of(resistance.right))


def outer_loop(loops: Sequence[Points]) -> Points:
    """Return the outline of the largest piece of a stone's pixels, without its holes.

    A pit that meets the outside at a corner of a pixel is a hole too: an outline with it would
    touch itself, and bound no solid.
    """
    largest = max(loops, key=lambda loop: area_and_centroid(loop)[0])
    polygon = shapely.Polygon(largest)
    if polygon.is_valid:
        return largest
    pieces = shapely.get_parts(shapely.make_valid(polygon))
    whole = shapely.Polygon(max(pieces, key=lambda piece: float(piece.area)).exterior)
    return np.array(shapely.orient_polygons(whole).exterior.coords)[:-1]


def _read(path: Path) -> tuple[Plan, Mapping[int, Points], RigidBlockModel]:
    # Pictures are not even looked at: what would be said of them is not about plans.
    wall = read_wall(path) if path.is_dir() or path.suffix.lower() == ".json" else None
    if wall is None or wall.plan is None:
        raise InputError(
            "E132", "this is not a drystone plan.", where=str(path),
            cure="Give the plan.json of a plan, or its folder.",
        )  # fmt: skip
    # What is made of steps goes by their numbers.
    fault = first_fault(wall.plan)
    if fault is not None:
        cure = "Give the plan as it was written; `drystone check` lists everything."
        raise PlanError(fault.code, fault.message, where=f"{path}, step {fault.step}", cure=cure)
    return wall.plan, *_shapes(wall, wall.plan)


def _scale(plan: Plan, px_per_m: float | None, path: Path) -> float | None:
    if px_per_m is None or plan.px_per_m is None:
        return px_per_m or plan.px_per_m
    if abs(px_per_m / plan.px_per_m - 1.0) > 1e-9:
        what = f"the plan is one of {plan.px_per_m:g} px a metre, not {px_per_m:g}."
        cure = "Leave the scale out, or plan again with another one."
        raise UsageError("E131", what, where=str(path), cure=cure)
    return plan.px_per_m


def _shapes(wall: GivenWall, plan: Plan) -> tuple[Mapping[int, Points], RigidBlockModel]:
    """Return outlines by id and the block model, in the plan's unit."""
    if wall.blocks is not None:
        closed = polygons_from_json(wall.blocks)
        opened = {i: c[:-1] if (c[0] == c[-1]).all() else c for i, c in closed.items()}
        return opened, model_from_json(wall.blocks)
    assert wall.labels is not None  # noqa: S101 - a plan without blocks has an image
    per_px = 1.0 / (plan.working_scale * (plan.px_per_m or 1.0))
    loops = {region.id: region.loops for region in label_regions(wall.labels)}
    outer = {i: outer_loop(found) * per_px for i, found in loops.items()}
    return outer, scaled(model_from_labels(wall.labels, wall.mu).model, per_px)


def _parts(plan: Plan, outlines: Mapping[int, Points], factor: float) -> tuple[Part, ...]:
    def part(step: StoneStep | WedgeStep) -> Part:
        outline = np.asarray(outlines[piece_id(step)] * factor)
        outline.flags.writeable = False
        if isinstance(step, StoneStep):
            return Part(step, outline, (step.centroid[0] * factor, step.centroid[1] * factor))
        _, x, y = area_and_centroid(outline)
        return Part(step, outline, (x, y))

    return tuple(map(part, plan.steps))


def _usual_thickness(parts: tuple[Part, ...]) -> float:
    sides = [float(np.sqrt(part.area)) for part in parts if part.kind == "stone"]
    return float(np.median(sides)) if sides else 1.0
