"""scene.yaml and wall.scene: the parts as collision objects of a MoveIt planning scene.

scene.yaml is a ``moveit_msgs/PlanningScene`` message that adds them (is_diff), wall.scene the text
format that MoveIt and its RViz plugin import.  Objects come in the order of building.
"""

from collections.abc import Iterable, Iterator

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.export.solids import colour, require_solids, solid_of_part
from drystone.drawing.export.text import number
from drystone.model.frames3d import Pose3d

FRAME_ID = "wall"
"""Name of the frame W in ROS; a static transform says where it is."""

AT_THE_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def moveit(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return both files; E180 without a solid."""
    require_solids(assembly)
    return {
        "scene.yaml": lambda: "\n".join(yaml_lines(assembly)) + "\n",
        "wall.scene": lambda: "\n".join(scene_lines(assembly)) + "\n",
    }


def yaml_lines(assembly: Assembly) -> Iterator[str]:
    """Return the message; a block subset of YAML with floats that every reader takes for floats.

    `operation` is left out: its default, 0, adds an object.
    """
    yield f"# drystone {assembly.plan.version}: moveit_msgs/PlanningScene, metres, frame W"
    yield "name: drystone_wall"
    yield "is_diff: true"
    yield "robot_state: {is_diff: true}"
    yield "world:"
    yield "  collision_objects:"
    for part in assembly.parts:
        solid = solid_of_part(assembly, part)
        yield f"  # step {part.step}"
        yield "  - header: {frame_id: " + FRAME_ID + "}"
        yield f"    id: {part.name}"
        yield f"    pose: {_pose(*_seven(assembly.place_pose(part)))}"
        yield "    meshes:"
        yield "    - triangles:"
        for corners in solid.triangles.tolist():
            yield f"      - {{vertex_indices: {corners}}}"
        yield "      vertices:"
        for vertex in solid.vertices.tolist():
            yield f"      - {_fields('xyz', vertex)}"
        yield "    mesh_poses:"
        yield f"    - {_pose(*AT_THE_ORIGIN)}"
    yield "object_colors:"
    for part in assembly.parts:
        yield f"- {{id: {part.name}, color: {_fields('rgba', (*colour(part), 1.0))}}}"


def scene_lines(assembly: Assembly) -> Iterator[str]:
    """Return the wall in MoveIt's text format with object poses and subframes (none)."""
    yield "drystone_wall"
    for part in assembly.parts:
        pose, solid = _seven(assembly.place_pose(part)), solid_of_part(assembly, part)
        yield f"* {part.name}"
        yield _row(pose[:3])
        yield _row(pose[3:])
        yield "1"
        yield "mesh"
        yield f"{len(solid.vertices)} {len(solid.triangles)}"
        yield from map(_row, solid.vertices.tolist())
        for a, b, c in solid.triangles.tolist():
            yield f"{a} {b} {c}"
        yield _row(AT_THE_ORIGIN[:3])
        yield _row(AT_THE_ORIGIN[3:])
        yield _row((*colour(part), 1.0))
        yield "0"
    yield "."


def _seven(pose: Pose3d) -> tuple[float, ...]:
    turn = pose.quaternion
    return pose.x_m, pose.y_m, pose.z_m, turn.x, turn.y, turn.z, turn.w


def _pose(*seven: float) -> str:
    at, turn = _fields("xyz", seven[:3]), _fields("xyzw", seven[3:])
    return f"{{position: {at}, orientation: {turn}}}"


def _fields(names: str, values: Iterable[float]) -> str:
    pairs = zip(names, values, strict=True)
    return "{" + ", ".join(f"{name}: {number(value)}" for name, value in pairs) + "}"


def _row(values: Iterable[float]) -> str:
    return " ".join(map(number, values))
