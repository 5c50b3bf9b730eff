"""assembly.compas.json: frames and meshes that COMPAS reads with ``compas.json_load``.

It is plain JSON, so that COMPAS need not be installed to write it.
"""

from typing import Any

from drystone.drawing.assembly import handling
from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.export.solids import Solid, require_solids, solid_of_part
from drystone.drawing.export.text import json_text
from drystone.model.frames3d import Pose3d


def compas(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return assembly.compas.json; E180 without a solid."""
    require_solids(assembly)
    return {"assembly.compas.json": lambda: json_text(to_json(assembly)) + "\n"}


def to_json(assembly: Assembly) -> dict[str, Any]:
    """Return a mapping whose frames and meshes COMPAS makes objects of; E131 without a scale.

    An element's `mesh` is in its own frame S, `place` and `pick` are where S is in W and in P.
    """
    return {
        "schema": "drystone-compas/1",
        "version": assembly.plan.version,
        "units": "m",
        "thickness_m": assembly.thickness,
        "density_kg_m3": assembly.density_kg_m3,
        "elements": [_element(assembly, part) for part in assembly.parts],
    }


def _element(assembly: Assembly, part: Part) -> dict[str, Any]:
    pick = assembly.pick_pose(part)
    return {
        "step": part.step,
        "kind": part.kind,
        "id": part.id,
        "name": part.name,
        "place": frame(assembly.place_pose(part)),
        "pick": pick and frame(pick),
        "mesh": mesh(solid_of_part(assembly, part), part.name),
        "mass_kg": assembly.mass_kg(part),
        "neighbours": handling.touched_when_placed(assembly, part),
    }


def frame(pose: Pose3d) -> dict[str, Any]:
    """Return a pose as the data of a ``compas.geometry.Frame``."""
    return {
        "dtype": "compas.geometry/Frame",
        "data": {
            "point": [pose.x_m, pose.y_m, pose.z_m],
            "xaxis": list(pose.xaxis),
            "yaxis": list(pose.yaxis),
        },
    }


def mesh(solid: Solid, name: str) -> dict[str, Any]:
    """Return a solid as the data of a ``compas.datastructures.Mesh``."""
    points = solid.vertices.tolist()
    faces = solid.triangles.tolist()
    return {
        "dtype": "compas.datastructures/Mesh",
        "data": {
            "attributes": {},
            "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0},
            "default_edge_attributes": {},
            "default_face_attributes": {},
            "vertex": {
                str(i): dict(zip("xyz", point, strict=True)) for i, point in enumerate(points)
            },
            "face": {str(i): face for i, face in enumerate(faces)},
            "facedata": {str(i): {} for i in range(len(faces))},
            "edgedata": {},
            "max_vertex": len(points) - 1,
            "max_face": len(faces) - 1,
        },
        "name": name,
    }
