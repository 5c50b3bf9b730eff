"""stl/, read back with trimesh."""

from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from drystone.drawing.export import meshes_stl
from drystone.drawing.export.settings import ExportSettings
from drystone.errors import UsageError
from tests.drawing.export.robot_plans import METRIC, THICKNESS_M, assembly

SETTINGS = ExportSettings()


@pytest.mark.parametrize("name", METRIC)
def test_files_are_closed_and_in_place(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    paths = meshes_stl.write(wall, tmp_path, SETTINGS)
    names = tuple(path.relative_to(tmp_path).as_posix() for path in paths)
    assert names == meshes_stl.files(wall, SETTINGS)
    assert names == tuple(f"stl/{part.name}.stl" for part in wall.parts)
    for path, part in zip(paths, wall.parts, strict=True):
        mesh = trimesh.load_mesh(path)
        assert mesh.is_watertight
        area = shapely.Polygon(part.corners).area
        assert mesh.volume == pytest.approx(area * THICKNESS_M, rel=1e-5)
        low, high = part.corners.min(axis=0), part.corners.max(axis=0)
        expected = [[low[0], 0.0, low[1]], [high[0], THICKNESS_M, high[1]]]
        assert mesh.bounds == pytest.approx(np.array(expected), abs=1e-7)


def test_the_header_says_unit_and_frame_and_is_no_text_file(tmp_path: Path) -> None:
    path = meshes_stl.write(assembly("exact"), tmp_path, SETTINGS)[0]
    header = path.read_bytes()[:80]
    assert header.rstrip() == b"drystone, metres: stone_005, frame W"
    assert not header.startswith(b"solid")


def test_no_files_without_a_scale() -> None:
    with pytest.raises(UsageError, match="E131"):
        meshes_stl.files(assembly("exact", None), SETTINGS)
