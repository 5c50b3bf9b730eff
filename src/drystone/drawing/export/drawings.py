"""wall-numbered.png and build-sheet.pdf, and the drawing of SVG and DXF: a planned wall."""

import numpy as np

from drystone.drawing.assembly import Assembly
from drystone.drawing.canvas import draw, figure_bytes, pdf_bytes
from drystone.drawing.drawing import (
    Dots,
    Drawable,
    Drawing,
    Lines,
    Surface,
    drawing_of_assembly,
)
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.photo import read_photo
from drystone.drawing.pictures.forces import JOINT, LONGEST_SHARE, RESULTANT, resultants
from drystone.drawing.pictures.mechanism import motion_of
from drystone.drawing.sheet.pages import BuildSheet
from drystone.statics.result import LimitResult

SMALLEST_SHARE = 0.005  # arrows of smaller forces over the largest one would be dots
STILL = 1e-4  # motions of less than this share of the wall's width are none that is seen
MOVED_COLOUR = "#d55e00"


def png(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return wall-numbered.png."""
    figure = draw(drawing_of_assembly(assembly, settings.title)).figure
    return {"wall-numbered.png": figure_bytes(figure, ".png")}


def pdf(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return build-sheet.pdf; E189 when the photograph of the stones cannot be used."""
    pages = BuildSheet(assembly, settings, read_photo(assembly)).pages()
    return {"build-sheet.pdf": pdf_bytes(page.figure for page in pages)}


def with_statics(assembly: Assembly) -> Drawing:
    """Describe a planned wall with its contacts, forces and mechanisms, which are hidden."""
    drawing = drawing_of_assembly(assembly)
    items, notes = contacts(assembly), dict[str, str]()
    for result in (assembly.resistance.left, assembly.resistance.right):
        side, alpha = result.direction.upper(), result.alpha
        at = result.status.value if alpha is None else (
            f"at a lateral load of alpha = {alpha:.4f} times the weight (adequacy factor)"
        )  # fmt: skip
        says = f"to the {result.direction}: {at}"
        arrows, length = forces(assembly, result)
        if arrows is not None:
            items.append(arrows)
            unit = "m" if assembly.unit == "m" else "px"
            scale = f"a line of {length:.4g} {unit} is the mean weight of a part"
            notes[f"FORCES-{side}"] = f"Forces {says}; {scale}"
        moved = failed(assembly, result)
        if moved:
            items += moved
            notes[f"MECHANISM-{side}"] = f"How the wall fails {says}; motion enlarged"
    hidden = tuple(sorted({item.layer for item in items}))
    return Drawing((*drawing.items, *items), drawing.box, hidden=hidden, notes=notes)


def contacts(assembly: Assembly) -> list[Drawable]:
    """Return where parts touch."""
    names = {0: "ground"} | {part.id: part.name for part in assembly.parts}
    items: list[Drawable] = []
    for face in assembly.model.interfaces:
        note = f"{names[face.block]} on {names[face.other]}"
        if len(face.points) > 1:
            ends = face.points[[0, -1]]
            items.append(Lines(note, [ends], JOINT, 0.9, layer="CONTACTS"))
        else:
            items.append(Dots(note, face.points, JOINT, 1.8, layer="CONTACTS"))
    return items


def forces(assembly: Assembly, result: LimitResult) -> tuple[Lines | None, float]:
    """Return the forces at the greatest load to one side, and the length for a mean weight.

    An arrow acts in its middle, where the parts touch.  None where there are none.
    """
    acting = () if result.forces is None else resultants(assembly.model, result.forces)
    largest = max((one.size for one in acting), default=0.0)
    if largest == 0.0:
        return None, 0.0
    mean = float(np.mean([block.weight for block in assembly.model.blocks if not block.fixed]))
    width, height = assembly.size
    length = LONGEST_SHARE * max(height, 0.2 * width) / largest
    seen = [one for one in acting if one.size >= SMALLEST_SHARE * largest]
    arrows = Lines(
        f"forces-{result.direction}",
        [one.line(length) for one in seen], RESULTANT, head=True,
        layer=f"FORCES-{result.direction.upper()}",
        notes=[f"{one.size / mean:.6g} mean weights" for one in seen],
    )  # fmt: skip
    return arrows, length * mean


def failed(assembly: Assembly, result: LimitResult) -> list[Surface]:
    """Return the parts that a mechanism moves, after its motion, which is scaled for pictures."""
    if result.mechanism is None:
        return []
    motion = motion_of({part.id: part.corners for part in assembly.parts}, result.mechanism)
    return [
        Surface(assembly.part(region.id).name, moved.loops, line=MOVED_COLOUR,
             layer=f"MECHANISM-{result.direction.upper()}")
        for region, moved in zip(motion.regions, motion.at(1.0), strict=True)
        if np.abs(moved.loops[0] - region.loops[0]).max() > STILL * assembly.size[0]
    ]  # fmt: skip
