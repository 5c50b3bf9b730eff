"""The URDF, read back with compas_robots and the XML of the standard library."""

from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import trimesh
from compas.geometry import Transformation
from compas_robots import RobotModel
from compas_robots.resources import DefaultMeshLoader

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.export.solids import inertia, solid_of_part
from tests.drawing.export.robot_plans import METRIC, THICKNESS_M, assembly

SETTINGS = ExportSettings()

PRECISE = 1e-6
"""Relative; the meshes have single precision."""


def row(element: ET.Element | None, name: str) -> list[float]:
    assert element is not None
    return [float(word) for word in element.attrib[name].split()]


@pytest.fixture(scope="module")
def exact(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The URDF of a plan with a wedge."""
    folder = tmp_path_factory.mktemp("exact")
    return FORMATS["urdf"].write(assembly("exact"), folder, SETTINGS)[0]


@pytest.mark.parametrize("name", METRIC)
def test_links_are_fixed_at_their_places(name: str, tmp_path: Path) -> None:
    wall = assembly(name)
    path, *_ = FORMATS["urdf"].write(wall, tmp_path, SETTINGS)
    robot = RobotModel.from_urdf_file(str(path))
    assert robot.root.name == "wall"
    assert [link.name for link in robot.iter_links()][1:] == [part.name for part in wall.parts]
    assert not robot.get_configurable_joints()
    for part in wall.parts:
        joint = robot.find_parent_joint(robot.get_link_by_name(part.name))
        assert joint.type.name == "FIXED"
        frame = Transformation.from_frame(joint.current_origin)
        assert np.array(frame.matrix) == pytest.approx(wall.place_pose(part).matrix, abs=1e-9)


def test_meshes_load_from_beside_the_file(exact: Path) -> None:
    robot = RobotModel.from_urdf_file(str(exact))
    robot.load_geometry(DefaultMeshLoader(basepath=str(exact.parent)), precision=12)
    wall = assembly("exact")
    for part in wall.parts:
        link = robot.get_link_by_name(part.name)
        for mesh in (*robot.get_link_visual_meshes(link), *robot.get_link_collision_meshes(link)):
            assert mesh.is_manifold()
            assert mesh.volume() == pytest.approx(part.area * THICKNESS_M, rel=PRECISE)


def test_mass_centre_and_inertia_are_those_of_the_mesh(exact: Path) -> None:
    wall, root = assembly("exact"), ET.fromstring(exact.read_text())  # noqa: S314 - ours
    links = root.findall("link")[1:]
    assert len(links) == len(wall.parts)
    for link in links:
        file = link.find("collision/geometry/mesh")
        assert file is not None
        mesh = trimesh.load_mesh(exact.parent / file.attrib["filename"])
        assert mesh.is_watertight
        mesh.density = wall.density_kg_m3
        inertial = link.find("inertial")
        assert inertial is not None
        mass = float(inertial.find("mass").attrib["value"])  # type: ignore[union-attr]
        assert mass == pytest.approx(mesh.mass, rel=PRECISE)
        size = mesh.extents.max()
        assert row(inertial.find("origin"), "xyz") == pytest.approx(
            mesh.center_mass, abs=PRECISE * size
        )
        found = inertial.find("inertia").attrib  # type: ignore[union-attr]
        tensor = np.zeros((3, 3))
        for i, first in enumerate("xyz"):
            for j, second in enumerate("xyz"):
                tensor[i, j] = float(found["i" + min(first, second) + max(first, second)])
        assert tensor == pytest.approx(mesh.moment_inertia, abs=PRECISE * tensor.max())
        assert np.linalg.eigvalsh(tensor).min() > 0.0


@pytest.mark.parametrize("name", METRIC)
def test_inertia_is_exact_in_double_precision(name: str) -> None:
    wall = assembly(name)
    for part in wall.parts:
        solid, found = solid_of_part(wall, part), inertia(wall, part)
        mesh = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
        mesh.density = wall.density_kg_m3
        assert found.mass_kg == pytest.approx(mesh.mass, rel=1e-10)
        assert found.centre == pytest.approx(mesh.center_mass, abs=1e-12)
        assert found.tensor == pytest.approx(mesh.moment_inertia, abs=1e-9 * found.tensor.max())


def test_materials_of_one_name_have_one_colour(exact: Path) -> None:
    colours: dict[str, set[str]] = {}
    for paint in ET.fromstring(exact.read_text()).iter("material"):  # noqa: S314 - ours
        rgba = paint.find("color")
        assert rgba is not None
        colours.setdefault(paint.attrib["name"], set()).add(rgba.attrib["rgba"])
    assert "wedge" in colours
    assert all(len(found) == 1 for found in colours.values())
