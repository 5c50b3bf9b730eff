"""wall.glb: the wall as binary glTF 2.0, every part a node with its pose.

glTF has Y up.  The root node turns the wall, so the nodes below it have the poses of poses.json
in W and their meshes are in S; what a viewer shows is (x, z, -y) of W.
"""

import json
import math
import struct
from pathlib import Path
from typing import Any

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.out import put
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.export.solids import Solid, material, materials, require_solids, solid_of_part

FILE = "wall.glb"

_FLOAT, _UINT32 = 5126, 5125
_VERTICES, _INDICES = 34962, 34963


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E131 without a scale, E180 without a solid."""
    require_solids(assembly)
    return (FILE,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write the file."""
    return (put(folder, FILE, glb_bytes(assembly)),)


def glb_bytes(assembly: Assembly) -> bytes:
    """Return the wall as one binary glTF."""
    buffer = bytearray()
    gltf: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"drystone {assembly.plan.version}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [_root(len(assembly.parts))],
        "materials": [_material(name, colour) for name, colour in materials(assembly).items()],
        "meshes": [],
        "accessors": [],
        "bufferViews": [],
    }
    order = {name: index for index, name in enumerate(materials(assembly))}
    for index, part in enumerate(assembly.parts):
        gltf["nodes"].append(_node(assembly, part, index))
        primitive = _primitive(gltf, buffer, solid_of_part(assembly, part))
        primitive["material"] = order[material(part)]
        gltf["meshes"].append({"name": part.name, "primitives": [primitive]})
    gltf["buffers"] = [{"byteLength": len(buffer)}]
    text = json.dumps(gltf, separators=(",", ":"), allow_nan=False).encode()
    chunks = _chunk(b"JSON", text, b" ") + _chunk(b"BIN\0", bytes(buffer), b"\0")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def linear(value: float) -> float:
    """Return a part of an sRGB colour as light, as glTF wants it.

    Examples
    --------
    >>> linear(0.0), linear(1.0)
    (0.0, 1.0)
    """
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _root(count: int) -> dict[str, Any]:
    half = math.sqrt(0.5)
    return {
        "name": "wall",
        "rotation": [-half, 0.0, 0.0, half],
        "children": list(range(1, count + 1)),
    }


def _node(assembly: Assembly, part: Part, mesh: int) -> dict[str, Any]:
    pose = assembly.place_pose(part)
    turn = pose.quaternion
    return {
        "name": part.name,
        "mesh": mesh,
        "translation": [pose.x_m, pose.y_m, pose.z_m],
        "rotation": [turn.x + 0.0, turn.y + 0.0, turn.z + 0.0, turn.w + 0.0],
        "extras": {"step": part.step},
    }


def _material(name: str, colour: tuple[float, float, float]) -> dict[str, Any]:
    return {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*map(linear, colour), 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
    }


def _primitive(gltf: dict[str, Any], buffer: bytearray, solid: Solid) -> dict[str, Any]:
    # No normals are given: a viewer then shades every triangle flat, as the standard says.
    points = solid.vertices.astype("<f4")
    limits = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    vectors = {"componentType": _FLOAT, "count": len(points), "type": "VEC3", **limits}
    position = _accessor(gltf, buffer, points.tobytes(), _VERTICES, vectors)
    corners = solid.triangles.astype("<u4")
    numbers = {"componentType": _UINT32, "count": corners.size, "type": "SCALAR"}
    indices = _accessor(gltf, buffer, corners.tobytes(), _INDICES, numbers)
    return {"attributes": {"POSITION": position}, "indices": indices}


def _accessor(
    gltf: dict[str, Any], buffer: bytearray, data: bytes, target: int, accessor: dict[str, Any]
) -> int:
    view = {"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data), "target": target}
    buffer += data
    gltf["bufferViews"].append(view)
    gltf["accessors"].append({"bufferView": len(gltf["bufferViews"]) - 1, **accessor})
    return len(gltf["accessors"]) - 1


def _chunk(kind: bytes, data: bytes, filler: bytes) -> bytes:
    data += filler * (-len(data) % 4)
    return struct.pack("<I4s", len(data), kind) + data
