"""assembly.compas.json, read back with COMPAS."""

from pathlib import Path
from typing import Any

import compas
import numpy as np
import pytest
import shapely
from compas.datastructures import Mesh
from compas.geometry import Frame, Transformation

from drystone.drawing.export.formats import FORMATS, ExportSettings
from tests.drawing.export.robot_plans import METRIC, THICKNESS_M, assembly

SETTINGS = ExportSettings()


def written(name: str, folder: Path) -> dict[str, Any]:
    (path,) = FORMATS["compas"].write(assembly(name), folder, SETTINGS)
    read: dict[str, Any] = compas.json_load(str(path))
    return read


@pytest.mark.parametrize("name", METRIC)
def test_frames_are_those_of_the_poses(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    read = written(name, tmp_path)
    assert read["units"] == "m"
    for element, part in zip(read["elements"], wall.parts, strict=True):
        assert element["name"] == part.name
        pairs = ((element["place"], wall.place_pose(part)), (element["pick"], wall.pick_pose(part)))
        for frame, pose in pairs:
            if pose is None:
                assert frame is None
                continue
            assert isinstance(frame, Frame)
            matrix = np.array(Transformation.from_frame(frame).matrix)
            assert matrix == pytest.approx(pose.matrix, abs=1e-9)
            turn = pose.quaternion
            signs = [turn.x, turn.y, turn.z, turn.w], [-turn.x, -turn.y, -turn.z, -turn.w]
            found = Transformation.from_frame(frame).rotation.quaternion.xyzw
            assert min(np.abs(np.array(found) - sign).max() for sign in signs) < 1e-9


@pytest.mark.parametrize("name", METRIC)
def test_meshes_are_closed_solids_in_their_own_frames(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    for element, part in zip(written(name, tmp_path)["elements"], wall.parts, strict=True):
        mesh = element["mesh"]
        assert isinstance(mesh, Mesh)
        assert mesh.name == part.name
        assert mesh.is_manifold()
        assert mesh.is_closed()
        area = shapely.Polygon(part.corners).area
        assert mesh.volume() == pytest.approx(area * THICKNESS_M, rel=1e-9)
        moved = mesh.transformed(Transformation.from_frame(element["place"]))
        points = np.array([moved.vertex_coordinates(key) for key in moved.vertices()])
        count = len(part.corners)
        assert points[:count, [0, 2]] == pytest.approx(part.corners, abs=1e-9)
        assert points[:count, 1] == pytest.approx(np.zeros(count), abs=1e-9)
        assert points[count:, 1] == pytest.approx(np.full(count, THICKNESS_M), abs=1e-9)


def test_it_is_written_again_by_compas_as_it_was_read(tmp_path: Path) -> None:
    read = written("exact", tmp_path)
    again = compas.json_loads(compas.json_dumps(read))
    for one, other in zip(read["elements"], again["elements"], strict=True):
        assert one["place"] == other["place"]
        assert one["mesh"].number_of_faces() == other["mesh"].number_of_faces()
