"""wall.obj, wall.glb and stl/, read back with trimesh and byte by byte."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.export.solids import material, materials
from tests.drawing.export.robot_plans import METRIC, assembly, assert_in_place

SETTINGS = ExportSettings()


@pytest.mark.parametrize("name", METRIC)
def test_objects_of_obj_are_closed_named_and_in_place(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    path, _ = FORMATS["obj"].write(wall, tmp_path, SETTINGS)
    scene = trimesh.load_scene(path, split_objects=True, group_material=False, process=False)
    names = [part.name for part in wall.parts]
    assert sorted(scene.geometry) == sorted(names)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert [line[2:] for line in lines if line.startswith("o ")] == names
    for part in wall.parts:
        assert_in_place(scene.geometry[part.name], part, 1e-8)


def test_colours_are_those_of_the_clusters(tmp_path: Path) -> None:
    wall = assembly("exact")
    path, colours = FORMATS["obj"].write(wall, tmp_path, SETTINGS)
    assert colours.name == "wall.mtl"
    scene = trimesh.load_scene(path, split_objects=True, group_material=False, process=False)
    for part in wall.parts:
        material = scene.geometry[part.name].visual.material
        expected = "wedge" if part.kind == "wedge" else f"cluster_{part.cluster}"
        assert material.name == expected
    (wedge,) = wall.wedges
    assert scene.geometry[wedge.name].visual.material.diffuse.tolist() == [0x8B, 0, 0, 255]


def test_numbers_have_all_digits(tmp_path: Path) -> None:
    wall = assembly("exact")
    path, _ = FORMATS["obj"].write(wall, tmp_path, SETTINGS)
    lines = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    first = wall.parts[0].corners
    found = np.array(lines[: len(first)], float)
    assert (found[:, [0, 2]] == first).all()


@pytest.mark.parametrize("name", METRIC)
def test_nodes_are_closed_named_and_y_is_up(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    (path,) = FORMATS["glb"].write(wall, tmp_path, SETTINGS)
    scene = trimesh.load_scene(path)
    assert sorted(scene.graph.nodes_geometry) == sorted(part.name for part in wall.parts)
    for part in wall.parts:
        matrix, geometry = scene.graph[part.name]
        mesh = scene.geometry[geometry].copy()
        # (x, y, z) of the wall is (x, z, -y) here.
        mesh.apply_transform(
            np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]]) @ matrix
        )
        assert_in_place(mesh, part, 1e-6)


def test_nodes_have_the_poses_steps_and_colours_of_the_wall(tmp_path: Path) -> None:
    wall = assembly("exact")
    (path,) = FORMATS["glb"].write(wall, tmp_path, SETTINGS)
    data = path.read_bytes()
    assert struct.unpack("<4sII", data[:12]) == (b"glTF", 2, len(data))
    size, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON"
    gltf = json.loads(data[20 : 20 + size])
    nodes = {node["name"]: node for node in gltf["nodes"]}
    colours = materials(wall)
    for part in wall.parts:
        node = nodes[part.name]
        matrix = np.reshape(node["matrix"], (4, 4)).T
        assert matrix == pytest.approx(wall.place_pose(part).matrix, abs=1e-12)
        assert node["extras"] == {"step": part.step}
        (mesh,) = gltf["meshes"][node["mesh"]]["primitives"]
        paint = gltf["materials"][mesh["material"]]
        assert paint["name"] == material(part)
        light = [((one + 0.055) / 1.055) ** 2.4 if one > 0.04 else one / 12.92
                 for one in colours[material(part)]]  # fmt: skip
        factor = paint["pbrMetallicRoughness"]["baseColorFactor"]
        assert factor == pytest.approx([*light, 1.0], abs=0.003)


@pytest.mark.parametrize("name", METRIC)
def test_files_of_stl_are_closed_and_in_place(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    paths = FORMATS["stl"].write(wall, tmp_path, SETTINGS)
    assert [path.stem for path in paths] == [part.name for part in wall.parts]
    for path, part in zip(paths, wall.parts, strict=True):
        assert_in_place(trimesh.load_mesh(path), part, 1e-7)


def test_the_header_says_unit_and_frame_and_is_no_text_file(tmp_path: Path) -> None:
    path = FORMATS["stl"].write(assembly("exact"), tmp_path, SETTINGS)[0]
    header = path.read_bytes()[:80]
    assert header.rstrip() == b"drystone, metres: stone_005, frame W"
    assert not header.startswith(b"solid")
