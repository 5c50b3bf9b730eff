"""scene.yaml read back with PyYAML, wall.scene with a reader after MoveIt's own."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
import yaml

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.robot_plans import METRIC, assembly, assert_in_place

SETTINGS = ExportSettings()

FIELDS = {"header", "id", "pose", "meshes", "mesh_poses"}
"""Of moveit_msgs/CollisionObject; all others keep their defaults."""


def scene(name: str, folder: Path) -> dict[str, Any]:
    path, _ = FORMATS["moveit"].write(assembly(name), folder, SETTINGS)
    read: dict[str, Any] = yaml.safe_load(path.read_text(encoding="utf-8"))
    return read


def seven(pose: dict[str, Any]) -> list[float]:
    assert list(pose["position"]) == ["x", "y", "z"]
    assert list(pose["orientation"]) == ["x", "y", "z", "w"]
    found = [*pose["position"].values(), *pose["orientation"].values()]
    # A message field of floats takes no whole numbers and no words.
    assert all(type(value) is float for value in found)
    return found


@pytest.mark.parametrize("name", METRIC)
def test_objects_come_in_the_order_of_building_at_their_places(name: str, tmp_path: Path) -> None:
    wall, read = assembly(name), scene(name, tmp_path)
    assert read["is_diff"] is True
    objects = read["world"]["collision_objects"]
    assert [one["id"] for one in objects] == [part.name for part in wall.parts]
    for one, part in zip(objects, wall.parts, strict=True):
        assert set(one) == FIELDS
        assert one["header"] == {"frame_id": "wall"}
        pose = wall.place_pose(part)
        turn = pose.quaternion
        expected = [pose.x_m, pose.y_m, pose.z_m, turn.x, turn.y, turn.z, turn.w]
        assert seven(one["pose"]) == expected
        assert [seven(pose) for pose in one["mesh_poses"]] == [[0.0] * 6 + [1.0]]
        (mesh,) = one["meshes"]
        faces = [corner["vertex_indices"] for corner in mesh["triangles"]]
        vertices = [list(vertex.values()) for vertex in mesh["vertices"]]
        assert all(type(value) is float for vertex in vertices for value in vertex)
        solid = trimesh.Trimesh(vertices, faces, process=False)
        assert_in_place(solid.apply_transform(pose.matrix), part)


def test_every_object_has_a_colour(tmp_path: Path) -> None:
    wall, read = assembly("exact"), scene("exact", tmp_path)
    assert [one["id"] for one in read["object_colors"]] == [part.name for part in wall.parts]
    for one in read["object_colors"]:
        assert list(one["color"]) == ["r", "g", "b", "a"]
        assert all(0.0 <= value <= 1.0 for value in one["color"].values())
        assert one["color"]["a"] == 1.0


@pytest.mark.parametrize("name", METRIC)
def test_the_text_format_holds_the_same(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    _, path = FORMATS["moveit"].write(wall, tmp_path, SETTINGS)
    found = list(read_scene(path.read_text(encoding="utf-8")))
    assert [one[0] for one in found] == [part.name for part in wall.parts]
    for (_, matrix, vertices, faces), part in zip(found, wall.parts, strict=True):
        assert matrix == pytest.approx(wall.place_pose(part).matrix, abs=1e-12)
        solid = trimesh.Trimesh(vertices, faces, process=False).apply_transform(matrix)
        assert_in_place(solid, part)


def read_scene(text: str) -> Iterator[tuple[str, Any, Any, Any]]:
    """Read what PlanningScene::loadGeometryFromStream of MoveIt reads, word by word."""
    name, _, rest = text.partition("\n")
    assert name == "drystone_wall"
    # The line after the first object's name tells the new format, with object poses, by a blank.
    assert " " in rest.splitlines()[1].strip()
    words = iter(rest.split())

    def numbers(count: int) -> list[float]:
        return [float(next(words)) for _ in range(count)]

    while (marker := next(words)) == "*":
        object_id, pose = next(words), numbers(7)
        assert (next(words), next(words)) == ("1", "mesh")
        vertices, triangles = int(next(words)), int(next(words))
        points = np.array(numbers(3 * vertices)).reshape(-1, 3)
        faces = np.array([int(next(words)) for _ in range(3 * triangles)]).reshape(-1, 3)
        assert numbers(7) == [0.0] * 6 + [1.0]
        assert numbers(4)[3] == 1.0
        assert next(words) == "0"
        x, y, z, w = pose[3:]
        matrix = trimesh.transformations.quaternion_matrix([w, x, y, z])
        matrix[:3, 3] = pose[:3]
        yield object_id, matrix, points, faces
    assert marker == "."
    assert next(words, None) is None
