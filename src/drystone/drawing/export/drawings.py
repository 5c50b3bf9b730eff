"""The wall as drawings: wall.svg, wall.dxf, wall-numbered.png and build-sheet.pdf.

The SVG is in millimetres, or px of the source image when there is no scale; the DXF (R2010) in
metres, or without a unit.  Both have layers: SITE, STONES, WEDGES, NUMBERS, and, not shown at
first, CONTACTS, FORCES-LEFT and -RIGHT, MECHANISM-LEFT and -RIGHT.  Hatched areas are left out.

In the SVG every stone is defined once, as it lay, and placed by its pose.  There y runs down from
the top of the wall, and a turn by a positive angle is a negative one.  In the DXF outlines are
closed polylines with name, step and angle as extended data of the application DRYSTONE.
"""

from dataclasses import dataclass, replace
from importlib import import_module
from io import StringIO
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from drystone.drawing.assembly import Assembly
from drystone.drawing.canvas import draw, figure_bytes, pdf_bytes
from drystone.drawing.drawing import (
    Dots,
    Drawable,
    Drawing,
    Lines,
    Surface,
    Words,
    arrow_head,
    drawing_of_assembly,
    letters_pt,
    placed,
)
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.lettering import one_line
from drystone.drawing.outlines import Loop
from drystone.drawing.photo import read_photo
from drystone.drawing.pictures.forces import JOINT, LONGEST_SHARE, RESULTANT, resultants
from drystone.drawing.pictures.mechanism import motion_of
from drystone.drawing.sheet.pages import BuildSheet
from drystone.kernels.polygons import turn
from drystone.model.plan import Point
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


LAYERS = (
    "SITE", "STONES", "WEDGES", "CONTACTS", "FORCES-LEFT", "MECHANISM-LEFT", "FORCES-RIGHT",
    "MECHANISM-RIGHT", "NUMBERS",
)  # fmt: skip
"""From the lowest."""

MARGIN = 0.05  # around the wall, over its width; some stones reach beyond its ends
PER_PT = 0.002  # width of a line of 1 pt over the width of the wall
LARGEST_LETTER = 0.025  # over the width of the wall


def svg(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return wall.svg."""
    plan, metric = assembly.plan, assembly.unit == "m"
    factor, unit = (1000.0, "mm") if metric else (1.0, "px")
    width, height = (side * factor for side in assembly.size)
    margin = round(MARGIN * width, 3)
    wide, high = width + 2 * margin, height + 2 * margin
    root = ET.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "xmlns:inkscape": "http://www.inkscape.org/namespaces/inkscape",
            "version": "1.1",
            "width": f"{_text(wide)}{unit}",
            "height": f"{_text(high)}{unit}",
            "viewBox": f"{_text(-margin)} {_text(-margin)} {_text(wide)} {_text(high)}",
        },
    )
    ET.SubElement(root, "title").text = one_line(_name(assembly, settings))
    scale = "1 unit = 1 mm" if metric else "1 unit = 1 px of the source; no scale"
    ET.SubElement(root, "desc").text = (
        f"{scale}. Wall frame: x from the left end, y from the ground; here y runs down from the "
        f"top, {height:g} units above the ground. drystone {plan.version}, seed {plan.seed}."
    )
    drawing = with_statics(assembly)
    drawing = replace(drawing, items=tuple(placed(drawing.items, factor)))
    sheet = _Sheet(width, height, ET.SubElement(root, "defs"))
    for layer in LAYERS:
        group = {"id": layer, "inkscape:groupmode": "layer", "inkscape:label": layer}
        if layer in drawing.hidden:
            group["display"] = "none"
        items = drawing.layers(layer)
        if items:
            element = ET.SubElement(root, "g", group)
            if layer in drawing.notes:
                ET.SubElement(element, "title").text = drawing.notes[layer]
            for item in items:
                sheet.add(element, item)
    ET.indent(root, " ")
    return {"wall.svg": b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root) + b"\n"}


@dataclass(frozen=True, eq=False)
class _Sheet:
    """The size of a wall, and where its stones are defined."""

    width: float
    height: float
    defs: ET.Element

    def add(self, layer: ET.Element, item: Drawable) -> None:
        if isinstance(item, Surface) and not item.hatch:
            self._area(layer, item)
        elif isinstance(item, Lines):
            width = float(np.max(item.width_pt))
            style = {"fill": "none", **self._stroke(item.colour, width)}
            for line in item.lines:
                ET.SubElement(layer, "path", {"d": self._way(line), **style})
                if item.head:
                    head = arrow_head(line, 6.0 * PER_PT * width * self.width)
                    ET.SubElement(layer, "path", {"d": self._way(head) + "Z", "fill": item.colour})
        elif isinstance(item, Dots):
            radius = _text(0.5 * item.size_pt * PER_PT * self.width)
            for x, y in item.points.tolist():
                spot = {"cx": _text(x), "cy": _text(self.height - y), "r": radius}
                ET.SubElement(layer, "circle", {**spot, "fill": item.colour})
        elif isinstance(item, Words) and not item.beside:
            size = min(letters_pt(item.text, *item.room, 0.5), LARGEST_LETTER * self.width)
            place = {"x": _text(item.at[0]), "y": _text(self.height - item.at[1]),
                     "font-size": _text(size), "font-family": "sans-serif",
                     "text-anchor": "middle", "dominant-baseline": "central"}  # fmt: skip
            ET.SubElement(layer, "text", place).text = item.text

    def _area(self, layer: ET.Element, area: Surface) -> None:
        style = {"fill": area.fill, **self._stroke(area.line, area.width_pt)}
        if area.dashes:
            gaps = (dash * area.width_pt * PER_PT * self.width for dash in area.dashes)
            style["stroke-dasharray"] = " ".join(map(_text, gaps))
        if area.step is not None:
            style["data-step"] = str(area.step)
        if area.pose is None:
            # A mechanism moves parts that are drawn at their places, too.
            side = area.layer.partition("-")[2].lower()
            name = f"{area.name}-{side}" if side else area.name
            shape = {"id": name, "d": "".join(self._way(one) + "Z" for one in area.loops)}
            element = ET.SubElement(layer, "path", {**shape, **style})
        else:
            x, y, angle = area.pose
            own = (turn(loop - np.array([x, y]), -angle) * (1, -1) for loop in area.loops)
            lying = "".join(_path(loop) + "Z" for loop in own)
            ET.SubElement(self.defs, "path", {"id": area.name, "d": lying})
            place = f"translate({_text(x)} {_text(self.height - y)}) rotate({-angle:.10f})"
            named = {"href": f"#{area.name}", "id": f"placed-{area.name}", "transform": place}
            element = ET.SubElement(layer, "use", {**named, **style})
        if area.note:
            ET.SubElement(element, "title").text = area.note

    def _stroke(self, colour: str, width_pt: float) -> dict[str, str]:
        return {"stroke": colour, "stroke-width": _text(width_pt * PER_PT * self.width)}

    def _way(self, points: Loop) -> str:
        return _path(points * (1, -1) + (0.0, self.height))


def _path(points: Loop) -> str:
    return "M" + "L".join(f"{_text(x)} {_text(y)}" for x, y in points.tolist())


def _text(value: float) -> str:
    """Write a length, exact to 1e-7 of its unit, without zeros at the end."""
    text = f"{value:.7f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


APPLICATION = "DRYSTONE"

_METRES, _NO_UNIT = 6, 0  # of the header variable $INSUNITS
_RED, _CYAN, _BLUE, _MAGENTA, _ORANGE, _GREY, _INK = 1, 4, 5, 6, 30, 8, 7
_LAYERS = {
    "SITE": _GREY, "STONES": _INK, "WEDGES": _RED, "NUMBERS": _INK, "CONTACTS": _BLUE,
    "FORCES": _MAGENTA, "FORCES-LEFT": _MAGENTA, "FORCES-RIGHT": _MAGENTA,
    "MECHANISM": _ORANGE, "MECHANISM-LEFT": _ORANGE, "MECHANISM-RIGHT": _CYAN,
}  # fmt: skip
"""Names and colours (AutoCAD's index)."""


def dxf(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return wall.dxf; equal walls give equal bytes.  E185 when ezdxf is not installed."""
    ezdxf = load_extra("ezdxf", "cad", "E185", "wall.dxf")
    plan, metric = assembly.plan, assembly.unit == "m"
    unit = "Unit: 1 metre" if metric else "Not to scale: the unit is 1 px of the source image"
    about = (
        one_line(_name(assembly, settings)),
        f"{unit}. x from the left end, y from the ground.",
        f"drystone {plan.version}, seed {plan.seed}. Numbers are steps of construction.",
    )
    drawing, (width, height) = with_statics(assembly), assembly.size
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no dates, no ids by chance
    try:
        doc = ezdxf.new("R2010")
        doc.header["$INSUNITS"] = _METRES if metric else _NO_UNIT
        doc.header["$MEASUREMENT"] = 1
        doc.appids.add(APPLICATION)
        shown = {item.layer for item in drawing.items} - {*drawing.hidden}
        for name, colour in _LAYERS.items():
            layer = doc.layers.add(name, color=colour)
            if name not in shown:
                layer.off()
        space = doc.modelspace()
        letter = 0.03 * max(height, 0.2 * width)
        for item in drawing.items:
            _add(space, item, letter)
        for row, line in enumerate(about):
            _write(space, line, (0.0, -(6.0 + 1.8 * row) * letter), letter, "SITE")
        # Above the wall, each layer at a height of its own: several may be shown.
        for row, (name, note) in enumerate(drawing.notes.items()):
            _write(space, note, (0.0, height + (6.0 + 1.8 * row) * letter), letter, name)
        doc.set_modelspace_vport(1.4 * max(height, 0.6 * width), (width / 2.0, height / 2.0))
        # ezdxf adds these in an order that changes from process to process.
        doc.classes.add_required_classes(doc.dxfversion)
        doc.classes.classes = dict(sorted(doc.classes.classes.items()))
        with StringIO() as text:
            doc.write(text)
            return {"wall.dxf": text.getvalue().encode(doc.output_encoding)}
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _add(space: Any, item: Drawable, letter: float) -> None:
    style = {"layer": item.layer}
    if isinstance(item, Surface):
        for loop in () if item.hatch else item.loops:
            drawn = space.add_lwpolyline(loop.tolist(), close=True, dxfattribs=style)
            _tell(drawn, item.name, item.step, item.pose[2] if item.pose else 0.0)
    elif isinstance(item, Lines):
        for number, line in enumerate(item.lines):
            drawn = _line(space, item, line, letter)
            _tell(drawn, item.notes[number] if item.notes else item.name)
    elif isinstance(item, Dots):
        for point in item.points.tolist():
            _tell(space.add_point(point, dxfattribs=style), item.name)
    else:
        size = min(0.35 * min(item.room), 2.0 * letter)
        middle = import_module("ezdxf.enums").TextEntityAlignment.MIDDLE_CENTER
        space.add_text(item.text, height=size, dxfattribs=style).set_placement(
            item.at, align=middle
        )


def _line(space: Any, item: Lines, line: Loop, letter: float) -> Any:
    style = {"layer": item.layer}
    if item.head:
        _, side, tip, other = arrow_head(line, letter)
        # One open polyline there and back: widths and blocks are read in many ways, lines in one.
        line = np.array([line[0], tip, side, tip, other])
    elif len(line) == 2:
        return space.add_line(line[0].tolist(), line[1].tolist(), dxfattribs=style)
    return space.add_lwpolyline(line.tolist(), dxfattribs=style)


def _write(space: Any, text: str, at: Point, height: float, layer: str) -> None:
    space.add_text(text, height=height, dxfattribs={"layer": layer}).set_placement(at)


def _tell(entity: Any, name: str, step: int | None = None, angle_deg: float = 0.0) -> None:
    """Keep what a line is as extended data: a string, and of a part its step and angle."""
    data: list[tuple[int, Any]] = [(1000, name)]
    if step is not None:
        data += [(1071, step), (1040, angle_deg)]
    entity.set_xdata(APPLICATION, data)


def _name(assembly: Assembly, settings: ExportSettings) -> str:
    return settings.title or str(assembly.plan.source.get("path") or "dry-stone wall")
