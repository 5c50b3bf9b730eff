"""wall.obj and wall.mtl: every part as a named object, in metres, Z up (frame W)."""

from pathlib import Path

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.out import number, put
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.export.solids import material, materials, require_solids, solid_in_wall

FILE = "wall.obj"
MATERIALS_FILE = "wall.mtl"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E131 without a scale, E180 without a solid."""
    require_solids(assembly)
    return FILE, MATERIALS_FILE


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write the objects and their materials."""
    return (
        put(folder, FILE, obj_text(assembly)),
        put(folder, MATERIALS_FILE, mtl_text(assembly)),
    )


def obj_text(assembly: Assembly) -> str:
    """Return the wall as Wavefront OBJ: an object a part, in the order of building."""
    lines = [
        f"# drystone {assembly.plan.version}: metres, X along the wall, Y into it, Z up",
        f"mtllib {MATERIALS_FILE}",
    ]
    first = 1
    for part in assembly.parts:
        solid = solid_in_wall(assembly, part)
        lines += [f"o {part.name}", f"usemtl {material(part)}"]
        lines += ["v " + " ".join(map(number, point)) for point in solid.vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (solid.triangles + first).tolist()]
        first += len(solid.vertices)
    return "\n".join(lines) + "\n"


def mtl_text(assembly: Assembly) -> str:
    """Return the colours of clusters and wedges as MTL."""
    lines = []
    for name, colour in materials(assembly).items():
        lines += [f"newmtl {name}", "Kd " + " ".join(map(number, colour)), "illum 1"]
    return "\n".join(lines) + "\n"
