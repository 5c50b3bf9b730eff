"""wall.dxf: R2010, in metres, or without a unit when there is no scale.

Layers: STONES and WEDGES (closed polylines with the name, step and angle as extended data of the
application DRYSTONE), CONTACTS, FORCES-LEFT and -RIGHT, MECHANISM-LEFT and -RIGHT, NUMBERS, and
SITE with the wall's frame, the ground and what the drawing says of itself.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.overlays import DIRECTIONS, failed_outlines, says, thrust
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.lettering import one_line
from drystone.errors import UsageError
from drystone.kernels.polygons import Points
from drystone.statics.model import Direction
from drystone.whole_files import write_whole

NAME = "wall.dxf"
APPLICATION = "DRYSTONE"

_METRES, _NO_UNIT = 6, 0
"""Of the header variable $INSUNITS."""

_RED, _CYAN, _BLUE, _MAGENTA, _ORANGE, _GREY, _INK = 1, 4, 5, 6, 30, 8, 7
_LAYERS = {
    "SITE": _GREY, "STONES": _INK, "WEDGES": _RED, "NUMBERS": _INK, "CONTACTS": _BLUE,
    "FORCES": _MAGENTA, "FORCES-LEFT": _MAGENTA, "FORCES-RIGHT": _MAGENTA,
    "MECHANISM": _ORANGE, "MECHANISM-LEFT": _ORANGE, "MECHANISM-RIGHT": _CYAN,
}  # fmt: skip
"""Names and colours (AutoCAD's index)."""

_SHOWN = {"SITE", "STONES", "WEDGES", "NUMBERS"}


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E185 when ezdxf is not installed."""
    _load_ezdxf()
    return (NAME,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write the drawing.

    Raises
    ------
    UsageError
        E185 when ezdxf is not installed.
    """
    ezdxf = _load_ezdxf()
    with _undated(ezdxf):
        doc = ezdxf.new("R2010")
        doc.header["$INSUNITS"] = _METRES if assembly.unit == "m" else _NO_UNIT
        doc.header["$MEASUREMENT"] = 1
        doc.appids.add(APPLICATION)
        for name, colour in _LAYERS.items():
            layer = doc.layers.add(name, color=colour)
            if name not in _SHOWN:
                layer.off()
        space = doc.modelspace()
        _draw_site(space, assembly, settings.title)
        for part in assembly.parts:
            _draw_part(space, part, 2.0 * _letter(assembly))
        _draw_contacts(space, assembly)
        for direction in DIRECTIONS:
            _draw_forces(space, assembly, direction)
            _draw_mechanism(space, assembly, direction)
        _zoom(doc, assembly)
        with StringIO() as text:
            doc.write(text)
            data = text.getvalue().encode(doc.output_encoding)
    path = folder / NAME
    write_whole(path, data)
    return (path,)


def _load_ezdxf() -> Any:
    try:
        return import_module("ezdxf")
    except ImportError as error:
        raise UsageError(
            "E185",
            "ezdxf is not installed, and it writes the drawing.",
            where=NAME,
            cure="Install it with `pip install drystone[cad]`.",
        ) from error


@contextmanager
def _undated(ezdxf: Any) -> Iterator[None]:
    """Let drawings have a fixed date and fixed GUIDs, so that equal walls give equal bytes."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _letter(assembly: Assembly) -> float:
    """Return the height of small letters, unit of the drawing."""
    width, height = assembly.size
    return 0.03 * max(height, 0.2 * width)


def _draw_site(space: Any, assembly: Assembly, title: str) -> None:
    width, height = assembly.size
    style = {"layer": "SITE"}
    frame = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    _tell(space.add_lwpolyline(frame, close=True, dxfattribs=style), "wall")
    reach = 0.05 * width
    _tell(space.add_line((-reach, 0.0), (width + reach, 0.0), dxfattribs=style), "ground")
    letter, plan = _letter(assembly), assembly.plan
    unit = (
        "Unit: 1 metre" if assembly.unit == "m"
        else "Not to scale: the unit is 1 px of the source image"
    )  # fmt: skip
    lines = [
        one_line(title or str(plan.source.get("path") or "dry-stone wall")),
        f"{unit}. x from the left end, y from the ground.",
        f"drystone {plan.version}, seed {plan.seed}. Numbers are steps of construction.",
    ]
    for row, line in enumerate(lines):
        _write(space, line, (0.0, -(6.0 + 1.8 * row) * letter), letter, "SITE")


def _draw_part(space: Any, part: Part, letter: float) -> None:
    layer = "STONES" if part.kind == "stone" else "WEDGES"
    outline = space.add_lwpolyline(part.corners.tolist(), close=True, dxfattribs={"layer": layer})
    _tell(outline, part.name, part.step, part.angle_deg)
    size = min(0.35 * float(np.ptp(part.corners, axis=0).min()), letter)
    text = space.add_text(str(part.step), height=size, dxfattribs={"layer": "NUMBERS"})
    text.set_placement(part.centroid, align=_middle())


def _draw_contacts(space: Any, assembly: Assembly) -> None:
    style = {"layer": "CONTACTS"}
    names = {0: "ground"} | {part.id: part.name for part in assembly.parts}
    for interface in assembly.model.interfaces:
        ends = [tuple(point) for point in interface.points.tolist()]
        drawn = (
            space.add_line(ends[0], ends[-1], dxfattribs=style) if len(ends) > 1
            else space.add_point(ends[0], dxfattribs=style)
        )  # fmt: skip
        _tell(drawn, f"{names[interface.block]} on {names[interface.other]}")


def _draw_forces(space: Any, assembly: Assembly, direction: Direction) -> None:
    found = thrust(assembly, direction)
    if found is None:
        return
    layer, letter = f"FORCES-{direction.upper()}", _letter(assembly)
    for arrow in found.arrows:
        tail, tip = np.array(arrow.tail), np.array(arrow.tip)
        head = min(letter, 0.5 * float(np.hypot(*(tip - tail))))
        along = (tip - tail) / np.hypot(*(tip - tail))
        neck, side = tip - head * along, 0.3 * head * np.array([-along[1], along[0]])
        # One open polyline there and back: widths and blocks are read in many ways, lines in one.
        points = np.array([tail, tip, neck + side, tip, neck - side])
        drawn = space.add_lwpolyline(points.tolist(), dxfattribs={"layer": layer})
        _tell(drawn, f"{arrow.weights:.6g} mean weights")
    unit = "m" if assembly.unit == "m" else "px"
    scale = f"a line of {found.length_per_weight:.4g} {unit} is the mean weight of a part"
    _note(space, assembly, f"Forces {says(assembly, direction)}; {scale}", layer)


def _draw_mechanism(space: Any, assembly: Assembly, direction: Direction) -> None:
    moved = failed_outlines(assembly, direction)
    if moved is None:
        return
    layer = f"MECHANISM-{direction.upper()}"
    for part_id, corners in moved.items():
        outline = _outline(space, corners, layer)
        _tell(outline, assembly.part(part_id).name)
    _note(space, assembly, f"Fails {says(assembly, direction)}; motion enlarged", layer)


def _outline(space: Any, corners: Points, layer: str) -> Any:
    return space.add_lwpolyline(corners.tolist(), close=True, dxfattribs={"layer": layer})


def _note(space: Any, assembly: Assembly, text: str, layer: str) -> None:
    """Write above the wall, each layer at a height of its own: several may be shown."""
    letter = _letter(assembly)
    row = ("FORCES-LEFT", "FORCES-RIGHT", "MECHANISM-LEFT", "MECHANISM-RIGHT").index(layer)
    place = (0.0, assembly.size[1] + (6.0 + 1.8 * row) * letter)
    _write(space, text, place, letter, layer)


def _write(space: Any, text: str, at: tuple[float, float], height: float, layer: str) -> None:
    space.add_text(text, height=height, dxfattribs={"layer": layer}).set_placement(at)


def _tell(entity: Any, name: str, step: int | None = None, angle_deg: float = 0.0) -> None:
    """Keep what a line is as extended data: a string, and of a part its step and angle."""
    data: list[tuple[int, Any]] = [(1000, name)]
    if step is not None:
        data += [(1071, step), (1040, angle_deg)]
    entity.set_xdata(APPLICATION, data)


def _zoom(doc: Any, assembly: Assembly) -> None:
    width, height = assembly.size
    doc.set_modelspace_vport(1.4 * max(height, 0.6 * width), (width / 2.0, height / 2.0))


def _middle() -> Any:
    return import_module("ezdxf.enums").TextEntityAlignment.MIDDLE_CENTER
