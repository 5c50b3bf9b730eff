"""wall.svg: every stone is defined once, as it lies in the source image, and placed by its pose.

One unit is a millimetre, or a px of the source image when there is no scale.  In the file y runs
down from the top of the wall; a turn by a positive angle of the plan is a negative one here.
"""

from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.overlays import DIRECTIONS, Arrow, failed_outlines, says, thrust
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.lettering import one_line
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PLAIN_COLOUR, WEDGE_COLOUR
from drystone.kernels.polygons import Points
from drystone.model.plan import StoneStep
from drystone.statics.model import Direction
from drystone.whole_files import write_whole

NAME = "wall.svg"

_INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
MARGIN = 0.05
"""Around the wall, over its width; some stones reach beyond its ends."""

CONTACT_COLOUR, FORCE_COLOUR, MOVED_COLOUR = "#0072b2", "#8b0000", "#d55e00"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written."""
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write the drawing; contacts, forces and mechanisms are layers that are not shown at first."""
    sheet = _Sheet(assembly, settings.title)
    path = folder / NAME
    write_whole(path, sheet.bytes())
    return (path,)


class _Sheet:
    """The drawing while it grows."""

    def __init__(self, assembly: Assembly, title: str) -> None:
        self.assembly = assembly
        self.unit = "mm" if assembly.unit == "m" else "px"
        self.factor = 1000.0 if assembly.unit == "m" else 1.0
        self.width, self.height = (side * self.factor for side in assembly.size)
        margin = round(MARGIN * self.width, 3)
        wide, high = self.width + 2 * margin, self.height + 2 * margin
        self.line = 0.0012 * self.width
        self.root = ET.Element(
            "svg",
            {
                "xmlns": "http://www.w3.org/2000/svg",
                "xmlns:inkscape": _INKSCAPE,
                "version": "1.1",
                "width": f"{_text(wide)}{self.unit}",
                "height": f"{_text(high)}{self.unit}",
                "viewBox": f"{_text(-margin)} {_text(-margin)} {_text(wide)} {_text(high)}",
            },
        )
        name = title or str(assembly.plan.source.get("path") or "dry-stone wall")
        ET.SubElement(self.root, "title").text = one_line(name)
        ET.SubElement(self.root, "desc").text = self._description()
        self._define()
        self._site(margin)
        self._stones()
        self._wedges()
        self._contacts()
        for direction in DIRECTIONS:
            self._forces(direction)
            self._mechanism(direction)
        self._numbers()

    def bytes(self) -> bytes:
        """Return the file."""
        ET.indent(self.root, " ")
        return b'<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(self.root) + b"\n"

    def _description(self) -> str:
        scale = "1 unit = 1 mm" if self.unit == "mm" else "1 unit = 1 px of the source; no scale"
        return (
            f"{scale}. Wall frame: x from the left end, y from the ground; here y runs down from "
            f"the top, {_text(self.height)} units above the ground. drystone "
            f"{self.assembly.plan.version}, seed {self.assembly.plan.seed}."
        )

    def _define(self) -> None:
        defs = ET.SubElement(self.root, "defs")
        for part in self.assembly.stones:
            ET.SubElement(
                defs, "path",
                {"id": part.name, "d": self._path(part.own_corners * self.factor * (1, -1))},
            )  # fmt: skip

    def _layer(self, name: str, *, shown: bool = True, **style: str) -> ET.Element:
        attributes = {"id": name, "inkscape:groupmode": "layer", "inkscape:label": name}
        if not shown:
            attributes["display"] = "none"
        named = {key.replace("_", "-"): value for key, value in style.items()}
        return ET.SubElement(self.root, "g", attributes | named)

    def _site(self, margin: float) -> None:
        layer = self._layer("SITE", fill="none", stroke=GREY, stroke_width=_text(self.line))
        ET.SubElement(
            layer, "rect",
            {"id": "wall", "x": "0", "y": "0", "width": _text(self.width),
             "height": _text(self.height), "stroke-dasharray": f"{_text(6 * self.line)}"},
        )  # fmt: skip
        ET.SubElement(
            layer, "line",
            {"id": "ground", "x1": _text(-margin), "x2": _text(self.width + margin),
             "y1": _text(self.height), "y2": _text(self.height), "stroke": OUTLINE_COLOUR,
             "stroke-width": _text(2 * self.line)},
        )  # fmt: skip

    def _stones(self) -> None:
        layer = self._layer(
            "STONES", fill=PLAIN_COLOUR, stroke=OUTLINE_COLOUR, stroke_width=_text(self.line)
        )
        for part in self.assembly.stones:
            x, y = self._place(part.centroid)
            place = {
                "href": f"#{part.name}",
                "id": f"placed-{part.name}",
                "transform": f"translate({_text(x)} {_text(y)}) rotate({-part.angle_deg:.10f})",
                "data-step": str(part.step),
            }
            use = ET.SubElement(layer, "use", place)
            ET.SubElement(use, "title").text = _said(part)

    def _wedges(self) -> None:
        layer = self._layer(
            "WEDGES", fill=WEDGE_COLOUR, stroke=OUTLINE_COLOUR, stroke_width=_text(self.line / 2)
        )
        for part in self.assembly.wedges:
            outline = {"d": self._wall_path(part.corners)}
            named = {"id": part.name, "data-step": str(part.step)}
            wedge = ET.SubElement(layer, "path", named | outline)
            ET.SubElement(wedge, "title").text = _said(part)

    def _contacts(self) -> None:
        layer = self._layer(
            "CONTACTS", shown=False, stroke=CONTACT_COLOUR, fill=CONTACT_COLOUR,
            stroke_width=_text(1.5 * self.line),
        )  # fmt: skip
        for interface in self.assembly.model.interfaces:
            (x1, y1), (x2, y2) = (self._place(interface.points[end].tolist()) for end in (0, -1))
            if len(interface.points) > 1:
                ends = {"x1": _text(x1), "y1": _text(y1), "x2": _text(x2), "y2": _text(y2)}
                ET.SubElement(layer, "line", ends)
            else:
                spot = {"cx": _text(x1), "cy": _text(y1), "r": _text(1.5 * self.line)}
                ET.SubElement(layer, "circle", spot)

    def _forces(self, direction: Direction) -> None:
        found = thrust(self.assembly, direction)
        if found is None:
            return
        layer = self._layer(
            f"FORCES-{direction.upper()}", shown=False, stroke=FORCE_COLOUR, fill=FORCE_COLOUR,
            stroke_width=_text(self.line),
        )  # fmt: skip
        length = _text(found.length_per_weight * self.factor)
        told = says(self.assembly, direction)
        scale = f"an arrow of {length} {self.unit} is the mean weight of a part"
        ET.SubElement(layer, "title").text = f"Forces {told}; {scale}"
        for arrow in found.arrows:
            ET.SubElement(layer, "path", {"d": self._arrow(arrow)})

    def _arrow(self, arrow: Arrow) -> str:
        tail, tip = np.array(self._place(arrow.tail)), np.array(self._place(arrow.tip))
        along = (tip - tail) / np.hypot(*(tip - tail))
        head = min(6 * self.line, 0.5 * float(np.hypot(*(tip - tail))))
        neck, side = tip - head * along, 0.35 * head * np.array([-along[1], along[0]])
        corners = [tail, neck, neck + side, tip, neck - side, neck]
        return "M" + "L".join(f"{_text(x)} {_text(y)}" for x, y in corners)

    def _mechanism(self, direction: Direction) -> None:
        moved = failed_outlines(self.assembly, direction)
        if moved is None:
            return
        layer = self._layer(
            f"MECHANISM-{direction.upper()}", shown=False, fill="none", stroke=MOVED_COLOUR,
            stroke_width=_text(self.line),
        )  # fmt: skip
        told = says(self.assembly, direction)
        ET.SubElement(layer, "title").text = f"How the wall fails {told}; motion enlarged"
        for part_id, corners in moved.items():
            name = f"{self.assembly.part(part_id).name}-{direction}"
            ET.SubElement(layer, "path", {"id": name, "d": self._wall_path(corners)})

    def _numbers(self) -> None:
        layer = self._layer(
            "NUMBERS", fill="#000000", font_family="sans-serif", text_anchor="middle",
            dominant_baseline="central",
        )  # fmt: skip
        for part in self.assembly.stones:
            x, y = self._place(part.centroid)
            width, height = np.ptp(part.corners, axis=0) * self.factor
            size = 0.5 * min(height, width / (0.62 * len(str(part.step))))
            size = min(float(size), 0.025 * self.width)
            place = {"x": _text(x), "y": _text(y), "font-size": _text(size)}
            ET.SubElement(layer, "text", place).text = str(part.step)

    def _place(self, point: tuple[float, float]) -> tuple[float, float]:
        return point[0] * self.factor, self.height - point[1] * self.factor

    def _wall_path(self, corners: Points) -> str:
        return self._path(corners * self.factor * (1, -1) + (0.0, self.height))

    @staticmethod
    def _path(corners: Points) -> str:
        return "M" + "L".join(f"{_text(x)} {_text(y)}" for x, y in corners.tolist()) + "Z"


def _said(part: Part) -> str:
    step = part.plan_step
    if isinstance(step, StoneStep):
        return f"step {part.step}: stone {part.id}, turned {part.angle_deg:.1f}\N{DEGREE SIGN}"
    return f"step {part.step}: wedge {part.id} under stone {step.under}"


def _text(value: float) -> str:
    """Write a length, exact to 1e-7 of its unit, without zeros at the end."""
    text = f"{value:.7f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
