"""What robots read: poses.json, assembly.compas.json, scene.yaml and wall.scene, urdf/.

assembly.compas.json is plain JSON that ``compas.json_load`` reads.  scene.yaml is a
``moveit_msgs/PlanningScene`` message that adds the parts (is_diff), wall.scene the text format that
MoveIt and its RViz plugin import; objects come in the order of building.  In the URDF links have
the frame S of their part; fixed joints to the link ``wall``, whose frame is W, hold them at their
places.  Its meshes are binary STL in metres, named relative to it.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import shapely

from drystone.drawing.assembly import Assembly, Part
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.export.solids import Solid, inertia, material, solid_of_part, stl_bytes
from drystone.io.json_text import json_text, number
from drystone.model.frames3d import DOWN, Matrix, Pose3d, Vector
from drystone.model.overlap import common_parts, shape_of

FRAMES = {
    "convention": "Right-handed, metres. A matrix is 4x4, rows first, and maps points of the part "
    "(S) to the frame of the pose; its columns are the axes and the origin. The quaternion is the "
    "same turn, by name.",
    "W": "Wall. X along the wall to the right, Y into it, Z up; origin at its bottom-left-front "
    "corner. The front face is y = 0. Poses called `place` are in W.",
    "P": "Photo. X to the right and Y up in the picture that the stones were read from, Z out of "
    "it, towards the camera; origin at the picture's bottom-left corner, on the ground that the "
    "stones lie on. Poses called `pick` are in P.",
    "M": "Marker. Origin in its middle, X to the right and Y up in its print, Z out of it, as "
    "OpenCV has it. `P_from_marker` is where the frame of one marker is in P, as a matrix; null "
    "when the photograph has none. `markers` has the corners of all in P, metres, from the upper "
    "left of the print, clockwise.",
    "S": "Part. Origin in the middle of its thickness at the centroid that the plan gives; X "
    "and Z as the picture's x and y in the source image, Y into the wall.",
    "pick and place": "A stone lies on its back under the camera: the face that the camera sees "
    "is the one that is seen in the wall's front. It is tilted up by 90 degrees about X, turned "
    "by -angle_deg about Y of W, and moved. Seen from the front that is a turn by angle_deg, "
    "counter-clockwise. `pick_to_place` is all of it, P to W: place.matrix times the inverse of "
    "pick.matrix. No part is mirrored.",
    "approach": "The part moves straight along `direction`, over `stand_off_m`, from `start` "
    "(where its origin is then) to its pose. Stones come from above, from clearance_m over "
    "everything that stands there before; wedges are pushed in from the front. `blocked_m` is the "
    "longest horizontal piece of the way down that is blocked by stones already placed; 0 when the "
    "way is free. Settling moves a stone by a fraction of a px after it was let down, which "
    "shows here.",
    "grasp": "Two parallel jaws across the least width of the outline: how far apart, and the unit "
    "vector across them in S, W and P. `thickness_m` is the other way to hold it, along Y of S.",
    "neighbours": "Ids of what is there already and touches the part when it is placed; 0 is the "
    "ground.",
    "alpha": "Load multipliers of the wall after the step, for a load to the left and to the "
    "right; null when wedges of the stone are still to come.",
}

CLEARANCE_M = 0.05  # how far above everything else a part is when it begins to be lowered
_APART_M = 1e-9  # what a part rests on is not in its way
INWARD: Vector = (0.0, 1.0, 0.0)  # how a wedge is pushed in, in W

BASE = "wall"  # name of the frame W, which in ROS a static transform places
AT_THE_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def poses(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return poses.json: where every part is picked and placed, how it is held, its mass."""
    plan = assembly.plan
    width_m, height_m = assembly.size
    photograph = plan.source.get("photograph") or {}
    made = {
        "schema": "drystone-poses/1",
        "version": plan.version,
        "source": {key: plan.source.get(key) for key in ("path", "sha256")},
        "method": plan.method,
        "seed": plan.seed,
        "units": {"length": "m", "mass": "kg", "angle": "degree in names with _deg"},
        "px_per_m": assembly.px_per_m,
        "frames": FRAMES,
        "markers": photograph.get("markers", []),
        "P_from_marker": photograph.get("P_from_marker"),
        "wall": {"width_m": width_m, "height_m": height_m},
        "thickness_m": assembly.thickness,
        "density_kg_m3": assembly.density_kg_m3,
        "clearance_m": CLEARANCE_M,
        "parts": [_handled(assembly, part) for part in assembly.parts],
        "unused": list(plan.unused),
    }
    return {"poses.json": json_text(made) + "\n"}


def _handled(assembly: Assembly, part: Part) -> dict[str, Any]:
    width_m, height_m = part.size
    place, pick = assembly.place_pose(part), assembly.pick_pose(part)
    # A unit vector across the jaws, in S.
    jaws_m, across_deg = part.grip
    across = math.radians(across_deg)
    own = np.array([math.cos(across), 0.0, math.sin(across)])
    picked = to_wall = own_in_photo = None
    if pick is not None:
        # From above all others.
        down = _approach(pick, DOWN, assembly.thickness + CLEARANCE_M)
        picked = {**_posed(pick), "approach": down}
        back = np.eye(4)
        back[:3, :3] = pick.rotation.T
        back[:3, 3] = -pick.rotation.T @ pick.matrix[:3, 3]
        to_wall = place.matrix @ back + 0.0
        own_in_photo = _xyz(pick.rotation @ own)
    blocked = blocked_m(assembly, part) if part.kind == "stone" else 0.0
    approach = {**place_approach(assembly, part), "blocked_m": blocked}
    return {
        **_names(part),
        "under": part.under,
        "angle_deg": part.angle_deg,
        "flipped": False,
        "place": {**_posed(place), "approach": approach},
        "pick": picked,
        "pick_to_place": to_wall,
        "grasp": {
            "width_m": jaws_m,
            "direction_part": _xyz(own),
            "direction_wall": _xyz(place.rotation @ own),
            "direction_photo": own_in_photo,
            "thickness_m": assembly.thickness,
        },
        "mass_kg": assembly.mass_kg(part),
        "size_m": {"x": width_m, "y": assembly.thickness, "z": height_m},
        "neighbours": assembly.touched_when_placed(part),
        "wedges_after": [wedge.name for wedge in assembly.wedges_after(part)],
        "alpha": {"left": part.plan_step.alpha_left, "right": part.plan_step.alpha_right},
    }


def _names(part: Part) -> dict[str, Any]:
    return {name: getattr(part, name) for name in ("step", "kind", "id", "name")}


def _posed(pose: Pose3d) -> dict[str, Any]:
    point = {"x": pose.x_m, "y": pose.y_m, "z": pose.z_m}
    return {"point": point, "quaternion": asdict(pose.quaternion), "matrix": pose.matrix}


def place_approach(assembly: Assembly, part: Part) -> dict[str, Any]:
    """Return how a part comes to its place, as `FRAMES` says of an approach."""
    pose = assembly.place_pose(part)
    if part.kind == "wedge":
        return _approach(pose, INWARD, assembly.thickness + CLEARANCE_M)
    top = max((float(other.corners[:, 1].max()) for other in assembly.before(part)), default=0.0)
    lowest = float(part.corners[:, 1].min())
    return _approach(pose, DOWN, max(top - lowest, 0.0) + CLEARANCE_M)


def blocked_m(assembly: Assembly, part: Part) -> float:
    """Return the longest horizontal piece of a stone's way down that stands already, 0.0 if free.

    With ``reach = "above"`` stones were lowered along this way and then settled, which moves them
    by a fraction of a px; with ``reach = "any"`` they may have come from the side.
    """
    lift = place_approach(assembly, part)["stand_off_m"]
    low = part.corners + np.array([0.0, _APART_M])
    high = low + np.array([0.0, lift])
    following = np.roll(np.arange(len(low)), -1)
    sides = np.stack([low, low[following], high[following], high], axis=1)
    whole = [shape_of(low), shape_of(high), *shapely.polygons(sides)]
    way = shapely.union_all([shape for shape in whole if shape.area > 0.0])
    others = [shape_of(other.corners) for other in assembly.before(part)]
    boxes = [piece.bounds for other in others for piece in common_parts(way, other)]
    return max((right - left for left, _, right, _ in boxes), default=0.0)


def _approach(pose: Pose3d, direction: Vector, length_m: float) -> dict[str, Any]:
    """Return a straight move to a pose, from `start` in the frame of it; the part does not turn."""
    start = np.array([pose.x_m, pose.y_m, pose.z_m]) - length_m * np.array(direction)
    return {"direction": _xyz(direction), "stand_off_m": length_m, "start": _xyz(start)}


def _xyz(values: Matrix | Vector) -> dict[str, float]:
    return {name: float(value) + 0.0 for name, value in zip("xyz", values, strict=True)}


def compas(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return assembly.compas.json, of whose frames and meshes COMPAS makes objects.

    An element's `mesh` is in its own frame S, `place` and `pick` are where S is in W and in P.
    """
    made = {
        "schema": "drystone-compas/1",
        "version": assembly.plan.version,
        "units": "m",
        "thickness_m": assembly.thickness,
        "density_kg_m3": assembly.density_kg_m3,
        "elements": [
            {
                **_names(part),
                "place": compas_frame(assembly.place_pose(part)),
                "pick": compas_frame(assembly.pick_pose(part)),
                "mesh": compas_mesh(solid_of_part(assembly, part), part.name),
                "mass_kg": assembly.mass_kg(part),
                "neighbours": assembly.touched_when_placed(part),
            }
            for part in assembly.parts
        ],
    }
    return {"assembly.compas.json": json_text(made) + "\n"}


def compas_frame(pose: Pose3d | None) -> dict[str, Any] | None:
    """Return a pose as the data of a ``compas.geometry.Frame``."""
    if pose is None:
        return None
    point = [pose.x_m, pose.y_m, pose.z_m]
    axes = {"xaxis": list(pose.xaxis), "yaxis": list(pose.yaxis)}
    return {"dtype": "compas.geometry/Frame", "data": {"point": point, **axes}}


def compas_mesh(solid: Solid, name: str) -> dict[str, Any]:
    """Return a solid as the data of a ``compas.datastructures.Mesh``."""
    points, faces = solid.vertices.tolist(), solid.triangles.tolist()
    data = {
        "attributes": {},
        "default_vertex_attributes": dict.fromkeys("xyz", 0.0),
        "default_edge_attributes": {},
        "default_face_attributes": {},
        "vertex": {str(i): dict(zip("xyz", p, strict=True)) for i, p in enumerate(points)},
        "face": {str(i): face for i, face in enumerate(faces)},
        "facedata": {str(i): {} for i in range(len(faces))},
        "edgedata": {},
        "max_vertex": len(points) - 1,
        "max_face": len(faces) - 1,
    }
    return {"dtype": "compas.datastructures/Mesh", "data": data, "name": name}


def moveit(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return both files of a planning scene."""
    made = {"scene.yaml": yaml_lines(assembly), "wall.scene": scene_lines(assembly)}
    return {name: "\n".join(lines) + "\n" for name, lines in made.items()}


def yaml_lines(assembly: Assembly) -> Iterator[str]:
    """Return the message; a block subset of YAML with floats that every reader takes for floats.

    `operation` is left out: its default, 0, adds an object.
    """
    yield f"# drystone {assembly.plan.version}: moveit_msgs/PlanningScene, metres, frame W"
    yield from ("name: drystone_wall", "is_diff: true", "robot_state: {is_diff: true}", "world:")
    yield "  collision_objects:"
    for part in assembly.parts:
        solid = solid_of_part(assembly, part)
        yield f"  # step {part.step}"
        yield f"  - header: {{frame_id: {BASE}}}"
        yield f"    id: {part.name}"
        yield f"    pose: {_yaml_pose(*_seven(assembly.place_pose(part)))}"
        yield from ("    meshes:", "    - triangles:")
        for corners in solid.triangles.tolist():
            yield f"      - {{vertex_indices: {corners}}}"
        yield "      vertices:"
        for vertex in solid.vertices.tolist():
            yield f"      - {_fields('xyz', vertex)}"
        yield "    mesh_poses:"
        yield f"    - {_yaml_pose(*AT_THE_ORIGIN)}"
    yield "object_colors:"
    for part in assembly.parts:
        yield f"- {{id: {part.name}, color: {_fields('rgba', (*material(part)[1], 1.0))}}}"


def scene_lines(assembly: Assembly) -> Iterator[str]:
    """Return the wall in MoveIt's text format with object poses and subframes (none)."""
    yield "drystone_wall"
    for part in assembly.parts:
        pose, solid = _seven(assembly.place_pose(part)), solid_of_part(assembly, part)
        yield from (f"* {part.name}", _row(*pose[:3]), _row(*pose[3:]), "1", "mesh")
        yield f"{len(solid.vertices)} {len(solid.triangles)}"
        yield from (_row(*vertex) for vertex in solid.vertices.tolist())
        yield from (f"{a} {b} {c}" for a, b, c in solid.triangles.tolist())
        yield from (_row(*AT_THE_ORIGIN[:3]), _row(*AT_THE_ORIGIN[3:]))
        yield from (_row(*material(part)[1], 1.0), "0")
    yield "."


def _seven(pose: Pose3d) -> tuple[float, ...]:
    return pose.x_m, pose.y_m, pose.z_m, *asdict(pose.quaternion).values()


def _yaml_pose(*seven: float) -> str:
    at, turn = _fields("xyz", seven[:3]), _fields("xyzw", seven[3:])
    return f"{{position: {at}, orientation: {turn}}}"


def _fields(names: str, values: Iterable[float]) -> str:
    pairs = zip(names, values, strict=True)
    return "{" + ", ".join(f"{name}: {number(value)}" for name, value in pairs) + "}"


def urdf(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return the description and a mesh a part."""
    root, meshes = ET.Element("robot", name="drystone_wall"), {}
    ET.SubElement(root, "link", name=BASE)
    for part in assembly.parts:
        solid = solid_of_part(assembly, part)
        meshes[f"urdf/{_mesh_file(part)}"] = stl_bytes(solid, f"{part.name}, frame S")
        _link(root, assembly, part)
        pose, joint = assembly.place_pose(part), ET.SubElement(
            root, "joint", name=f"place_{part.name}", type="fixed"
        )  # fmt: skip
        ET.SubElement(joint, "parent", link=BASE)
        ET.SubElement(joint, "child", link=part.name)
        # Parts are turned about Y only, which is the pitch.
        turn = _row(0.0, -math.radians(part.angle_deg), 0.0)
        ET.SubElement(joint, "origin", xyz=_row(pose.x_m, pose.y_m, pose.z_m), rpy=turn)
    ET.indent(root, " ")
    text = ET.tostring(root, encoding="unicode")
    return {"urdf/wall.urdf": f'<?xml version="1.0"?>\n{text}\n', **meshes}


def _link(root: ET.Element, assembly: Assembly, part: Part) -> None:
    link, (centre, tensor) = ET.SubElement(root, "link", name=part.name), inertia(assembly, part)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_row(*centre), rpy=_row(0.0, 0.0, 0.0))
    ET.SubElement(inertial, "mass", value=number(assembly.mass_kg(part)))
    said = {f"i{'xyz'[i]}{'xyz'[j]}": number(tensor[i, j]) for i in range(3) for j in range(i, 3)}
    ET.SubElement(inertial, "inertia", said)
    for kind in ("visual", "collision"):
        body = ET.SubElement(link, kind)
        ET.SubElement(ET.SubElement(body, "geometry"), "mesh", filename=_mesh_file(part))
        if kind == "visual":
            name, colour = material(part)
            paint = ET.SubElement(body, "material", name=name)
            ET.SubElement(paint, "color", rgba=_row(*colour, 1.0))


def _mesh_file(part: Part) -> str:
    return f"meshes/{part.name}.stl"


def _row(*values: float) -> str:
    return " ".join(map(number, values))
