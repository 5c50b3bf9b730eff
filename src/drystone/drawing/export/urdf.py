"""urdf/: the wall as a URDF, a link a part at its place, with mesh, mass and inertia.

Links have the frame S of their part; fixed joints to the link ``wall``, whose frame is W, hold
them at their places.  Meshes are binary STL in metres, named relative to the URDF.
"""

import math
from functools import partial
from xml.etree import ElementTree as ET

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.export.meshes import stl_bytes
from drystone.drawing.export.solids import colour, inertia, material, require_solids, solid_of_part
from drystone.drawing.export.text import number
from drystone.model.frames3d import Pose3d

BASE = "wall"
"""Name of the link whose frame is W."""


def urdf(assembly: Assembly, settings: ExportSettings) -> Files:  # noqa: ARG001
    """Return the description and a mesh a part; E180 without a solid."""
    require_solids(assembly)
    head = '<?xml version="1.0"?>\n'
    return {
        "urdf/wall.urdf": lambda: f"{head}{ET.tostring(robot(assembly), encoding='unicode')}\n",
        **{
            f"urdf/{_mesh(part)}": partial(
                stl_bytes, solid_of_part(assembly, part), f"{part.name}, frame S"
            )
            for part in assembly.parts
        },
    }


def robot(assembly: Assembly) -> ET.Element:
    """Return the description as an XML element; E131 without a scale."""
    root = ET.Element("robot", name="drystone_wall")
    ET.SubElement(root, "link", name=BASE)
    for part in assembly.parts:
        _link(root, assembly, part)
        _joint(root, part, assembly.place_pose(part))
    ET.indent(root, " ")
    return root


def _link(root: ET.Element, assembly: Assembly, part: Part) -> None:
    link, found = ET.SubElement(root, "link", name=part.name), inertia(assembly, part)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_row(*found.centre), rpy=_row(0.0, 0.0, 0.0))
    ET.SubElement(inertial, "mass", value=number(found.mass_kg))
    tensor = {
        f"i{'xyz'[i]}{'xyz'[j]}": number(found.tensor[i, j]) for i in range(3) for j in range(i, 3)
    }
    ET.SubElement(inertial, "inertia", tensor)
    for name in ("visual", "collision"):
        body = ET.SubElement(link, name)
        ET.SubElement(ET.SubElement(body, "geometry"), "mesh", filename=_mesh(part))
        if name == "visual":
            paint = ET.SubElement(body, "material", name=material(part))
            ET.SubElement(paint, "color", rgba=_row(*colour(part), 1.0))


def _joint(root: ET.Element, part: Part, pose: Pose3d) -> None:
    joint = ET.SubElement(root, "joint", name=f"place_{part.name}", type="fixed")
    ET.SubElement(joint, "parent", link=BASE)
    ET.SubElement(joint, "child", link=part.name)
    # Parts are turned about Y only, which is the pitch.
    turn = _row(0.0, -math.radians(part.angle_deg), 0.0)
    ET.SubElement(joint, "origin", xyz=_row(pose.x_m, pose.y_m, pose.z_m), rpy=turn)


def _mesh(part: Part) -> str:
    return f"meshes/{part.name}.stl"


def _row(*values: float) -> str:
    return " ".join(map(number, values))
