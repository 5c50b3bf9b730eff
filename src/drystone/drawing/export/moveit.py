"""scene.yaml and wall.scene: the parts as collision objects of a MoveIt planning scene.

scene.yaml is a ``moveit_msgs/PlanningScene`` message that adds them (is_diff), wall.scene the text
format that MoveIt and its RViz plugin import.  Objects come in the order of building.
"""

from collections.abc import Iterator

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.formats import Files
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.export.solids import Solid, colour, require_solids, solid_of_part
from drystone.drawing.export.text import number
from drystone.model.frames3d import Pose3d

FRAME_ID = "wall"
"""Name of the frame W in ROS; a static transform says where it is."""


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
        yield f"  # step {part.step}"
        yield "  - header: {frame_id: " + FRAME_ID + "}"
        yield f"    id: {part.name}"
        yield f"    pose: {_pose(assembly.place_pose(part))}"
        yield "    meshes:"
        yield from _mesh(solid_of_part(assembly, part))
        yield "    mesh_poses:"
        yield f"    - {_pose(None)}"
    yield "object_colors:"
    for part in assembly.parts:
        rgba = zip("rgba", (*colour(part), 1.0), strict=True)
        fields = ", ".join(f"{name}: {number(value)}" for name, value in rgba)
        yield "- {id: " + part.name + ", color: {" + fields + "}}"


def scene_lines(assembly: Assembly) -> Iterator[str]:
    """Return the wall in MoveIt's text format with object poses and subframes (none)."""
    yield "drystone_wall"
    for part in assembly.parts:
        yield f"* {part.name}"
        yield from _pose_lines(assembly.place_pose(part))
        yield "1"
        yield from _mesh_lines(solid_of_part(assembly, part))
        yield "0.0 0.0 0.0"
        yield "0.0 0.0 0.0 1.0"
        yield _row((*colour(part), 1.0))
        yield "0"
    yield "."


def _pose(pose: Pose3d | None) -> str:
    values = (0.0,) * 6 + (1.0,) if pose is None else _seven(pose)
    x, y, z, qx, qy, qz, qw = map(number, values)
    return (
        f"{{position: {{x: {x}, y: {y}, z: {z}}}, "
        f"orientation: {{x: {qx}, y: {qy}, z: {qz}, w: {qw}}}}}"
    )


def _mesh(solid: Solid) -> Iterator[str]:
    yield "    - triangles:"
    for corners in solid.triangles.tolist():
        yield f"      - {{vertex_indices: {corners}}}"
    yield "      vertices:"
    for x, y, z in solid.vertices.tolist():
        yield f"      - {{x: {number(x)}, y: {number(y)}, z: {number(z)}}}"


def _mesh_lines(solid: Solid) -> Iterator[str]:
    yield "mesh"
    yield f"{len(solid.vertices)} {len(solid.triangles)}"
    yield from map(_row, solid.vertices.tolist())
    for a, b, c in solid.triangles.tolist():
        yield f"{a} {b} {c}"


def _pose_lines(pose: Pose3d) -> Iterator[str]:
    values = _seven(pose)
    yield _row(values[:3])
    yield _row(values[3:])


def _seven(pose: Pose3d) -> tuple[float, ...]:
    turn = pose.quaternion
    return pose.x_m, pose.y_m, pose.z_m, turn.x, turn.y, turn.z, turn.w


def _row(values: tuple[float, ...] | list[float]) -> str:
    return " ".join(map(number, values))
