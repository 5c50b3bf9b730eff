"""The stones and wedges of a plan as parts, and where they touch."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

import numpy as np
import shapely

from drystone.errors import UsageError
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.kernels.raster import turn
from drystone.model.frames3d import Pose3d, photo_pose, wall_pose
from drystone.model.plan import Plan, Point, StoneStep, WedgeStep
from drystone.model.steps import piece_id
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LateralResistance

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
        found = set()
        for interface in self.model.interfaces:
            pair = interface.block, interface.other
            if part_id in pair:
                found |= set(pair) - {part_id}
        return tuple(sorted(found))

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
