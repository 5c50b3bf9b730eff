"""A planned wall as things to be put together: stones and wedges, and where they touch."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
import shapely

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.drawing.outlines import label_regions, wall_outlines
from drystone.errors import InputError, PlanError, UsageError
from drystone.io.photo_beside import photo_beside
from drystone.io.walls import read_wall
from drystone.kernels.polygons import Points, area_and_centroid, turn
from drystone.model.frames3d import Pose3d, photo_pose, wall_pose
from drystone.model.plan import Plan, Point, StoneStep, WedgeStep
from drystone.model.steps import first_fault, piece_id
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult

if TYPE_CHECKING:
    from drystone.search.plan_result import PlanResult

DENSITY_KG_M3 = 2600.0  # of limestone and sandstone, about; said with every mass


@dataclass(frozen=True, eq=False)
class Part:
    """A stone or a wedge at its place in the wall.

    Parameters
    ----------
    plan_step : StoneStep or WedgeStep
        The step that places it.
    corners : (n, 2) float array
        Its outline in the wall frame, counter-clockwise, not closed, in the unit of the assembly.
    centroid : (float, float)
        Of a stone that of the plan, of a wedge that of its outline.
    """

    plan_step: StoneStep | WedgeStep
    corners: Points
    centroid: Point

    @property
    def step(self) -> int:
        """Number of the step."""
        return self.plan_step.step

    @property
    def kind(self) -> Literal["stone", "wedge"]:
        """What it is."""
        return self.plan_step.kind

    @property
    def id(self) -> int:
        """Of the stone in the input image, or of the wedge in wall.png."""
        return piece_id(self.plan_step)

    @property
    def name(self) -> str:
        """In every output: stone_012, wedge_256."""
        return f"{self.kind}_{self.id:03d}"

    @property
    def angle_deg(self) -> float:
        """How far it is turned from the source image; 0 for a wedge, which is in none."""
        step = self.plan_step
        return step.angle_deg if isinstance(step, StoneStep) else 0.0

    @property
    def under(self) -> int | None:
        """Id of the stone that a wedge is under."""
        return None if isinstance(self.plan_step, StoneStep) else self.plan_step.under

    @property
    def cluster(self) -> int | None:
        """Cluster of a stone."""
        return self.plan_step.cluster if isinstance(self.plan_step, StoneStep) else None

    @cached_property
    def area(self) -> float:
        """Of the outline, in squares of the unit."""
        return area_and_centroid(self.corners)[0]

    @cached_property
    def own_corners(self) -> Points:
        """(n, 2) outline about the centroid, turned back to how it lies in the source image."""
        return turn(self.corners - np.array(self.centroid), -self.angle_deg)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the bounding box as it lies in the source image."""
        width, height = np.ptp(self.own_corners, axis=0).tolist()
        return width, height

    @property
    def length(self) -> float:
        """Longer side of the smallest rectangle around it, turned in any way."""
        around = shapely.oriented_envelope(shapely.Polygon(self.corners))
        sides = np.diff(shapely.get_coordinates(around), axis=0)[:2]
        return float(np.hypot(*sides.T).max())

    @cached_property
    def grip(self) -> tuple[float, float]:
        """Least width between parallel jaws, and the direction across them.

        In the source image: the width in the unit of the assembly, the direction in degrees
        counter-clockwise from x, in [0, 180).
        """
        hull = np.array(shapely.convex_hull(shapely.Polygon(self.own_corners)).exterior.coords)
        edges = np.diff(hull, axis=0)
        across = np.column_stack([-edges[:, 1], edges[:, 0]])
        across /= np.hypot(*across.T)[:, None]
        widths = np.ptp(hull @ across.T, axis=0)
        least = int(np.argmin(widths))
        angle = float(np.degrees(np.arctan2(across[least, 1], across[least, 0]))) % 180.0
        return float(widths[least]), angle


@dataclass(frozen=True, eq=False)
class Assembly:
    """A planned wall: everything that outputs are made of.

    Parameters
    ----------
    plan : Plan
        What it was read from.
    parts : tuple of Part
        In the order of the plan's steps.
    model : RigidBlockModel
        Blocks and interfaces, in the unit of the assembly.
    resistance : LateralResistance
        With mechanisms and forces.
    unit : {"px", "m"}
        Of all lengths.
    px_per_m : float or None
        Source px in a metre.
    thickness : float
        Of the wall, in the unit: what was asked for, or the median square root of the areas of
        the stones.
    density_kg_m3 : float
        Of the stones.
    photo : Path or None
        A picture of the stones in the frame of the source image, at any resolution.

    Notes
    -----
    Lengths in the unit of the assembly have no suffix; what is named ``_m`` is in metres and
    raises E131 when there is no scale.
    """

    plan: Plan
    parts: tuple[Part, ...]
    model: RigidBlockModel
    resistance: LateralResistance
    unit: Literal["px", "m"]
    px_per_m: float | None
    thickness: float
    density_kg_m3: float = DENSITY_KG_M3
    photo: Path | None = None

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the wall as ordered, in the unit."""
        # A plan in px whose scale is told afterwards becomes an assembly in metres.
        metric = self.unit == "m" and self.plan.length_unit == "px"
        factor = 1.0 / (self.px_per_m or 1.0) if metric else 1.0
        return self.plan.width * factor, self.plan.height * factor

    @property
    def px_per_unit(self) -> float:
        """Source px in a unit of the assembly."""
        return self.px_per_m or 1.0 if self.unit == "m" else 1.0

    @property
    def stones(self) -> Iterator[Part]:
        """The stones alone, in order."""
        return (part for part in self.parts if part.kind == "stone")

    @property
    def wedges(self) -> Iterator[Part]:
        """The wedges alone, in order."""
        return (part for part in self.parts if part.kind == "wedge")

    def part(self, part_id: int) -> Part:
        """Return the stone or wedge of an id."""
        return self._by_id[part_id]

    @cached_property
    def _by_id(self) -> dict[int, Part]:
        return {part.id: part for part in self.parts}

    def neighbours(self, part_id: int) -> tuple[int, ...]:
        """Return the ids that a part touches in the finished wall, ascending; 0 is the ground."""
        return tuple(self.model.touched_by(part_id))

    def before(self, part: Part) -> tuple[Part, ...]:
        """Return the parts that stand before this one is placed, in order."""
        return tuple(other for other in self.parts if other.step < part.step)

    def touched_when_placed(self, part: Part) -> tuple[int, ...]:
        """Return the ids that a part meets when it is placed, ascending; 0 is the ground."""
        there = {0} | {other.id for other in self.before(part)}
        return tuple(found for found in self.neighbours(part.id) if found in there)

    def wedges_after(self, part: Part) -> tuple[Part, ...]:
        """Return the wedges that are pushed in under a stone right after it, in order."""
        return tuple(wedge for wedge in self.wedges if wedge.under == part.id)

    def source_corners(self, part: Part) -> Points:
        """Return the outline of a stone where it lies in the source image, px, y up."""
        step = part.plan_step
        if not isinstance(step, StoneStep):
            raise TypeError(f"{part.name} is in no image")
        return np.asarray(part.own_corners * self.px_per_unit + np.array(step.source_centroid))

    def require_scale(self, what: str) -> float:
        """Return the source px in a metre; raise UsageError (E131) when nobody knows."""
        if self.unit == "m" and self.px_per_m is not None:
            return self.px_per_m
        raise UsageError(
            "E131",
            f"{what} is in metres, and this plan has no scale.",
            where=str(self.plan.source.get("path") or "plan"),
            cure="There are three ways to give one: --px-per-m 200; --ruler x1,y1,x2,y2=1.0m, a "
            "length in the source image; or plan from a photograph with markers (drystone "
            "markers, drystone segment).",
        )

    def place_pose(self, part: Part) -> Pose3d:
        """Return where a part stands in the wall (frame W)."""
        self.require_scale("a pose")
        return wall_pose(*part.centroid, self.thickness, part.angle_deg)

    def pick_pose(self, part: Part) -> Pose3d | None:
        """Return where a stone lies in the photo (frame P); None for a wedge."""
        px_per_m = self.require_scale("a pose")
        step = part.plan_step
        if not isinstance(step, StoneStep):
            return None
        x, y = step.source_centroid
        return photo_pose(x / px_per_m, y / px_per_m, self.thickness)

    def mass_kg(self, part: Part) -> float:
        """Return the mass of a part: area times thickness times density."""
        self.require_scale("a mass")
        return part.area * self.thickness * self.density_kg_m3


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
        E131 for another scale than the plan's, or a thickness without a scale; E138 for a scale,
        thickness or density that is not positive and finite.
    """
    told = {"px-per-m": px_per_m, "thickness": thickness_m, "density": density_kg_m3}
    for name, value in told.items():
        if value is not None and not 0.0 < value < math.inf:
            what = f"{value} is not a positive number."
            raise UsageError("E138", what, where=f"--{name}", cure="Give a finite one above 0.")
    path = Path(path)
    folder = path if path.is_dir() else path.parent
    plan, polygons, model = _read(path)
    if px_per_m and plan.px_per_m and abs(px_per_m / plan.px_per_m - 1.0) > 1e-9:
        what = f"the plan is one of {plan.px_per_m:g} px a metre, not {px_per_m:g}."
        cure = "Leave the scale out, or plan again with another one."
        raise UsageError("E131", what, where=str(path), cure=cure)
    scale = plan.px_per_m or px_per_m
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
    blocks = tuple(
        replace(one, area=one.area * factor**2, centroid=(x * factor, y * factor))
        for one, (x, y) in ((block, block.centroid) for block in model.blocks)
    )
    faces = tuple(replace(face, points=face.points * factor) for face in model.interfaces)
    return RigidBlockModel(blocks, faces, model.mu)


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
    """Return a plan, outlines by id and the block model, in the plan's unit."""
    # Pictures are not even looked at: what would be said of them is not about plans.
    wall = read_wall(path) if path.is_dir() or path.suffix.lower() == ".json" else None
    if wall is None or wall.plan is None:
        cure = "Give the plan.json of a plan, or its folder."
        raise InputError("E132", "this is not a drystone plan.", where=str(path), cure=cure)
    # What is made of steps goes by their numbers.
    plan = wall.plan
    fault = first_fault(plan)
    if fault is not None:
        cure = "Give the plan as it was written; `drystone check` lists everything."
        raise PlanError(fault.code, fault.message, where=f"{path}, step {fault.step}", cure=cure)
    if wall.blocks is not None:
        closed = polygons_from_json(wall.blocks)
        opened = {i: c[:-1] if (c[0] == c[-1]).all() else c for i, c in closed.items()}
        return plan, opened, model_from_json(wall.blocks)
    assert wall.labels is not None  # noqa: S101 - a plan without blocks has an image
    per_px = 1.0 / (plan.working_scale * (plan.px_per_m or 1.0))
    outer = {one.id: outer_loop(one.loops) * per_px for one in label_regions(wall.labels)}
    return plan, outer, scaled(model_from_labels(wall.labels, wall.mu).model, per_px)


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
