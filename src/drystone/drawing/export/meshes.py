"""wall.obj, wall.glb and stl/: every part as a prism, in metres, Z up (frame W).

glTF has Y up.  The node ``wall`` turns it, so the nodes below have the poses of poses.json in W,
and their meshes are in S; what a viewer shows is (x, z, -y) of W.
"""

import struct
from functools import partial

import numpy as np

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.export.solids import (
    Solid,
    material,
    materials,
    require_solids,
    solid_in_wall,
    solid_of_part,
)
from drystone.drawing.export.text import number
from drystone.drawing.palette import linear

_Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def obj(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return wall.obj, an object a part in the order of building, and wall.mtl."""
    require_solids(assembly)
    return {
        "wall.obj": lambda: obj_text(assembly),
        "wall.mtl": lambda: "".join(
            f"newmtl {name}\nKd {' '.join(map(number, colour))}\nillum 1\n"
            for name, colour in materials(assembly).items()
        ),
    }


def obj_text(assembly: Assembly) -> str:
    """Return the wall as Wavefront OBJ, with all digits."""
    lines = [
        f"# drystone {assembly.plan.version}: metres, X along the wall, Y into it, Z up",
        "mtllib wall.mtl",
    ]
    first = 1
    for part in assembly.parts:
        solid = solid_in_wall(assembly, part)
        lines += [f"o {part.name}", f"usemtl {material(part)}"]
        lines += ["v " + " ".join(map(number, point)) for point in solid.vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (solid.triangles + first).tolist()]
        first += len(solid.vertices)
    return "\n".join(lines) + "\n"


def glb(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return wall.glb; E182 when trimesh is not installed."""
    require_solids(assembly)
    load_extra("trimesh", "mesh", "E182", "wall.glb")
    return {"wall.glb": lambda: glb_bytes(assembly)}


def glb_bytes(assembly: Assembly) -> bytes:
    """Return the wall as binary glTF 2.0, every part a node with its pose."""
    import trimesh  # noqa: PLC0415 - an extra

    scene = trimesh.Scene()
    scene.graph.update("wall", scene.graph.base_frame, matrix=_Y_UP)
    paint = {
        name: trimesh.visual.material.PBRMaterial(
            name=name, baseColorFactor=[*map(linear, colour), 1.0], metallicFactor=0.0,
            roughnessFactor=1.0,
        )
        for name, colour in materials(assembly).items()
    }  # fmt: skip
    for part in assembly.parts:
        solid = solid_of_part(assembly, part)
        mesh = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
        mesh.visual = trimesh.visual.TextureVisuals(material=paint[material(part)])
        scene.add_geometry(
            mesh, node_name=part.name, geom_name=part.name, parent_node_name="wall",
            transform=assembly.place_pose(part).matrix, metadata={"step": part.step},
        )  # fmt: skip
    # Without normals a viewer shades every triangle flat, as the standard says.
    made: bytes = trimesh.exchange.gltf.export_glb(scene, include_normals=False)
    return made


def stl(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return every part as a binary STL where it stands in the wall."""
    require_solids(assembly)
    return {
        f"stl/{part.name}.stl": partial(
            stl_bytes, solid_in_wall(assembly, part), f"{part.name}, frame W"
        )
        for part in assembly.parts
    }


def stl_bytes(solid: Solid, title: str) -> bytes:
    """Return a solid as binary STL; its 80 bytes of header hold a title."""
    facets = np.zeros(len(solid.triangles), _FACET)
    facets["normal"] = solid.normals
    facets["corners"] = solid.vertices[solid.triangles]
    # A header that begins with "solid" is taken for a text file.
    header = f"drystone, metres: {title}".encode("ascii")[:80].ljust(80)
    return header + struct.pack("<I", len(facets)) + facets.tobytes()
