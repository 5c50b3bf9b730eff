"""OBJ, PLY and STL: the outlines of bodies as they are seen from one side."""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from drystone.errors import InputError, Notice
from drystone.io.file_errors import damaged, listed, short, unusable
from drystone.io.foreign import extra, foreign
from drystone.io.outlines_in.model import METRES, OutlinedStone, OutlineFile, number_in
from drystone.io.outlines_in.silhouettes import shadow
from drystone.io.read_settings import ReadSettings

_VIEWS = {
    0: ([1, 2], "along X, with Y to the right and Z up"),
    1: ([0, 2], "along Y, with X to the right and Z up"),
    2: ([0, 1], "along Z, with X to the right and Y up"),
}
"""Axes to the right and up, when one looks along the third: along -X, +Y, or -Z."""
_OURS = (b"# drystone ", b"drystone, ")
_HEAD = 400
_STL_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_STL_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")
_PLY_FACES = re.compile(rb"^element\s+face\s+(\d{1,18})", re.MULTILINE)


@dataclass(frozen=True, eq=False)
class MeshBody:
    """A body of a mesh."""

    name: str  # empty when it has none
    vertices: NDArray[np.float64]  # (n, 3), of the whole file
    faces: Sequence[NDArray[np.int64]]  # positions in `vertices`, three or more a face
    said: tuple[str, ...] = ()
    """All that the file says of it after o or g, each once; only of an OBJ."""


def mesh_kind(data: bytes, suffix: str) -> str | None:
    """Tell PLY, STL and OBJ by content, and by ending; None for anything else."""
    head = data[:_HEAD]
    if head.startswith((b"ply\n", b"ply\r\n")):
        return "ply"
    if suffix == ".stl" or (head.lstrip().startswith(b"solid") and b"facet" in head):
        return "stl"
    if len(data) >= 84 and len(data) == 84 + 50 * int.from_bytes(data[80:84], "little"):
        return "stl"
    lines = [line.split() for line in data[:65536].split(b"\n")]
    is_obj = any(line[0] == b"v" and len(line) >= 4 for line in lines if line)
    return "obj" if suffix == ".obj" or is_obj else None


def read_mesh(kind: str, data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read the outlines of bodies.

    Named objects of an OBJ are a stone each; otherwise every connected body is one.  Meshes
    that drystone wrote are seen along Y with Z up, others along the axis in which all of it
    together is thinnest.  Their unit is taken as the metre unless the settings name another.
    """
    bodies = _BODIES[kind](data)
    used = np.unique(np.concatenate([np.concatenate(list(b.faces)) for b in bodies]))
    vertices = bodies[0].vertices[used]
    if not np.isfinite(vertices).all() or np.abs(vertices).max() > 1e9:
        raise unusable("a vertex is not finite or beyond 1e9")
    ours = data.startswith(_OURS)
    axis = 1 if ours else int(np.argmin(np.ptp(vertices, axis=0)))
    plane, view = _VIEWS[axis]
    with foreign(lambda why: unusable(f"its faces cannot be united ({why})")):
        areas = [shadow([b.vertices[face][:, plane] for face in b.faces]) for b in bodies]
    both = zip(bodies, areas, strict=True)
    stones = [OutlinedStone(number_in(body.name), body.name, area) for body, area in both]
    why = "as drystone writes meshes" if ours else "in which the mesh is thinnest"
    notices = [Notice("W119", f"{len(stones)} bodies, seen {view} ({why}).")]
    notices += [_united(body) for body in bodies if len(body.said) > 1]
    if not settings.unit and not ours:
        text = f"{kind.upper()} has no unit: lengths were taken as metres."
        notices.append(Notice("W119", text, "Say --unit mm (or cm, in, ft) if they are not."))
    unit_m = METRES.get(settings.unit or "m")
    return OutlineFile(stones, unit_m, y_up=True, notices=notices, seen_by="either")


def _united(body: MeshBody) -> Notice:
    shown = listed(map(short, body.said))
    why = "of the groups of a face the first counts, and what follows # is a comment"
    text = f"{why}, so {short(body.name)} is one stone of: {shown}."
    return Notice("W119", text, "Give every stone an object (o) of its own if they are several.")


def _stl_bodies(data: bytes) -> list[MeshBody]:
    """Read triangles; equal corners are one vertex, so that bodies hang together."""
    is_text = data.lstrip().startswith(b"solid") and b"facet" in data[:_HEAD]
    corners = _stl_text(data) if is_text else _stl_binary(data)
    vertices, places = np.unique(corners, axis=0, return_inverse=True)
    return _bodies(vertices, list(places.reshape(-1, 3)))


def _stl_text(data: bytes) -> NDArray[np.float64]:
    found = _STL_VERTEX.findall(data)
    if not found or len(found) != 3 * data.count(b"endfacet") or b"endsolid" not in data[-_HEAD:]:
        raise _cut("its facets have no three corners, or endsolid is missing")
    try:
        return np.array([[float(word) for word in corner] for corner in found])
    except ValueError as error:
        raise _cut(str(error)) from error


def _stl_binary(data: bytes) -> NDArray[np.float64]:
    number = int.from_bytes(data[80:84], "little")
    if number == 0 or len(data) < 84 + _STL_FACET.itemsize * number:
        raise _cut(f"it has {len(data)} bytes, and says {number} triangles")
    corners = np.frombuffer(data, _STL_FACET, number, offset=84)["corners"].reshape(-1, 3)
    if not np.isfinite(corners).all():
        raise unusable("a vertex is not finite")
    return corners.astype(float)


def _ply_bodies(data: bytes) -> list[MeshBody]:
    trimesh = extra("trimesh", "reads PLY", "mesh", "mesh")
    with foreign(_cut):
        mesh = trimesh.load_mesh(io.BytesIO(data), file_type="ply", process=True)
        vertices, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)
    said = _PLY_FACES.search(data)
    if said and len(faces) < int(said[1]):
        raise _cut(f"{len(faces)} of {int(said[1])} faces")
    return _bodies(vertices, list(faces))


def _cut(why: str) -> InputError:
    return damaged(why, what="mesh")


def _obj_bodies(data: bytes) -> list[MeshBody]:
    """Read vertices, faces and object names of an OBJ; faces may have any number of corners.

    Where there are objects (o), groups (g) are their parts; otherwise they are the stones.
    """
    points: list[list[float]] = []
    parts: dict[_Part, list[NDArray[np.int64]]] = {}
    said: dict[_Part, dict[str, None]] = {}
    nameless = _Part("", "")
    part, title = nameless, ""
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), start=1):
        words = line.split()
        try:
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                parts.setdefault(part, []).append(_face(words[1:], len(points)))
                said.setdefault(part, {})[title] = None
            elif words[:1] == ["o"] or (words[:1] == ["g"] and part.kind != "o"):
                part, title = _part(line)
        except ValueError as error:
            raise unusable(f"line {number} cannot be used ({error})") from error
    if any(len(point) < 3 for point in points):
        raise unusable("a vertex has less than three coordinates")
    vertices = np.array(points, float).reshape(-1, 3)
    if not any(part.kind for part in parts):
        return _bodies(vertices, parts.get(nameless, []))
    return [MeshBody(part.name, vertices, parts[part], tuple(said[part])) for part in parts]


class _Part(NamedTuple):
    """An object (o) or a group (g) of an OBJ; of no kind before the first of them."""

    kind: str
    name: str


def _part(line: str) -> tuple[_Part, str]:
    """Return what a line o or g begins, and all that it says.

    An object has one name, be there spaces in it.  A group line lists groups that its faces all
    belong to, the one of the thing itself first (then of its parents, or its colour), unless the
    words together are the number of a stone.  Such a number may have a comment after it; any
    other # is of the name, as programs that write OBJ put no comments there.
    """
    kind, *words = line.split()
    title = " ".join(words)
    numbered = title.partition(" # ")[0]
    if number_in(numbered) is not None:
        return _Part(kind, numbered), title
    return _Part(kind, title if kind == "o" or not words else words[0]), title


def _face(words: list[str], count: int) -> NDArray[np.int64]:
    """Return the corners of a face after `count` vertices; negative ones count from the last."""
    corners = np.array([int(word.split("/")[0]) for word in words])
    corners = np.where(corners < 0, corners + count, corners - 1)
    if len(corners) < 3 or corners.min() < 0 or corners.max() >= count:
        raise ValueError(f"a face of {len(words)} corners, or of unknown vertices")
    return corners


def _bodies(vertices: NDArray[np.float64], faces: list[NDArray[np.int64]]) -> list[MeshBody]:
    """Split faces into bodies that hang together, in the order of their first faces."""
    if not faces or not len(vertices):
        raise unusable("the mesh has no faces")
    first = np.array([face[0] for face in faces])
    pairs = np.concatenate([np.column_stack([face, np.roll(face, 1)]) for face in faces])
    links = coo_array((np.ones(len(pairs), bool), pairs.T), shape=(len(vertices),) * 2)
    labels = connected_components(links, directed=False)[1][first]
    found: dict[int, list[NDArray[np.int64]]] = {}
    for label, face in zip(labels.tolist(), faces, strict=True):
        found.setdefault(label, []).append(face)
    return [MeshBody("", vertices, part) for part in found.values()]


_BODIES = {"obj": _obj_bodies, "ply": _ply_bodies, "stl": _stl_bodies}
