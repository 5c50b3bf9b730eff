"""OBJ, PLY and STL of the known stones, extruded and written by trimesh."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
import trimesh

from drystone.errors import InputError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.hostile import PLY
from tests.io.known_stones import METRIC, PLACES, PX_PER_M, STONES, close, corners, masks, turn
from tests.io.pictures import said, written


def solid(polygons, place, hand=1):
    """A stone of 2 cm as a closed mesh that faces outwards, or of a left hand."""
    outer, *holes = (corners(ring)[:, :2] for ring in polygons[0])
    triangles = shapely.constrained_delaunay_triangles(shapely.Polygon(outer, holes))
    flat = shapely.get_coordinates(shapely.orient_polygons(triangles)).reshape(-1, 4, 2)[:, :3]
    vertices, faces = np.unique(flat.reshape(-1, 2), axis=0, return_inverse=True)
    mesh = trimesh.creation.extrude_triangulation(vertices, faces.reshape(-1, 3), 0.02)
    mesh.vertices = mesh.vertices @ turn(place).T
    return trimesh.Trimesh(mesh.vertices, mesh.faces[:, ::hand], process=False)


APART = [stone for stone in STONES if stone not in (13, 21)]
KINDS = [("stl", {}), ("stl_ascii", {}), ("ply", {}), ("ply", {"encoding": "ascii"}), ("obj", {})]


def scanned(tmp_path, mesh, kind="obj", options=None):
    data = mesh.export(file_type=kind, **(options or {}))
    return written(tmp_path, data, f"s.{kind.removesuffix('_ascii')}")


def scene(place, hand=1):
    found = trimesh.Scene()
    for stone, polygons in STONES.items():
        found.add_geometry(solid(polygons, place, hand), geom_name=f"stone_{stone}")
    return found


@pytest.mark.parametrize("place", [one for one in PLACES if one != "slanting"])
def test_meshes_in_every_plane(tmp_path, place):
    path = scanned(tmp_path, scene(place))
    stones = read_stones(path, settings=replace(METRIC, up=PLACES[place][2]))
    close(stones)
    assert stones.source.px_per_m == PX_PER_M
    assert stones.by_id(21).name == "stone_21"
    seen, unit = stones.notices[:2]
    axis = {"right": "X, with", "front": "Y, with"}.get(place, "")
    assert f"seen along {axis}" in seen.message
    assert "taken as metres" in unit.message
    assert "left hand" not in said(stones)


def test_meshes_that_may_be_mirrored_are_asked_about(tmp_path):
    with pytest.raises(InputError, match=r"E116 .*which axis is up.*--up y .*or --up z"):
        read_stones(scanned(tmp_path, solid(STONES[5], "front")), settings=METRIC)
    for place in ("top", "right"):
        path = scanned(tmp_path, solid(STONES[5], place))
        assert "--up" in read_stones(path, settings=METRIC).notices[0].cure
    for place in ("front", "right", "top"):
        left_handed = scanned(tmp_path, scene(place, hand=-1))
        told = said(read_stones(left_handed, settings=replace(METRIC, up="z")))
        assert ("left hand" in told) == (place != "top")


@pytest.mark.parametrize(
    ("way", "shift", "kind"),
    [("normals", 0, "obj"), ("texture", 40, "obj"), ("noise", 0, "stl"), ("noise", 40, "ply")],
)
def test_corners_in_one_place_are_one(tmp_path, way, shift, kind):
    names = [stone for stone in APART if stone != 34]
    whole = trimesh.util.concatenate([solid(STONES[stone], "top") for stone in names])
    whole.vertices += (shift, shift, 0)
    # Every corner of a face by itself, as normals, textures and rounding make them.
    vertices = whole.vertices[whole.faces].reshape(-1, 3).astype(np.float32)
    if way == "noise":
        ends = np.random.default_rng(5).choice([-np.inf, np.inf], vertices.shape)
        vertices = np.nextafter(vertices, ends.astype(np.float32))
    faces = np.arange(len(vertices)).reshape(-1, 3)
    normals = np.repeat(whole.face_normals, 3, axis=0) if way == "normals" else None
    torn = trimesh.Trimesh(vertices, faces, process=False, vertex_normals=normals)
    if way == "texture":
        uv = np.random.default_rng(6).random((len(vertices), 2))
        torn.visual = trimesh.visual.TextureVisuals(uv=uv)
    stones = read_stones(scanned(tmp_path, torn, kind), settings=METRIC)
    want = [shapely.Polygon(STONES[stone][0][0], STONES[stone][0][1:]).area for stone in names]
    assert [stone.area_px for stone in stones] == pytest.approx(want, rel=1e-2)


def test_fine_meshes_far_from_the_origin_are_not_welded_together(tmp_path):
    near = [trimesh.creation.box((0.2, 0.1, 0.02)) for _ in range(2)]
    near[1].apply_translation((0.201, 0, 0))
    whole = trimesh.util.concatenate(near)
    whole.apply_translation((5e5, 5e6, 0))
    text = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in whole.vertices.tolist())
    text += "".join(f"f {a} {b} {c}\n" for a, b, c in (whole.faces + 1).tolist())
    (tmp_path / "s.obj").write_text(text)
    assert len(read_stones(tmp_path / "s.obj", settings=METRIC)) == 2


def apart(place="top", unit=1.0):
    """The bodies that touch nothing, as one mesh without names."""
    found = trimesh.util.concatenate([solid(STONES[i], place) for i in APART])
    return found.apply_scale(1 / unit)


@pytest.mark.parametrize(("kind", "options"), KINDS)
def test_bodies_without_names(tmp_path, kind, options):
    path = scanned(tmp_path, apart("front", unit=0.001), kind, options)
    settings = replace(METRIC, unit="mm", up="z")
    stones = read_stones(path, settings=settings)
    areas = [masks()[known].sum() if known != 34 else 50 * 40 for known in APART]
    assert [stone.area_px for stone in stones] == pytest.approx(areas, rel=3e-3)
    assert "taken as metres" not in said(stones)
    unnamed = path.rename(tmp_path / "stones")
    if kind == "stl_ascii":
        unnamed.write_bytes(unnamed.read_bytes().upper())
    assert len(read_stones(unnamed, settings=settings)) == len(APART)  # by the content alone


def test_obj_objects_and_groups(tmp_path):
    for names, expected, parts in (
        (["o Stone 2 # left", "o Stone 1"], ["Stone 1", "Stone 2"], ""),
        (["o Stone 1 # left", "o Stone 1 # right"], ["Stone 1"], "Stone 1 # left, Stone 1 # right"),
        (["g Stone # 1", "g Stone # 2"], ["Stone"], "Stone # 1, Stone # 2"),
        (["g a wall", "g b wall"], ["a", "b"], ""),  # of the group and of that of all
        (["o x\ng left part", "g right part\no y"], ["x", "y"], ""),
        (["g stone_1 top", "g stone_1 side"], ["stone_1"], "stone_1 top, stone_1 side"),
    ):
        lines = []
        for i, name in enumerate(names):  # each of a square beside the one before
            lines += [*(f"v {3 * i + x} {y} 0" for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))), name]
            lines.append("f -4 -3 -2 -1")
        path = written(tmp_path, "\n".join([*lines, "o nothing"]), "s.obj")
        stones = read_stones(path, settings=ReadSettings(px_per_m=50, pieces="keep-largest"))
        assert [stone.name for stone in stones] == expected
        told = [
            "of the groups of a face the first counts, and what follows # is a comment, "
            f"so {expected[0]} is one stone of: {parts}."
        ]
        groups = [n.message for n in stones.notices if "groups" in n.message]
        assert groups == (told if parts else [])


@pytest.mark.parametrize("faces", ["5 0 1 2 3 4", "4 0 1 2 3\n3 0 3 4", "3 0 3 4\n4 0 1 2 3"])
@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian", "binary_big_endian", "obj"])
def test_faces_of_any_number_of_corners_which_may_be_concave(tmp_path, kind, faces):
    corners = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0.5, 0), (0, 2, 0.1)])
    x, y, _ = corners.T
    area = 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    rows = [[int(word) for word in face.split()] for face in faces.split("\n")]
    if kind == "obj":  # a line that ends in a backslash goes on in the next
        lines = ["v {} {} {}".format(*corner) for corner in corners]
        turned = [[i + 1 for i in row[1:]] for row in rows]
        lines += [f"f {first} \\\n{' '.join(map(str, rest))}" for first, *rest in turned]
        data = "\n".join(lines).encode()
    else:
        data = PLY.replace(b"ascii", kind.encode()).partition(b"end_header")[0] % b"%d" % len(rows)
        data = data.replace(b"vertex 3", b"vertex 5") + b"end_header\n"
        text = "\n".join(" ".join(map(str, corner)) for corner in corners) + "\n" + faces
        order = "<" if "little" in kind else ">"
        binary = [bytes(row[:1]) + np.array(row[1:], order + "i4").tobytes() for row in rows]
        binary = corners.astype(order + "f4").tobytes() + b"".join(binary)
        data += text.encode() if kind == "ascii" else binary
    path = written(tmp_path, data, "a.obj" if kind == "obj" else "a.ply")
    (stone,) = read_stones(path, settings=ReadSettings(px_per_m=100.0))
    assert stone.area_px == pytest.approx(area * 1e4, rel=0.003)


def test_damaged_meshes(tmp_path):
    for data, name, text in (
        ("o a\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj", r"E114 .*line 4 .* \(a face of 3"),
        ("v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", r"E114 .*less than three coordinates"),
        ("v 0 0 x\n", "a.obj", r"E114 .*line 1"),
        ("v 0 \\\n0 \\\r\n0\nv 0 \\\n0 x\n", "a.obj", r"E114 .*line 4 "),
        ("v 0 0 0\n", "a.obj", r"E114 .*no faces"),
        (b"ply\nformat binary_little_endian 1.0\nend_header\n", "a.ply", r"E114 .*no faces"),
        (PLY % b"1" + b"3 0 1 3\n", "a.ply", r"E106 .*or of unknown vertices"),
        (PLY % b"1" + b"2 0 1\n", "a.ply", r"E106 .*less than three corners"),
        (PLY % b"0", "a.ply", r"E114 .*no faces"),
        (b"too short", "a.stl", r"E106 .*damaged"),
    ):
        with pytest.raises(InputError, match=text):
            read_stones(written(tmp_path, data, name))
    for kind, options in KINDS[:-1]:
        data = apart().export(file_type=kind, **options)
        path = written(tmp_path, data[: int(0.95 * len(data))], f"a.{kind[:3]}")
        with pytest.raises(InputError, match=r"E106 .*damaged or cut short"):
            read_stones(path)
