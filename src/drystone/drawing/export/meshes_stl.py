"""stl/: every part as a binary STL where it stands in the wall (frame W), in metres, Z up."""

import struct
from pathlib import Path

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.out import put
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.export.solids import Solid, require_solids, solid_in_wall

FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E131 without a scale, E180 without a solid."""
    require_solids(assembly)
    return tuple(map(_name, assembly.parts))


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write a file a part."""
    return tuple(
        put(folder, _name(part), stl_bytes(solid_in_wall(assembly, part), f"{part.name}, frame W"))
        for part in assembly.parts
    )


def stl_bytes(solid: Solid, title: str) -> bytes:
    """Return a solid as binary STL; its 80 bytes of header hold a title.

    Examples
    --------
    >>> box = Solid(np.zeros((3, 3)), np.zeros((0, 3), int))
    >>> len(stl_bytes(box, "nothing"))
    84
    """
    facets = np.zeros(len(solid.triangles), FACET)
    facets["normal"] = solid.normals
    facets["corners"] = solid.vertices[solid.triangles]
    # A header that begins with "solid" is taken for a text file.
    header = f"drystone, metres: {title}".encode("ascii")[:80].ljust(80)
    return header + struct.pack("<I", len(facets)) + facets.tobytes()


def _name(part: Part) -> str:
    return f"stl/{part.name}.stl"
