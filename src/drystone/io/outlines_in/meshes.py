"""OBJ, PLY and STL: the outlines of bodies as they are seen from one side."""

import re
import struct
from collections import Counter
from collections.abc import Collection, Sequence
from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from drystone.errors import InputError, Notice
from drystone.io.files import damaged, foreign, listed, short, unusable
from drystone.io.outlines_in import model
from drystone.io.outlines_in.model import OutlinedStone, OutlineFile
from drystone.io.outlines_in.silhouettes import asked, shadow
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

_OURS = (b"# drystone ", b"drystone, ")
_HEAD = 400
_FURTHEST = 1e9
_NEAR, _STEPS = 4e-6, 4
"""Corners are one vertex within a share of the mesh, or steps of the float32 that they are."""
_EDGE = 0.01
"""Share of the median edge that they are never further apart than."""
_NEIGHBOURS = 8
_STL_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_STL_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")
_PLY_NAMES = b"char uchar short ushort int uint float double".split()
_PLY_SIZED = b"int8 uint8 int16 uint16 int32 uint32 float32 float64".split()
_PLY_TYPES = dict(zip(_PLY_NAMES + _PLY_SIZED, 2 * "bBhHiIfd", strict=True))
"""Codes that struct and NumPy have for them."""


_OTHERWISE = "--up y, z, y-back or z-back see it otherwise."
_OF_AXIS = {
    0: "--up y turns it if Y is up, and --up z-back sees it from the other side.",
    2: "--up z-back sees it from the other side.",
}


class MeshBody(NamedTuple):
    """A body of a mesh."""

    name: str  # empty when it has none
    faces: Sequence[NDArray[np.int64]]  # positions in the vertices, three or more a face
    said: Collection[str] = ()
    """All that the file says of it after o or g, each once; only of an OBJ."""


Mesh = tuple[Points, list[MeshBody]]
"""Vertices, (n, 3), and bodies."""


def mesh_kind(data: bytes, suffix: str) -> str | None:
    """Tell PLY, STL and OBJ by content, and by ending; None for anything else."""
    head = data[:_HEAD]
    if head.startswith((b"ply\n", b"ply\r\n")):
        return "ply"
    is_binary = len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little")
    if suffix == ".stl" or is_binary or _is_stl_text(data):
        return "stl"
    lines = [line.split() for line in data[:65536].split(b"\n")]
    is_obj = any(line[0] == b"v" and len(line) >= 4 for line in lines if line)
    return "obj" if suffix == ".obj" or is_obj else None


def read_mesh(kind: str, data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read the outlines of bodies.

    Named objects of an OBJ are a stone each; otherwise every connected body is one.  Meshes
    that drystone wrote are seen along Y with Z up, others along the axis in which all of it
    together is thinnest.  Along Y that needs to be told whether Z or Y is up, as one is the mirror
    image of the other.  Their unit is taken as the metre unless the settings name another.
    """
    vertices, bodies = _MESHES[kind](data)
    used = np.unique(np.concatenate([np.concatenate(list(b.faces)) for b in bodies]))
    with foreign(lambda why: unusable(f"a vertex cannot be used ({why})")):
        sides = np.ptp(model.within_reach(vertices[used]), axis=0)
    ours = data.startswith(_OURS)
    axis = 1 if ours else int(np.argmin(sides))
    if axis == 1 and not (ours or settings.up):
        raise InputError(
            "E116",
            "the mesh is thinnest along Y and does not say which axis is up: stones that lie "
            "there with Y up are the mirror images of stones that stand there with Z up.",
            cure="Say --up y (as Blender writes OBJ) or --up z (ReadSettings.up).",
        )
    seen = asked(np.eye(3)[axis], settings.up)
    with foreign(lambda why: unusable(f"its faces cannot be united ({why})")):
        flat = seen.of(vertices)
        areas = [shadow([flat[face] for face in b.faces]) for b in bodies]
    both = [(body, area) for body, area in zip(bodies, areas, strict=True) if area]
    stones = [OutlinedStone(model.number_in(body.name), body.name, area) for body, area in both]
    edgewise = Counter({"bodies without an area as they are seen": len(bodies) - len(stones)})
    why = "as drystone writes meshes" if ours else "in which the mesh is thinnest"
    text = f"{len(stones)} bodies, seen {seen.said} ({why})."
    notices = [Notice("W119", text, _OTHERWISE if ours or settings.up else _OF_AXIS[axis])]
    if axis != 2 and _is_inside_out(vertices, [face for body in bodies for face in body.faces]):
        text = "its faces look inwards: with axes of a left hand its stones are mirrored."
        notices.append(Notice("W119", text, "Say --up y-back or z-back if they are."))
    notices += model.left_aside(+edgewise, "Give every stone a closed surface.")
    for body in (body for body in bodies if len(body.said) > 1):
        why = "of the groups of a face the first counts, and what follows # is a comment"
        text = f"{why}, so {short(body.name)} is one stone of: {listed(map(short, body.said))}."
        cure = "Give every stone an object (o) of its own if they are several."
        notices.append(Notice("W119", text, cure))
    if not settings.unit and not ours:
        text = f"{kind.upper()} has no unit: lengths were taken as metres."
        notices.append(Notice("W119", text, "Say --unit mm (or cm, in, ft) if they are not."))
    unit_m = model.METRES.get(settings.unit or "m")
    return OutlineFile(stones, unit_m, True, notices=notices, in_space=True, seen_by="either")


def _is_inside_out(vertices: Points, faces: Sequence[NDArray[np.int64]]) -> bool:
    """Tell whether bodies have a volume below 0, by the sense of rotation of their faces."""
    corners, sizes = np.concatenate(faces), np.array([len(face) for face in faces])
    ends = sizes.cumsum()
    after = np.roll(corners, -1)
    after[ends - 1] = corners[ends - sizes]
    vertices = vertices - vertices[corners].mean(axis=0)
    first = vertices[np.repeat(corners[ends - sizes], sizes)]
    sixths = np.einsum("ij,ij->i", first, np.cross(vertices[corners], vertices[after]))
    return bool(sixths.sum() < -0.01 * np.abs(sixths).sum())


def _is_stl_text(data: bytes) -> bool:
    head = data[:_HEAD].lower().lstrip()
    return head.startswith(b"solid") and b"facet" in head


def _stl(data: bytes) -> Mesh:
    """Read triangles, of a text or of binary data."""
    if _is_stl_text(data):
        data = data.lower()
        found = _STL_VERTEX.findall(data)
        is_whole = len(found) == 3 * data.count(b"endfacet") and b"endsolid" in data[-_HEAD:]
        if not found or not is_whole:
            raise _cut("its facets have no three corners, or endsolid is missing")
        with foreign(_cut):
            corners = np.array(found, float)
    else:
        number = int.from_bytes(data[80:84], "little")
        if number == 0 or len(data) < 84 + _STL_FACET.itemsize * number:
            raise _cut(f"it has {len(data)} bytes, and says {number} triangles")
        facets = np.frombuffer(data, _STL_FACET, number, offset=84)
        corners = facets["corners"].reshape(-1, 3).astype(float)
        if not np.isfinite(corners).all():
            raise unusable("a vertex is not finite")
    return _bodies(corners, list(np.arange(len(corners)).reshape(-1, 3)))


def _ply(data: bytes) -> Mesh:
    """Read a PLY, of a text or of binary data; faces may have any number of corners."""
    head, _, body = data.partition(b"\nend_header")
    said = re.search(rb"^format\s+(\w+)", head, re.MULTILINE)
    order, codes = ">" if said and said[1] == b"binary_big_endian" else "<", _PLY_TYPES
    found, faces, at = {b"vertex": np.empty(0, [(axis, "d") for axis in "xyz"])}, [], 0
    with foreign(_cut):
        body = body.partition(b"\n")[2]
        if said and said[1] == b"ascii":
            body, codes = np.fromstring(body, "<d", sep=" ").tobytes(), dict.fromkeys(codes, "d")
        for part in re.split(rb"^element\s", head, flags=re.MULTILINE)[1:]:
            (element, number), *lines = (line.split() for line in part.splitlines())
            properties = [line[1:] for line in lines if line[:1] == [b"property"]]
            if all(len(one) == 2 for one in properties):
                row = np.dtype([(name.decode(), order + codes[kind]) for kind, name in properties])
                found[element] = np.frombuffer(body, row, int(number), at)
                at += found[element].nbytes
                continue
            for _ in range(int(number)):
                for *kinds, name in properties:
                    values: tuple[float, ...] = (1,)
                    for kind in kinds[1:] or kinds:  # of a list, first how long it is
                        form = f"{order}{int(values[0])}{codes[kind]}"
                        values = struct.unpack_from(form, body, at)
                        at += struct.calcsize(form)
                    if element == b"face" and name in (b"vertex_index", b"vertex_indices"):
                        faces.append(np.array(values, np.int64))
        vertices = np.column_stack([found[b"vertex"][axis].astype(float) for axis in "xyz"])
    if not faces:
        raise unusable("the mesh has no faces")
    corners, least = np.concatenate(faces), min(map(len, faces))
    if least < 3 or not 0 <= corners.min() <= corners.max() < len(vertices):
        raise _cut("a face of less than three corners, or of unknown vertices")
    return _bodies(vertices, faces)


def _cut(why: str) -> InputError:
    return damaged(why, what="mesh")


def _obj(data: bytes) -> Mesh:
    """Read vertices, faces and object names of an OBJ; faces may have any number of corners.

    Where there are objects (o), groups (g) are their parts; otherwise they are the stones.
    """
    points: list[list[float]] = []
    # By kind and name of what begins them, none before the first: faces, and all that is said.
    parts: dict[tuple[str, str], tuple[list[NDArray[np.int64]], dict[str, None]]] = {}
    part, title = ("", ""), ""
    # A line may go on after a \, from where on it is another line of the file: \x1f is a space.
    text, number = re.sub(r"\\\r?\n", "\x1f", data.decode("utf-8", "replace")), 1
    for line in text.splitlines():
        words = line.split()
        try:
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                corners = np.array([int(word.split("/")[0]) for word in words[1:]])
                # Negative ones count from the last.
                corners = np.where(corners < 0, corners + len(points), corners - 1)
                if len(corners) < 3 or corners.min() < 0 or corners.max() >= len(points):
                    raise ValueError(f"a face of {len(corners)} corners, or of unknown vertices")
                faces, said = parts.setdefault(part, ([], {}))
                faces.append(corners)
                said[title] = None
            elif words[:1] == ["o"] or (words[:1] == ["g"] and part[0] != "o"):
                title = " ".join(words[1:])
                part = words[0], _name(*words)
        except ValueError as error:
            raise unusable(f"line {number} cannot be used ({error})") from error
        number += 1 + line.count("\x1f")
    if any(len(point) < 3 for point in points):
        raise unusable("a vertex has less than three coordinates")
    vertices = np.array(points, float).reshape(-1, 3)
    all_faces = [face for faces, _ in parts.values() for face in faces]
    if not any(kind for kind, _ in parts):
        return _bodies(vertices, all_faces)
    vertices, all_faces = _welded(vertices, all_faces)
    rest = iter(all_faces)
    return vertices, [
        MeshBody(name, list(islice(rest, len(faces))), said)
        for (_, name), (faces, said) in parts.items()
    ]


def _name(kind: str, *words: str) -> str:
    """Return the name of what a line o or g begins.

    An object has one name, be there spaces in it.  A group line lists groups that its faces all
    belong to, the one of the thing itself first (then of its parents, or its colour), unless the
    words together are the number of a stone.  Such a number may have a comment after it; any
    other # is of the name, as programs that write OBJ put no comments there.
    """
    title = " ".join(words)
    numbered = title.partition(" # ")[0]
    if model.number_in(numbered) is not None:
        return numbered
    return title if kind == "o" or not words else words[0]


def _welded(
    vertices: Points, faces: list[NDArray[np.int64]]
) -> tuple[Points, list[NDArray[np.int64]]]:
    """Make corners in one place one vertex, whatever normals or textures they have.

    That place is as wide as what programs lose that turn and round each corner by itself.
    """
    places, index = np.unique(vertices, axis=0, return_inverse=True)
    corners = index.ravel()[np.concatenate(faces)]
    ends = np.cumsum([len(face) for face in faces])
    if not np.isfinite(places).all() or np.abs(places).max() > _FURTHEST:
        return places, np.split(corners, ends[:-1])
    edges = places[corners] - places[np.roll(corners, -1)]
    edges = np.linalg.norm(np.delete(edges, ends - 1, axis=0), axis=1)
    near = _NEAR * float(np.ptp(places, axis=0).max())
    steps = np.spacing(np.abs(places).astype(np.float32))
    # The further from the origin, the coarser; text may have been rounded once more.
    if np.median(np.abs(places - places.astype(np.float32)) / steps) < 0.1:
        near = max(near, _STEPS * float(steps.max()))
    near = min(near, _EDGE * float(np.median(edges)))
    count = len(places)
    distance, other = KDTree(places).query(places, k=_NEIGHBOURS, distance_upper_bound=near)
    one, which = np.nonzero(np.isfinite(distance))
    links = coo_array((np.ones(len(one), bool), (one, other[one, which])), shape=(count, count))
    label = connected_components(links, directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    return places[first], np.split(label[corners], ends[:-1])


def _bodies(vertices: Points, faces: list[NDArray[np.int64]]) -> Mesh:
    """Split faces into bodies that hang together, in the order of their first faces."""
    if not faces or not len(vertices):
        raise unusable("the mesh has no faces")
    vertices, faces = _welded(vertices, faces)
    first = np.array([face[0] for face in faces])
    pairs = np.concatenate([np.column_stack([face, np.roll(face, 1)]) for face in faces])
    links = coo_array((np.ones(len(pairs), bool), pairs.T), shape=(len(vertices),) * 2)
    labels = connected_components(links, directed=False)[1][first]
    found: dict[int, list[NDArray[np.int64]]] = {}
    for label, face in zip(labels.tolist(), faces, strict=True):
        found.setdefault(label, []).append(face)
    return vertices, [MeshBody("", part) for part in found.values()]


_MESHES = {"obj": _obj, "ply": _ply, "stl": _stl}
