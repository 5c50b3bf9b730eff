"""Known stones in every plane, of either hand and in every unit: never mirrored, never rescaled."""

from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely
import trimesh

from drystone.errors import InputError, UsageError
from drystone.io.outlines_in.dxf import read_dxf
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import HEIGHT, METRIC, PX_PER_M, STONES, close

S = np.sqrt(0.5)
PLACES = {
    "top": ((1, 0, 0), (0, 1, 0), "z"),
    "below": ((-1, 0, 0), (0, 1, 0), "z-back"),
    "front": ((1, 0, 0), (0, 0, 1), "z"),
    "back": ((-1, 0, 0), (0, 0, 1), "z-back"),
    "right": ((0, 1, 0), (0, 0, 1), "z"),
    "left": ((0, -1, 0), (0, 0, 1), "z-back"),
    "slanting": ((S, S, 0), (0, 0, 1), "z"),
    "y, top": ((1, 0, 0), (0, 0, -1), "y"),
    "y, below": ((-1, 0, 0), (0, 0, -1), "y-back"),
    "y, front": ((1, 0, 0), (0, 1, 0), "y"),
    "y, back": ((-1, 0, 0), (0, 1, 0), "y-back"),
    "y, right": ((0, 0, -1), (0, 1, 0), "y"),
    "y, left": ((0, 0, 1), (0, 1, 0), "y-back"),
}
"""What points right and up in a picture of the stones, and the option that says so."""
FACING_ALONE = ["top", "front", "back", "right", "left", "slanting"]
SURVEY = 1200 / 3937
UNITS_M = dict(
    enumerate(
        [0.0254, 0.3048, 1609.344, 1e-3, 1e-2, 1, 1e3, 2.54e-8, 2.54e-5, 0.9144, 1e-10, 1e-9, 1e-6,
         0.1, 10, 100, 1e9, 149597870700, 9.4607304725808e15, 3.0856775814913673e16, SURVEY,
         SURVEY / 12, 3 * SURVEY, 5280 * SURVEY],
        start=1,
    )
)  # fmt: skip


def turn(place):
    right, up, _ = PLACES[place]
    return np.column_stack([right, up, np.cross(right, up)])


def corners(points, place="top", unit=1.0):
    flat = [(x, HEIGHT - y, 0.0) for x, y in points]
    return np.array(flat) @ turn(place).T / PX_PER_M / unit


def drawn(place="top", kind="LWPOLYLINE", code=6, unit=1.0, version="R2010"):
    """Outlines as CAD draws them in a plane of its own, or as lines in space.

    Both pieces of stone 34 cannot be one in DXF: only the first.
    """
    document = ezdxf.new(version)
    document.header["$INSUNITS"] = code
    space, matrix = document.modelspace(), np.eye(4)
    matrix[:3, :3] = turn(place).T
    for stone, polygons in STONES.items():
        for number, points in enumerate(polygons[0]):
            style = {"layer": f"stone {stone}" if number == 0 else "0"}
            if kind == "POLYLINE":
                ring = corners(points, place, unit)
                space.add_polyline3d(ring, close=True, dxfattribs=style)
                continue
            flat = corners(points, unit=unit)[:, :2]
            if stone % 2:
                line = space.add_lwpolyline(flat, close=True, dxfattribs=style)
            else:  # closed by its last point, and of the old kind
                line = space.add_polyline2d([*flat, flat[0]], dxfattribs=style)
            line.transform(ezdxf.math.Matrix44(matrix.ravel().tolist()))
    return document


def dxf(tmp_path, place="top", kind="LWPOLYLINE", **options):
    drawn(place, kind, **options).saveas(tmp_path / f"{kind}.dxf")
    return tmp_path / f"{kind}.dxf"


@pytest.mark.parametrize("place", PLACES)
def test_dxf_in_every_plane(tmp_path, place):
    """Where nobody asks for a side, it is the one that the outlines face."""
    flat, lines = (dxf(tmp_path, place, kind) for kind in ("LWPOLYLINE", "POLYLINE"))
    close(read_stones(flat, settings=replace(METRIC, up=PLACES[place][2])))
    stones = read_stones(lines, settings=replace(METRIC, up=PLACES[place][2]))
    close(stones)
    assert "the drawing is seen along" in " ".join(notice.message for notice in stones.notices)
    if place in FACING_ALONE:
        stones = read_stones(flat, settings=METRIC)
        close(stones)
        said = [notice for notice in stones.notices if "is seen along" in notice.message]
        assert bool(said) == (place != "top")
        assert all("--up" in notice.cure for notice in said)


@pytest.mark.parametrize(
    ("place", "in_block"), [(place, i % 2 == 0) for i, place in enumerate(FACING_ALONE)]
)
def test_dxf_of_all_kinds_in_a_plane(tmp_path, place, in_block):
    document = ezdxf.new("R2010", units=6)
    space = document.modelspace()
    block = document.blocks.new("ALL") if in_block else space
    block.add_circle((1, 1), 0.4)
    block.add_ellipse((3, 1), major_axis=(0.5, 0), ratio=0.4)
    block.add_spline().set_closed([(5, 0.5, 0), (6, 0.5, 0), (6, 1.5, 0), (5, 1.5, 0)])
    block.add_lwpolyline([(7, 0.5, 0), (8, 0.5, 1), (8, 1.5, 0), (7, 1.5, 0)], "xyb", close=True)
    # No edge goes through centres of pixels.
    block.add_polyline2d([(9, 0, 0), (10, 0, 0.5), (10, 0.93, 0)], format="xyb", close=True)
    block.add_polyline3d([(11, 0, 0), (12, 0, 0), (11, 0.91, 0)], close=True)
    if in_block:
        space.add_blockref("ALL", (0, 0))
    document.saveas(tmp_path / "flat.dxf")
    matrix = np.eye(4)
    matrix[:3, :3] = turn(place).T
    for entity in space:
        entity.transform(ezdxf.math.Matrix44(matrix.ravel().tolist()))
    document.saveas(tmp_path / "turned.dxf")
    settings = ReadSettings(px_per_m=100)
    flat, turned = (read_stones(tmp_path / name, settings=settings) for name in
                    ("flat.dxf", "turned.dxf"))  # fmt: skip
    assert len(flat) == 6
    for one, other in zip(flat, turned, strict=True):
        assert np.abs(np.subtract(one.mask.shape, other.mask.shape)).max() <= 1
        assert other.area_px == pytest.approx(one.area_px, rel=5e-3)
        assert other.left_px == pytest.approx(one.left_px, abs=1)
        assert other.bottom_px == pytest.approx(one.bottom_px, abs=1)


def test_dxf_plans_are_seen_from_the_top_though_mirrored_copies_face_down(tmp_path):
    document = ezdxf.readfile(dxf(tmp_path))
    for line in document.modelspace():
        line.dxf.extrusion = (0, 0, -1)
        if line.dxftype() == "LWPOLYLINE":
            line.set_points([(-x, y) for x, y, *_ in line], format="xy")
            continue
        for vertex in line.vertices:
            x, y, _ = vertex.dxf.location
            vertex.dxf.location = (-x, y, 0)
    document.saveas(tmp_path / "s.dxf")
    close(read_stones(tmp_path / "s.dxf", settings=METRIC))


def test_dxf_outlines_out_of_the_plane_are_named(tmp_path):
    document = ezdxf.readfile(dxf(tmp_path))
    space = document.modelspace()
    edge = space.add_polyline3d(
        [(2, 0, 0), (2.1, 0, 0), (2.1, 0.03, 0.095), (2, 0.03, 0.095)], close=True
    )
    space.add_polyline3d([(1, 0, 0), (1.1, 0, 0), (1.1, 0.08, 0.06), (1, 0.08, 0.06)], close=True)
    document.saveas(tmp_path / "s.dxf")
    stones = read_stones(tmp_path / "s.dxf", settings=METRIC)
    said = " ".join(notice.message for notice in stones.notices)
    assert "1 outlines that are seen edgewise" in said
    assert (
        "1 outlines do not lie in the plane that is seen, and are shortened: most by 20 %" in said
    )
    assert edge.dxf.handle not in said.partition("shortened")[2]
    assert len(stones) == len(STONES) + 1


def test_dxf_units(tmp_path):
    for code, unit_m in UNITS_M.items():
        path = dxf(tmp_path, code=code)
        assert read_dxf(path.read_bytes(), ReadSettings()).unit_m == pytest.approx(unit_m)
    close(read_stones(dxf(tmp_path, code=4, unit=1e-3), settings=METRIC))
    with pytest.raises(InputError, match=r"E114 .*is beyond 1e9"):
        read_stones(dxf(tmp_path, code=6, unit=1e-12), settings=METRIC)
    for code in (-1, 25, 999):
        with pytest.raises(InputError, match=r"E116 .*\$INSUNITS is .*--unit mm"):
            read_stones(dxf(tmp_path, code=code))


@pytest.mark.parametrize(
    ("code", "own", "unit", "metres"),
    [(0, "", "mm", 1e-3), (2, "ft", "ft", 0.3048), (6, "m", "cm", 1e-2), (19, "ly", "in", 0.0254)],
)
def test_dxf_with_a_wrong_unit(tmp_path, code, own, unit, metres):
    path = dxf(tmp_path, "front", code=code, unit=metres)
    stones = read_stones(path, settings=replace(METRIC, unit=unit))
    close(stones)
    said = [notice.message for notice in stones.notices if "gives another unit" in notice.message]
    assert len(said) == (own not in ("", unit))
    assert all(f"$INSUNITS {code}" in text and f"--unit {unit}" in text for text in said)


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
    path = tmp_path / f"s.{kind.removesuffix('_ascii')}"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def scene(place, hand=1):
    found = trimesh.Scene()
    for stone, polygons in STONES.items():
        found.add_geometry(solid(polygons, place, hand), geom_name=f"stone_{stone}")
    return found


@pytest.mark.parametrize(
    "place", ["top", "below", "front", "right", "y, top", "y, back", "y, left"]
)
def test_meshes_in_every_plane(tmp_path, place):
    path = scanned(tmp_path, scene(place))
    close(read_stones(path, settings=replace(METRIC, up=PLACES[place][2])))
    standing = PLACES[place][2].removesuffix("-back")
    if "back" in PLACES[place][2]:  # the same file from its other side
        path = scanned(tmp_path, scene(place.replace("below", "top").replace("back", "front")
                                       .replace("left", "right")))  # fmt: skip
        close(read_stones(path, settings=replace(METRIC, up=standing)))


@pytest.mark.parametrize(
    ("place", "asks", "kind"),
    [
        ("top", False, "stl"),
        ("front", True, "stl_ascii"),
        ("right", False, "ply"),
        ("y, top", True, "obj"),
        ("y, front", False, "obj"),
    ],
)
def test_meshes_that_may_be_mirrored_are_asked_about(tmp_path, place, asks, kind):
    path = scanned(tmp_path, solid(STONES[5], place), kind)
    if not asks:
        notice = read_stones(path, settings=METRIC).notices[0]
        assert "seen along" in notice.message
        assert "--up" in notice.cure
        return
    with pytest.raises(InputError, match=r"E116 .*which axis is up.*--up y .*or --up z"):
        read_stones(path, settings=METRIC)


@pytest.mark.parametrize("place", ["front", "right", "top"])
def test_meshes_of_a_left_hand_are_named(tmp_path, place):
    for hand in (1, -1):
        stones = read_stones(
            scanned(tmp_path, scene(place, hand)), settings=replace(METRIC, up="z")
        )
        said = any("left hand" in notice.message for notice in stones.notices)
        assert said == (hand == -1 and place != "top")


def test_up_is_for_what_has_three_axes(tmp_path):
    (tmp_path / "s.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><circle r="9"/></svg>')
    for source in (tmp_path / "s.svg", np.pad(np.ones((9, 9), np.uint8), 3)):
        with pytest.raises(UsageError, match=r"E118 .*no third axis .*--up"):
            read_stones(source, settings=ReadSettings(up="z-back"))


def torn(mesh, way):
    """Every corner of a face by itself, as normals, textures and rounding make them."""
    vertices = mesh.vertices[mesh.faces].reshape(-1, 3).astype(np.float32)
    if way == "noise":
        ends = np.random.default_rng(5).choice([-np.inf, np.inf], vertices.shape)
        vertices = np.nextafter(vertices, ends.astype(np.float32))
    faces = np.arange(len(vertices)).reshape(-1, 3)
    normals = np.repeat(mesh.face_normals, 3, axis=0) if way == "normals" else None
    found = trimesh.Trimesh(vertices, faces, process=False, vertex_normals=normals)
    if way == "texture":
        uv = np.random.default_rng(6).random((len(vertices), 2))
        found.visual = trimesh.visual.TextureVisuals(uv=uv)
    return found


@pytest.mark.parametrize(
    ("way", "shift", "kind"),
    [
        ("normals", 0.0, "obj"),
        ("texture", 40.0, "obj"),
        ("noise", 0.0, "stl"),
        ("noise", 40.0, "ply"),
        ("noise", 40.0, "stl_ascii"),
    ],
)
def test_corners_in_one_place_are_one(tmp_path, way, shift, kind):
    names = [stone for stone in APART if stone != 34]
    whole = trimesh.util.concatenate([solid(STONES[stone], "top") for stone in names])
    whole.vertices += (shift, shift, 0)
    path = scanned(tmp_path, torn(whole, way), kind)
    stones = read_stones(path, settings=METRIC)
    areas = [stone.area_px for stone in stones]
    want = [shapely.Polygon(STONES[stone][0][0], STONES[stone][0][1:]).area for stone in names]
    assert areas == pytest.approx(want, rel=1e-2)


def test_fine_meshes_far_from_the_origin_are_not_welded_together(tmp_path):
    near = [trimesh.creation.box((0.2, 0.1, 0.02)) for _ in range(2)]
    near[1].apply_translation((0.201, 0, 0))
    whole = trimesh.util.concatenate(near)
    whole.apply_translation((5e5, 5e6, 0))
    text = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in whole.vertices.tolist())
    text += "".join(f"f {a} {b} {c}\n" for a, b, c in (whole.faces + 1).tolist())
    (tmp_path / "s.obj").write_text(text)
    assert len(read_stones(tmp_path / "s.obj", settings=METRIC)) == 2
