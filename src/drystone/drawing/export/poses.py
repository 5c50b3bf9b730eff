"""poses.json: where every part is picked and placed, how it is held, what it weighs."""

from dataclasses import asdict
from typing import Any

from drystone.drawing.assembly import handling
from drystone.drawing.assembly.handling import Approach, Grasp
from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.export.text import json_text
from drystone.model.frames3d import Pose3d

SCHEMA = "drystone-poses/1"

FRAMES = {
    "convention": "Right-handed, metres. A matrix is 4x4, rows first, and maps points of the part "
    "(S) to the frame of the pose; its columns are the axes and the origin. The quaternion is the "
    "same turn, by name.",
    "W": "Wall. X along the wall to the right, Y into it, Z up; origin at its bottom-left-front "
    "corner. The front face is y = 0. Poses called `place` are in W.",
    "P": "Photo. X to the right and Y up in the picture that the stones were read from, Z out of "
    "it, towards the camera; origin at the picture's bottom-left corner, on the ground that the "
    "stones lie on. Poses called `pick` are in P.",
    "S": "Part. Origin in the middle of its thickness at the centroid that the plan gives; X "
    "and Z as the picture's x and y in the source image, Y into the wall.",
    "pick and place": "A stone lies on its back under the camera: the face that the camera sees "
    "is the one that is seen in the wall's front. It is tilted up by 90 degrees about X, then "
    "turned by -angle_deg about Y of W, which is angle_deg counter-clockwise as seen from the "
    "front, and moved. `pick_to_place` is all of it, P to W: place.matrix times the inverse of "
    "pick.matrix. No part is mirrored.",
    "approach": "The part moves straight along `direction`, over `stand_off_m`, from `start` "
    "(where its origin is then) to its pose. Stones come from above, from clearance_m over "
    "everything that stands there before; wedges are pushed in from the front. `blocked_m` is the "
    "longest horizontal piece of the way down that stones take up which stand already; 0 when the "
    "way is free. Settling moves a stone by a fraction of a px after it was let down, which "
    "shows here.",
    "grasp": "Two parallel jaws across the least width of the outline: how far apart, and the unit "
    "vector across them in S, W and P. `thickness_m` is the other way to hold it, along Y of S.",
    "neighbours": "Ids of what is there already and touches the part when it is placed; 0 is the "
    "ground.",
    "alpha": "Load multipliers of the wall after the step, for a load to the left and to the "
    "right; null when wedges of the stone are still to come.",
}


def poses(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return poses.json."""
    return {"poses.json": lambda: json_text(to_json(assembly)) + "\n"}


def to_json(assembly: Assembly) -> dict[str, Any]:
    """Return what poses.json holds, matrices as arrays; E131 without a scale."""
    plan = assembly.plan
    width_m, height_m = assembly.size
    return {
        "schema": SCHEMA,
        "version": plan.version,
        "source": {key: plan.source.get(key) for key in ("path", "sha256")},
        "method": plan.method,
        "seed": plan.seed,
        "units": {"length": "m", "mass": "kg", "angle": "degree in names with _deg"},
        "px_per_m": assembly.require_scale("poses"),
        "frames": FRAMES,
        "wall": {"width_m": width_m, "height_m": height_m},
        "thickness_m": assembly.thickness,
        "density_kg_m3": assembly.density_kg_m3,
        "clearance_m": handling.CLEARANCE_M,
        "parts": [_part(assembly, part) for part in assembly.parts],
        "unused": list(plan.unused),
    }


def _part(assembly: Assembly, part: Part) -> dict[str, Any]:
    width_m, height_m = part.size
    pick, down = assembly.pick_pose(part), handling.pick_approach(assembly, part)
    return {
        "step": part.step,
        "kind": part.kind,
        "id": part.id,
        "name": part.name,
        "under": part.under,
        "angle_deg": part.angle_deg,
        "flipped": False,
        "place": {
            **_pose(assembly.place_pose(part)),
            "approach": {
                **_named(handling.place_approach(assembly, part)),
                "blocked_m": handling.blocked_m(assembly, part) if part.kind == "stone" else 0.0,
            },
        },
        "pick": pick and down and {**_pose(pick), "approach": _named(down)},
        "pick_to_place": handling.pick_to_place(assembly, part),
        "grasp": {**_named(handling.grasp(assembly, part)), "thickness_m": assembly.thickness},
        "mass_kg": assembly.mass_kg(part),
        "size_m": {"x": width_m, "y": assembly.thickness, "z": height_m},
        "neighbours": handling.touched_when_placed(assembly, part),
        "wedges_after": [wedge.name for wedge in handling.wedges_after(assembly, part)],
        "alpha": {"left": part.plan_step.alpha_left, "right": part.plan_step.alpha_right},
    }


def _pose(pose: Pose3d) -> dict[str, Any]:
    turn = pose.quaternion
    return {
        "point": {"x": pose.x_m, "y": pose.y_m, "z": pose.z_m},
        "quaternion": {"x": turn.x, "y": turn.y, "z": turn.z, "w": turn.w},
        "matrix": pose.matrix,
    }


def _named(thing: Approach | Grasp) -> dict[str, Any]:
    """Return its fields by name, and the parts of its vectors by x, y and z."""
    return {
        name: dict(zip("xyz", value, strict=True)) if isinstance(value, tuple) else value
        for name, value in asdict(thing).items()
    }
