"""What a robot does with a part: where it holds it and how it comes to its place."""

import math
from typing import Any

import numpy as np
import shapely

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.kernels.polygons import Points
from drystone.model.frames3d import DOWN, Matrix, Pose3d, Vector
from drystone.model.overlap import common_parts

CLEARANCE_M = 0.05  # how far above everything else a part is when it begins to be lowered
_APART_M = 1e-9  # what a part rests on is not in its way
INWARD: Vector = (0.0, 1.0, 0.0)
"""How a wedge is pushed in, in W: from the front, where nothing is in the way."""


Named = dict[str, Any]
"""As poses.json has it: vectors by x, y and z."""


def grasp(assembly: Assembly, part: Part) -> Named:
    """Return how two parallel jaws hold a part across its least width; E131 without a scale.

    Unit vectors across them are in S, W and P; only a stone has one in the photo (P).
    """
    place, pick = assembly.place_pose(part), assembly.pick_pose(part)
    width_m, across_deg = part.grip
    across = math.radians(across_deg)
    own = np.array([math.cos(across), 0.0, math.sin(across)])
    return {
        "width_m": width_m,
        "direction_part": _xyz(own),
        "direction_wall": _xyz(place.rotation @ own),
        "direction_photo": None if pick is None else _xyz(pick.rotation @ own),
    }


def place_approach(assembly: Assembly, part: Part) -> Named:
    """Return how a part comes to its place.

    A stone comes from above: it is lowered from where its lowest point is CLEARANCE_M above the
    highest point of what was built before.  A wedge goes in from the front.
    """
    pose = assembly.place_pose(part)
    if part.kind == "wedge":
        return _approach(pose, INWARD, assembly.thickness + CLEARANCE_M)
    top = max((float(other.corners[:, 1].max()) for other in before(assembly, part)), default=0.0)
    lowest = float(part.corners[:, 1].min())
    return _approach(pose, DOWN, max(top - lowest, 0.0) + CLEARANCE_M)


def pick_approach(assembly: Assembly, part: Part) -> Named | None:
    """Return how a tool comes to a stone in the photo: from above all others; None for a wedge."""
    pose = assembly.pick_pose(part)
    return None if pose is None else _approach(pose, DOWN, assembly.thickness + CLEARANCE_M)


def pick_to_place(assembly: Assembly, part: Part) -> Matrix | None:
    """Return the (4, 4) transform of a stone from photo (P) to wall (W); None for a wedge."""
    pick = assembly.pick_pose(part)
    if pick is None:
        return None
    back = np.eye(4)
    back[:3, :3] = pick.rotation.T
    back[:3, 3] = -pick.rotation.T @ pick.matrix[:3, 3]
    return np.asarray(assembly.place_pose(part).matrix @ back) + 0.0


def before(assembly: Assembly, part: Part) -> tuple[Part, ...]:
    """Return the parts that stand before this one is placed, in order."""
    return tuple(other for other in assembly.parts if other.step < part.step)


def touched_when_placed(assembly: Assembly, part: Part) -> tuple[int, ...]:
    """Return the ids that a part meets when it is placed, ascending; 0 is the ground."""
    there = {0} | {other.id for other in before(assembly, part)}
    return tuple(found for found in assembly.neighbours(part.id) if found in there)


def wedges_after(assembly: Assembly, part: Part) -> tuple[Part, ...]:
    """Return the wedges that are pushed in under a stone right after it, in order."""
    return tuple(wedge for wedge in assembly.wedges if wedge.under == part.id)


def blocked_m(assembly: Assembly, part: Part) -> float:
    """Return the longest horizontal piece of a stone's way down that stands already, 0.0 if free.

    With ``reach = "above"`` stones were lowered along this way and then settled, which moves them
    by a fraction of a px; with ``reach = "any"`` they may have come from the side.
    """
    lift = place_approach(assembly, part)["stand_off_m"]
    way = swept(part.corners + np.array([0.0, _APART_M]), lift)
    others = [shapely.Polygon(other.corners) for other in before(assembly, part)]
    boxes = [piece.bounds for other in others for piece in common_parts(way, other)]
    return max((right - left for left, _, right, _ in boxes), default=0.0)


def swept(low: Points, lift: float) -> shapely.Geometry:
    """Return what an outline passes when it is lifted straight up."""
    high = low + np.array([0.0, lift])
    following = np.roll(np.arange(len(low)), -1)
    sides = np.stack([low, low[following], high[following], high], axis=1)
    whole = [shapely.Polygon(low), shapely.Polygon(high), *shapely.polygons(sides)]
    return shapely.union_all([shape for shape in whole if shape.area > 0.0])


def _approach(pose: Pose3d, direction: Vector, length_m: float) -> Named:
    """Return a straight move to a pose, from `start` in the frame of it; the part does not turn."""
    start = np.array([pose.x_m, pose.y_m, pose.z_m]) - length_m * np.array(direction)
    return {"direction": _xyz(direction), "stand_off_m": length_m, "start": _xyz(start)}


def _xyz(values: Matrix | Vector) -> dict[str, float]:
    return {name: float(value) + 0.0 for name, value in zip("xyz", values, strict=True)}
