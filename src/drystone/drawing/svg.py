"""Drawings as SVG: every stone is defined once, as it lay, and placed by its pose.

In the file y runs down from the top of the wall; a turn by a positive angle is a negative one.
"""

from dataclasses import dataclass
from xml.etree import ElementTree as ET

import numpy as np

from drystone.drawing.drawing import (
    Dots,
    Drawable,
    Drawing,
    Lines,
    Surface,
    Words,
    arrow_head,
    letters_pt,
)
from drystone.drawing.lettering import one_line
from drystone.drawing.outlines import Loop
from drystone.kernels.raster import turn
from drystone.model.plan import Point

LAYERS = (
    "SITE", "STONES", "WEDGES", "CONTACTS", "FORCES-LEFT", "MECHANISM-LEFT", "FORCES-RIGHT",
    "MECHANISM-RIGHT", "NUMBERS",
)  # fmt: skip
"""From the lowest."""

MARGIN = 0.05  # around the wall, over its width; some stones reach beyond its ends
PER_PT = 0.002  # width of a line of 1 pt over the width of the wall
LARGEST_LETTER = 0.025  # over the width of the wall


def svg_bytes(drawing: Drawing, size: Point, unit: str, title: str, description: str) -> bytes:
    """Return a drawing as SVG.

    It is in the unit of the file, mm or px, and on the file's layers; hatched areas are left out.
    """
    width, height = size
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
    ET.SubElement(root, "title").text = one_line(title)
    ET.SubElement(root, "desc").text = description
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
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root) + b"\n"


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
        elif isinstance(item, Words) and item.room is not None and not item.beside:
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
