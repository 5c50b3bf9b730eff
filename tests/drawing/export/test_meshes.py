"""wall.obj, read back with trimesh."""

from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from drystone.drawing.export import meshes
from drystone.drawing.export.settings import ExportSettings
from drystone.errors import UsageError
from tests.drawing.export.robot_plans import METRIC, THICKNESS_M, assembly

SETTINGS = ExportSettings()


@pytest.mark.parametrize("name", METRIC)
def test_objects_are_closed_named_and_in_place(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    path, _ = meshes.write(wall, tmp_path, SETTINGS)
    scene = trimesh.load_scene(path, split_objects=True, group_material=False, process=False)
    names = [part.name for part in wall.parts]
    assert sorted(scene.geometry) == sorted(names)
    lines = path.read_text(encoding="utf-8").splitlines()
    assert [line[2:] for line in lines if line.startswith("o ")] == names
    for part in wall.parts:
        mesh = scene.geometry[part.name]
        assert mesh.is_watertight
        area = shapely.Polygon(part.corners).area
        assert mesh.volume == pytest.approx(area * THICKNESS_M, rel=1e-6)
        low, high = part.corners.min(axis=0), part.corners.max(axis=0)
        expected = [[low[0], 0.0, low[1]], [high[0], THICKNESS_M, high[1]]]
        assert mesh.bounds == pytest.approx(np.array(expected), abs=1e-9)


def test_colours_are_those_of_the_clusters(tmp_path: Path) -> None:
    wall = assembly("exact")
    path, colours = meshes.write(wall, tmp_path, SETTINGS)
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
    path, _ = meshes.write(wall, tmp_path, SETTINGS)
    lines = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    first = wall.parts[0].corners
    found = np.array(lines[: len(first)], float)
    assert (found[:, [0, 2]] == first).all()


def test_equal_runs_give_equal_bytes(tmp_path: Path) -> None:
    one = meshes.write(assembly("exact"), tmp_path / "a", SETTINGS)
    other = meshes.write(assembly("exact"), tmp_path / "b", SETTINGS)
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in other]


def test_no_objects_without_a_scale() -> None:
    assert meshes.files(assembly("exact"), SETTINGS) == ("wall.obj", "wall.mtl")
    with pytest.raises(UsageError, match="E131"):
        meshes.files(assembly("exact", None), SETTINGS)
