"""Solids for robots and meshes: what other programs read is every part, closed and in its place."""

import json
import struct
from xml.etree import ElementTree as ET

import compas
import numpy as np
import pytest
import shapely
import trimesh
import yaml
from compas.geometry import Frame, Transformation
from compas_robots import RobotModel
from compas_robots.resources import DefaultMeshLoader
from scipy.spatial.transform import Rotation

from drystone.drawing.export.formats import FORMATS, ExportSettings
from drystone.drawing.export.solids import extruded, inertia, material, solid_of_part
from drystone.drawing.palette import WEDGE_COLOUR, cluster_colour, rgb
from drystone.errors import InputError
from tests.drawing.plans import THICKNESS_M, assembly

SETTINGS = ExportSettings()


def mesh_of(points, faces, matrix=None):
    mesh = trimesh.Trimesh(points, faces, process=False)
    return mesh.apply_transform(np.eye(4) if matrix is None else matrix)


def obj(paths):
    scene = trimesh.load_scene(paths[0], split_objects=True, group_material=False, process=False)
    lines = paths[0].read_text(encoding="utf-8").splitlines()
    for name in [line[2:] for line in lines if line.startswith("o ")]:
        yield name, scene.geometry[name]
    assert paths[1].name == "wall.mtl"


def glb(paths):
    scene = trimesh.load_scene(paths[0])
    # In glTF (x, y, z) of the wall is (x, z, -y).
    from_gltf = np.array([[1.0, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    for node in scene.graph.nodes_geometry:
        matrix, geometry = scene.graph[node]
        yield node, scene.geometry[geometry].copy().apply_transform(from_gltf @ matrix)


def stl(paths):
    for path in paths:
        # A header that begins with "solid" is taken for a text file.
        header = f"drystone, metres: {path.stem}, frame W"
        assert path.read_bytes()[:80].rstrip() == header.encode()
        yield path.stem, trimesh.load_mesh(path)


def seven(pose):
    assert [[*one] for one in pose.values()] == [[*"xyz"], [*"xyzw"]]
    found = [value for one in pose.values() for value in one.values()]
    # A message field of floats takes no whole numbers and no words.
    assert all(type(value) is float for value in found)
    return found


def matrix_of(pose):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = Rotation.from_quat(pose[3:]).as_matrix(), pose[:3]
    return matrix


def scene_yaml(paths):
    read = yaml.safe_load(paths[0].read_text(encoding="utf-8"))
    assert read["is_diff"] is True
    objects, colours = read["world"]["collision_objects"], read["object_colors"]
    for one, paint in zip(objects, colours, strict=True):
        assert (one["id"], [*paint["color"]]) == (paint["id"], ["r", "g", "b", "a"])
        assert all(0.0 <= value <= paint["color"]["a"] == 1.0 for value in paint["color"].values())
        # Of moveit_msgs/CollisionObject; all other fields keep their defaults.
        assert set(one) == {"header", "id", "pose", "meshes", "mesh_poses"}
        assert one["header"] == {"frame_id": "wall"}
        assert [seven(pose) for pose in one["mesh_poses"]] == [[0.0] * 6 + [1.0]]
        (mesh,) = one["meshes"]
        vertices = [list(vertex.values()) for vertex in mesh["vertices"]]
        assert all(type(value) is float for vertex in vertices for value in vertex)
        faces = [corner["vertex_indices"] for corner in mesh["triangles"]]
        yield one["id"], mesh_of(vertices, faces, matrix_of(seven(one["pose"])))


def scene_text(paths):
    """Read what PlanningScene::loadGeometryFromStream of MoveIt reads, word by word."""
    name, _, rest = paths[1].read_text(encoding="utf-8").partition("\n")
    assert name == "drystone_wall"
    # The line after the first object's name tells the new format, with object poses, by a blank.
    assert " " in rest.splitlines()[1].strip()
    words = iter(rest.split())

    def numbers(count):
        return [float(next(words)) for _ in range(count)]

    while (marker := next(words)) == "*":
        object_id, pose = next(words), numbers(7)
        assert (next(words), next(words)) == ("1", "mesh")
        vertices, triangles = int(next(words)), int(next(words))
        points = np.array(numbers(3 * vertices)).reshape(-1, 3)
        faces = np.array([int(next(words)) for _ in range(3 * triangles)]).reshape(-1, 3)
        assert numbers(7) == [0.0] * 6 + [1.0]
        assert numbers(5)[3:] == [1.0, 0.0]
        yield object_id, mesh_of(points, faces, matrix_of(pose))
    assert [marker, *words] == ["."]


def urdf(paths):
    robot = RobotModel.from_urdf_file(str(paths[0]))
    assert robot.root.name == "wall"
    assert not robot.get_configurable_joints()
    for link in [*robot.iter_links()][1:]:
        joint = robot.find_parent_joint(link)
        assert joint.type.name == "FIXED"
        place = np.array(Transformation.from_frame(joint.current_origin).matrix)
        for shown in (*link.visual, *link.collision):
            path = paths[0].parent / shown.geometry.shape.filename
            yield link.name, trimesh.load_mesh(path).apply_transform(place)


def compas_json(paths):
    read = compas.json_load(str(paths[0]))
    assert read["units"] == "m"
    for element, part in zip(read["elements"], assembly("exact").parts, strict=True):
        assert isinstance(element["pick"], Frame) == (part.kind == "stone")
        if part.kind == "stone":
            matrix = np.array(Transformation.from_frame(element["pick"]).matrix)
            assert matrix == pytest.approx(assembly("exact").pick_pose(part).matrix, abs=1e-9)
        mesh = element["mesh"]
        assert (mesh.name, mesh.is_manifold(), mesh.is_closed()) == (element["name"], True, True)
        moved = mesh.transformed(Transformation.from_frame(element["place"]))
        yield element["name"], mesh_of(*moved.to_vertices_and_faces())


READERS = {
    "obj": ("obj", obj, 1e-8), "glb": ("glb", glb, 1e-6), "stl": ("stl", stl, 1e-7),
    "scene.yaml": ("moveit", scene_yaml, 1e-9), "wall.scene": ("moveit", scene_text, 1e-9),
    "urdf": ("urdf", urdf, 1e-7), "compas": ("compas", compas_json, 1e-9),
}  # fmt: skip
"""Names of formats, their readers, and how many metres a mesh may be beside its place."""


@pytest.mark.parametrize("reader", READERS)
def test_every_part_is_closed_and_at_its_place_in_order(reader, tmp_path):
    wall, (written, read, off) = assembly("exact"), READERS[reader]
    found = list(read(FORMATS[written].write(wall, tmp_path, SETTINGS)))
    order = [part.name for part in wall.parts]
    if written == "glb":
        found.sort(key=lambda one: order.index(one[0]))
    each = 2 if written == "urdf" else 1  # seen and touched
    parts = [part for part in wall.parts for _ in range(each)]
    for (name, mesh), part in zip(found, parts, strict=True):
        assert name == part.name
        assert mesh.is_watertight
        # Its faces point outward, or the volume would be negative.
        volume = shapely.Polygon(part.corners).area * THICKNESS_M
        assert mesh.volume == pytest.approx(volume, rel=1e2 * off)
        low, high = part.corners.min(axis=0), part.corners.max(axis=0)
        expected = [[low[0], 0.0, low[1]], [high[0], THICKNESS_M, high[1]]]
        assert mesh.bounds == pytest.approx(np.array(expected), abs=off)


def test_colours_of_obj_are_those_of_the_clusters(tmp_path):
    exact = assembly("exact")
    path, _ = paths = FORMATS["obj"].write(exact, tmp_path, SETTINGS)
    paints = {name: mesh.visual.material for name, mesh in obj(paths)}
    assert [paints[part.name].name for part in exact.parts] == [material(p)[0] for p in exact.parts]
    (wedge,) = exact.wedges
    assert paints[wedge.name].diffuse.tolist() == [0x8B, 0, 0, 255]
    # Numbers have all digits.
    lines = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    first = exact.parts[0].corners
    assert (np.array(lines[: len(first)], float)[:, [0, 2]] == first).all()


def test_nodes_of_glb_have_the_poses_steps_and_colours_of_the_wall(tmp_path):
    exact = assembly("exact")
    (path,) = FORMATS["glb"].write(exact, tmp_path, SETTINGS)
    data = path.read_bytes()
    *header, size, kind = struct.unpack("<4sIII4s", data[:20])
    assert (*header, kind) == (b"glTF", 2, len(data), b"JSON")
    gltf = json.loads(data[20 : 20 + size])
    nodes = {node["name"]: node for node in gltf["nodes"]}
    for part in exact.parts:
        node = nodes[part.name]
        matrix = np.reshape(node["matrix"], (4, 4)).T
        assert matrix == pytest.approx(exact.place_pose(part).matrix, abs=1e-12)
        assert node["extras"] == {"step": part.step}
        (mesh,) = gltf["meshes"][node["mesh"]]["primitives"]
        paint = gltf["materials"][mesh["material"]]
        assert paint["name"] == material(part)[0]
        colour = WEDGE_COLOUR if part.kind == "wedge" else cluster_colour(part.cluster)
        light = [((one + 0.055) / 1.055) ** 2.4 if one > 0.04 else one / 12.92
                 for one in rgb(colour)]  # fmt: skip
        factor = paint["pbrMetallicRoughness"]["baseColorFactor"]
        assert factor == pytest.approx([*light, 1.0], abs=0.003)


def test_a_urdf_loads_with_mass_centre_and_inertia_of_its_meshes(tmp_path):
    exact = assembly("exact")
    path, *_ = FORMATS["urdf"].write(exact, tmp_path, SETTINGS)
    robot = RobotModel.from_urdf_file(str(path))
    robot.load_geometry(DefaultMeshLoader(basepath=str(path.parent)), precision=12)
    for part in exact.parts:
        link = robot.get_link_by_name(part.name)
        (mesh,) = robot.get_link_collision_meshes(link)
        assert mesh.volume() == pytest.approx(part.area * THICKNESS_M, rel=1e-6)
        solid, (centre, tensor) = solid_of_part(exact, part), inertia(exact, part)
        exactly = mesh_of(solid.vertices, solid.triangles)
        exactly.density = exact.density_kg_m3
        assert exact.mass_kg(part) == pytest.approx(exactly.mass, rel=1e-10)
        assert centre == pytest.approx(exactly.center_mass, abs=1e-12)
        size = tensor.max()
        assert tensor == pytest.approx(exactly.moment_inertia, abs=1e-9 * size)
        assert link.inertial.mass.value == pytest.approx(exact.mass_kg(part))
        assert [*link.inertial.origin.point] == pytest.approx(centre, abs=1e-9)
        said = link.inertial.inertia
        told = [[said.ixx, said.ixy, said.ixz], [said.ixy, said.iyy, said.iyz],
                [said.ixz, said.iyz, said.izz]]  # fmt: skip
        assert np.array(told) == pytest.approx(tensor, abs=1e-9 * size)
    paints = ET.fromstring(path.read_text()).iter("material")  # noqa: S314 - our own file
    colours = {(paint.attrib["name"], paint[0].attrib["rgba"]) for paint in paints}
    assert {material(part)[0] for part in exact.parts} == {name for name, _ in colours}
    assert len(dict(colours)) == len(colours)


def test_a_comb_is_a_solid_and_an_outline_that_bounds_none_is_refused():
    """The comb has a corner in the middle of its back."""
    back, teeth = [(0, 0), (2, 0), (5, 0), (5, 3), (4, 3)], [(4, 1), (3, 1), (3, 3), (2, 3)]
    outline = np.array([*back, *teeth, (2, 1), (1, 1), (1, 3), (0, 3)], float)
    solid = extruded(outline, -1.0, 2.0)
    mesh = mesh_of(solid.vertices, solid.triangles)
    assert (mesh.is_watertight, mesh.is_winding_consistent) == (True, True)
    assert mesh.volume == pytest.approx(3.0 * shapely.Polygon(outline).area, rel=1e-12)
    assert mesh.face_normals == pytest.approx(solid.normals, abs=1e-12)
    crossing, flat = [(0, 0), (2, 2), (2, 0), (0, 2)], [(0, 0), (1, 0), (2, 0)]
    for corners in (crossing, [(0, 0), (2, 0), (1, 1), (2, 2), (0, 2), (1, 1)], flat):
        with pytest.raises(InputError, match=r"E180 .*stone_012"):
            extruded(np.array(corners, float), 0.0, 1.0, "stone_012")
