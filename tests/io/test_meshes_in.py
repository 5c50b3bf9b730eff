"""OBJ, PLY and STL of the known stones, extruded and written by trimesh."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from drystone.errors import InputError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.hostile import PLY
from tests.io.known_stones import METRIC, PX_PER_M, STONES, close, masks
from tests.io.pictures import codes
from tests.io.test_planes import APART, KINDS, scene, solid

PLACE = {"x": "right", "y": "front", "z": "top"}
"""Where the stones are that one sees looking along an axis."""


def saved(tmp_path, data, name):
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def apart(axis="z", unit=1.0):
    """The bodies that touch nothing, as one mesh without names, and their ids in order."""
    found = trimesh.util.concatenate([solid(STONES[i], PLACE[axis]) for i in APART])
    return found.apply_scale(1 / unit), APART


@pytest.mark.parametrize("axis", ["x", "y"])
def test_obj_with_named_objects(tmp_path, axis):
    path = saved(tmp_path, scene(PLACE[axis]).export(file_type="obj"), "s.obj")
    stones = read_stones(path, settings=replace(METRIC, up="z"))
    close(stones)
    assert stones.source.px_per_m == PX_PER_M
    assert stones.by_id(21).name == "stone_21"
    seen, unit = stones.notices[:2]
    assert f"seen along {axis.upper()}, with" in seen.message
    assert "taken as metres" in unit.message


@pytest.mark.parametrize(("kind", "options"), KINDS)
def test_bodies_without_names(tmp_path, kind, options):
    mesh, names = apart("y", unit=0.001)
    suffix = kind.removesuffix("_ascii")
    path = saved(tmp_path, mesh.export(file_type=kind, **options), f"stones.{suffix}")
    settings = replace(METRIC, unit="mm", up="z")
    stones = read_stones(path, settings=settings)
    assert [stone.id for stone in stones] == list(range(1, len(names) + 1))
    for stone in stones:
        known = names[stone.id - 1]
        largest = masks()[known].sum() if known != 34 else 50 * 40
        assert stone.area_px == pytest.approx(largest, rel=3e-3)
    assert not any("taken as metres" in notice.message for notice in stones.notices)
    unnamed = saved(tmp_path, mesh.export(file_type=kind, **options), "stones")
    assert len(read_stones(unnamed, settings=settings)) == len(names)  # by the content alone


def test_obj_faces_may_have_many_corners_and_count_from_the_end(tmp_path):
    text = """# an L, as one face of six corners, and a box of quadrilaterals
o wall_1
v 0 0 0
v 4 0 0
v 4 0 1
v 1 0 1
v 1 0 3
v 0 0 3
f 1/1/1 2/2/1 3/3/1 4//1 5 6
g part
o wall_2
v 6 0 0
v 8 0 0
v 8 0 2
v 6 0 2
f -4 -3 -2 -1
"""
    stones = read_stones(saved(tmp_path, text, "s.obj"), settings=ReadSettings(px_per_m=50, up="z"))
    assert [stone.area_px for stone in stones] == [6 * 2500, 4 * 2500]
    assert [stone.name for stone in stones] == ["wall_1", "wall_2"]


def boxes(*names):
    """An OBJ of squares side by side, each after lines of its own."""
    lines = []
    for i, name in enumerate(names):
        lines += [*(f"v {3 * i + x} {y} 0" for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))), name]
        lines.append("f -4 -3 -2 -1")
    return "\n".join(lines)


WHY = "of the groups of a face the first counts, and what follows # is a comment"


@pytest.mark.parametrize(
    ("names", "expected", "said"),
    [
        (["g Stone 2", "g Stone 1"], ["Stone 1", "Stone 2"], ""),
        (["o Stone 2 # left", "o Stone 1"], ["Stone 1", "Stone 2"], ""),
        (["o Stone # 1", "o Stone # 2"], ["Stone # 1", "Stone # 2"], ""),
        (["o Stone 1 # left", "o Stone 1 # right"], ["Stone 1"],
         f"{WHY}, so Stone 1 is one stone of: Stone 1 # left, Stone 1 # right."),
        (["g Stone # 1", "g Stone # 2"], ["Stone"],
         f"{WHY}, so Stone is one stone of: Stone # 1, Stone # 2."),
        (["o big one", "o big other"], ["big one", "big other"], ""),
        (["g a wall", "g b wall"], ["a", "b"], ""),  # of the group and of that of all
        (["o x\ng left part", "g right part\no y"], ["x", "y"], ""),
        (["g stone_1 top", "g stone_1 side"], ["stone_1"],
         f"{WHY}, so stone_1 is one stone of: stone_1 top, stone_1 side."),
    ],
)  # fmt: skip
def test_obj_objects_and_groups(tmp_path, names, expected, said):
    settings = ReadSettings(px_per_m=50, pieces="keep-largest")
    stones = read_stones(saved(tmp_path, boxes(*names), "s.obj"), settings=settings)
    assert [stone.name for stone in stones] == expected
    assert [n.message for n in stones.notices if "groups" in n.message] == ([said] if said else [])


def test_obj_with_an_empty_object_at_its_end(tmp_path):
    path = saved(tmp_path, boxes("", "") + "\no x", "s.obj")
    assert len(read_stones(path, settings=ReadSettings(px_per_m=50))) == 2


def test_a_sphere_shows_its_circle(tmp_path):
    sphere = trimesh.creation.icosphere(subdivisions=4, radius=0.3)
    sphere.apply_scale((1, 1, 0.5))
    stones = read_stones(saved(tmp_path, sphere.export(file_type="stl"), "a.stl"))
    (stone,) = stones
    scale = stones.source.px_per_m
    assert stone.area_px / scale**2 == pytest.approx(np.pi * 0.09, rel=5e-3)
    assert stone.mask.shape[0] == pytest.approx(0.6 * scale, abs=2)
    assert "median stone is 0.6 m" in stones.notices[-1].message
    assert codes(stones) == ["W119"] * 3


@pytest.mark.parametrize(
    ("data", "name", "text"),
    [
        ("o a\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", "a.obj", r"E114 .*line 4 .* \(a face of 3"),
        ("v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", r"E114 .*less than three coordinates"),
        ("v 0 0 x\n", "a.obj", r"E114 .*line 1"),
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj", r"E114 .*not finite"),
        ("v 0 0 0\n", "a.obj", r"E114 .*no faces"),
        (b"ply\nformat binary_little_endian 1.0\nend_header\n", "a.ply", r"E1(06|14) "),
        (PLY % b"1" + b"3 0 1 3\n", "a.ply", r"E106 .*a face of unknown vertices"),
        (b"too short", "a.stl", r"E106 .*damaged"),
    ],
)
def test_damaged_meshes(tmp_path, data, name, text):
    with pytest.raises(InputError, match=text):
        read_stones(saved(tmp_path, data, name))


@pytest.mark.parametrize(("kind", "options"), KINDS[:-1])
def test_meshes_that_are_cut_short(tmp_path, kind, options):
    data = apart()[0].export(file_type=kind, **options)
    path = saved(tmp_path, data[: int(0.95 * len(data))], f"a.{kind[:3]}")
    with pytest.raises(InputError, match=r"E106 .*damaged or cut short"):
        read_stones(path)
