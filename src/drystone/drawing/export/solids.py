"""Parts as prisms of triangles, in metres: mass and inertia, wall.obj, wall.glb and stl/, Z up.

glTF has Y up.  The node ``wall`` turns it, so the nodes below have the poses of poses.json in W,
and their meshes are in S; what a viewer shows is (x, z, -y) of W.
"""

import struct
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from drystone.drawing.assembly import Assembly, Part
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.palette import PLAIN_COLOUR, WEDGE_COLOUR, Rgb, cluster_colour, linear, rgb
from drystone.errors import InputError
from drystone.io.json_text import number
from drystone.kernels.polygons import Points, area_and_centroid
from drystone.model.frames3d import Matrix, Vector
from drystone.model.outline import second_moments


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed surface in metres; triangles are counter-clockwise as seen from outside."""

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]

    @property
    def normals(self) -> NDArray[np.float64]:
        """(m, 3) unit vectors out of the triangles."""
        first, second, third = (self.vertices[self.triangles[:, i]] for i in range(3))
        across = np.cross(second - first, third - first)
        return np.asarray(across / np.linalg.norm(across, axis=1)[:, None]) + 0.0


def solid_in_wall(assembly: Assembly, part: Part) -> Solid:
    """Return a part where it stands in the wall (frame W), between y = 0 and the thickness."""
    return extruded(part.corners, 0.0, assembly.thickness, part.name)


def solid_of_part(assembly: Assembly, part: Part) -> Solid:
    """Return a part in its own frame (S), half of it before y = 0."""
    half = assembly.thickness / 2.0
    return extruded(part.own_corners, -half, half, part.name)


def extruded(outline: Points, front: float, back: float, name: str = "outline") -> Solid:
    """Return a prism along Y from `front` to `back`.

    The outline is counter-clockwise in x and z, not closed; E180 names it when it crosses or
    touches itself, or has no area.
    """
    polygon, count = shapely.Polygon(outline), len(outline)
    place = {corner: index for index, corner in enumerate(map(tuple, outline.tolist()))}
    whole = polygon.is_valid and polygon.area > 0.0 and len(place) == count
    pieces = shapely.get_parts(shapely.constrained_delaunay_triangles(polygon)) if whole else ()
    if len(pieces) != count - 2:
        what = f"the outline of {name} crosses or touches itself, so it bounds no solid."
        cure = "Plan with exact geometry, whose outlines are simple, or clean the wall image."
        raise InputError("E180", what, where=name, cure=cure)
    corners = shapely.get_coordinates(shapely.orient_polygons(pieces)).reshape(-1, 4, 2)[:, :3]
    flat = [place[x, z] for x, z in corners.reshape(-1, 2).tolist()]
    face = np.array(flat, dtype=np.int64).reshape(-1, 3)
    x, z = outline.T
    vertices = np.concatenate([np.column_stack([x, np.full(count, y), z]) for y in (front, back)])
    here = np.arange(count)
    there = np.roll(here, -1)
    sides = [(here, here + count, there + count), (here, there + count, there)]
    triangles = np.concatenate(
        [face, face[:, ::-1] + count, *(np.column_stack(side) for side in sides)]
    )
    return Solid(vertices, triangles)


def inertia(assembly: Assembly, part: Part) -> tuple[Vector, Matrix]:
    """Return the centre of a part in S and its inertia about it along S, kg m2: a prism's.

    The centre is that of the outline; of a plan on pixels it is a fraction of a px from the
    origin of S, which is the plan's centroid.
    """
    area, x, z = area_and_centroid(part.own_corners)
    mass = assembly.mass_kg(part)
    xx, zz, xz = np.array(second_moments(part.own_corners)) * (mass / area)
    yy = mass * assembly.thickness**2 / 12.0
    tensor = np.array([[zz + yy, 0.0, -xz], [0.0, xx + zz, 0.0], [-xz, 0.0, xx + yy]])
    return (x, 0.0, z), tensor + 0.0


def material(part: Part) -> tuple[str, Rgb]:
    """Return the name of a part's material (cluster_3, stone or wedge) and its colour, sRGB."""
    if part.kind == "wedge":
        return "wedge", rgb(WEDGE_COLOUR)
    if part.cluster is None:
        return "stone", rgb(PLAIN_COLOUR)
    return f"cluster_{part.cluster}", rgb(cluster_colour(part.cluster))


_Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
_FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def obj(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return wall.obj, an object a part in the order of building, and wall.mtl."""
    lines = [
        f"# drystone {assembly.plan.version}: metres, X along the wall, Y into it, Z up",
        "mtllib wall.mtl",
    ]
    first = 1
    for part in assembly.parts:
        solid = solid_in_wall(assembly, part)
        lines += [f"o {part.name}", f"usemtl {material(part)[0]}"]
        lines += ["v " + " ".join(map(number, point)) for point in solid.vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (solid.triangles + first).tolist()]
        first += len(solid.vertices)
    paints = (
        f"newmtl {name}\nKd {' '.join(map(number, colour))}\nillum 1\n"
        for name, colour in dict(map(material, assembly.parts)).items()
    )
    return {"wall.obj": "\n".join(lines) + "\n", "wall.mtl": "".join(paints)}


def glb(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return wall.glb, every part a node with its pose; E182 when trimesh is not installed."""
    trimesh = load_extra("trimesh", "mesh", "E182", "wall.glb")
    scene = trimesh.Scene()
    scene.graph.update("wall", scene.graph.base_frame, matrix=_Y_UP)
    paint = {
        name: trimesh.visual.material.PBRMaterial(
            name=name, baseColorFactor=[*map(linear, colour), 1.0], metallicFactor=0.0,
            roughnessFactor=1.0,
        )
        for name, colour in dict(map(material, assembly.parts)).items()
    }  # fmt: skip
    for part in assembly.parts:
        solid = solid_of_part(assembly, part)
        mesh = trimesh.Trimesh(solid.vertices, solid.triangles, process=False)
        mesh.visual = trimesh.visual.TextureVisuals(material=paint[material(part)[0]])
        scene.add_geometry(
            mesh, node_name=part.name, geom_name=part.name, parent_node_name="wall",
            transform=assembly.place_pose(part).matrix, metadata={"step": part.step},
        )  # fmt: skip
    # Without normals a viewer shades every triangle flat, as the standard says.
    return {"wall.glb": trimesh.exchange.gltf.export_glb(scene, include_normals=False)}


def stl(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return every part as a binary STL where it stands in the wall."""
    return {
        f"stl/{part.name}.stl": stl_bytes(solid_in_wall(assembly, part), f"{part.name}, frame W")
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
