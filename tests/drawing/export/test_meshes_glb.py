"""wall.glb, read back with trimesh and byte by byte."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
import trimesh

from drystone.drawing.export import meshes_glb
from drystone.drawing.export.settings import ExportSettings
from drystone.errors import UsageError
from tests.drawing.export.robot_plans import METRIC, THICKNESS_M, assembly

SETTINGS = ExportSettings()


@pytest.mark.parametrize("name", METRIC)
def test_nodes_are_closed_named_and_y_is_up(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    (path,) = meshes_glb.write(wall, tmp_path, SETTINGS)
    scene = trimesh.load_scene(path)
    assert sorted(scene.graph.nodes_geometry) == sorted(part.name for part in wall.parts)
    for part in wall.parts:
        matrix, geometry = scene.graph[part.name]
        mesh = scene.geometry[geometry].copy()
        assert mesh.is_watertight
        area = shapely.Polygon(part.corners).area
        assert mesh.volume == pytest.approx(area * THICKNESS_M, rel=1e-6)
        mesh.apply_transform(matrix)
        low, high = part.corners.min(axis=0), part.corners.max(axis=0)
        # (x, y, z) of the wall is (x, z, -y) here.
        expected = [[low[0], low[1], -THICKNESS_M], [high[0], high[1], 0.0]]
        assert mesh.bounds == pytest.approx(np.array(expected), abs=1e-6)


def test_nodes_have_the_poses_of_the_wall(tmp_path: Path) -> None:
    wall, gltf = assembly("exact"), read(tmp_path)
    root, *nodes = gltf["nodes"]
    assert root["children"] == list(range(1, len(nodes) + 1))
    for node, part in zip(nodes, wall.parts, strict=True):
        pose = wall.place_pose(part)
        turn = pose.quaternion
        assert node["name"] == part.name
        assert node["translation"] == [pose.x_m, pose.y_m, pose.z_m]
        assert node["rotation"] == [turn.x, turn.y, turn.z, turn.w]
        assert node["extras"] == {"step": part.step}


def test_it_is_laid_out_as_the_standard_says(tmp_path: Path) -> None:
    gltf = read(tmp_path)
    assert gltf["asset"]["version"] == "2.0"
    for accessor in gltf["accessors"]:
        view = gltf["bufferViews"][accessor["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        width = {"VEC3": 12, "SCALAR": 4}[accessor["type"]]
        assert view["byteLength"] == accessor["count"] * width
        assert view["target"] == (34962 if accessor["type"] == "VEC3" else 34963)
        assert ("min" in accessor) == (accessor["type"] == "VEC3")
    last = gltf["bufferViews"][-1]
    assert gltf["buffers"] == [{"byteLength": last["byteOffset"] + last["byteLength"]}]
    for material in gltf["materials"]:
        assert len(material["pbrMetallicRoughness"]["baseColorFactor"]) == 4
    wedge = next(one for one in gltf["materials"] if one["name"] == "wedge")
    red = ((0x8B / 255 + 0.055) / 1.055) ** 2.4
    factor = wedge["pbrMetallicRoughness"]["baseColorFactor"]
    assert factor == pytest.approx([red, 0.0, 0.0, 1.0])


def read(folder: Path) -> dict[str, Any]:
    (path,) = meshes_glb.write(assembly("exact"), folder, SETTINGS)
    data = path.read_bytes()
    assert struct.unpack("<4sII", data[:12]) == (b"glTF", 2, len(data))
    size, kind = struct.unpack("<I4s", data[12:20])
    assert kind == b"JSON"
    assert size % 4 == 0
    rest, kind = struct.unpack("<I4s", data[20 + size : 28 + size])
    assert kind == b"BIN\0"
    assert 28 + size + rest == len(data)
    gltf: dict[str, Any] = json.loads(data[20 : 20 + size])
    return gltf


def test_equal_runs_give_equal_bytes() -> None:
    assert meshes_glb.glb_bytes(assembly("raster")) == meshes_glb.glb_bytes(assembly("raster"))


def test_no_scene_without_a_scale() -> None:
    assert meshes_glb.files(assembly("exact"), SETTINGS) == ("wall.glb",)
    with pytest.raises(UsageError, match="E131"):
        meshes_glb.files(assembly("exact", None), SETTINGS)
