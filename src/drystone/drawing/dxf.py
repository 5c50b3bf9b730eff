"""Drawings as DXF (R2010), by ezdxf.

Outlines are closed polylines with name, step and angle as extended data of the application
DRYSTONE.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from io import StringIO
from typing import Any

import numpy as np

from drystone.drawing.drawing import Dots, Drawable, Drawing, Lines, Surface, arrow_head
from drystone.drawing.outlines import Loop
from drystone.model.plan import Point

APPLICATION = "DRYSTONE"

_METRES, _NO_UNIT = 6, 0  # of the header variable $INSUNITS
_RED, _CYAN, _BLUE, _MAGENTA, _ORANGE, _GREY, _INK = 1, 4, 5, 6, 30, 8, 7
_LAYERS = {
    "SITE": _GREY, "STONES": _INK, "WEDGES": _RED, "NUMBERS": _INK, "CONTACTS": _BLUE,
    "FORCES": _MAGENTA, "FORCES-LEFT": _MAGENTA, "FORCES-RIGHT": _MAGENTA,
    "MECHANISM": _ORANGE, "MECHANISM-LEFT": _ORANGE, "MECHANISM-RIGHT": _CYAN,
}  # fmt: skip
"""Names and colours (AutoCAD's index)."""


def dxf_bytes(
    ezdxf: Any, drawing: Drawing, size: Point, *, metric: bool, about: Sequence[str]
) -> bytes:
    """Return a drawing as DXF; equal drawings give equal bytes.

    It is in metres, or without a unit; hatched areas are left out.  `about` is written below the
    wall.  Whoever asks has loaded ezdxf, which is an extra.
    """
    with _undated(ezdxf):
        doc = ezdxf.new("R2010")
        doc.header["$INSUNITS"] = _METRES if metric else _NO_UNIT
        doc.header["$MEASUREMENT"] = 1
        doc.appids.add(APPLICATION)
        shown = {item.layer for item in drawing.items} - {*drawing.hidden}
        for name, colour in _LAYERS.items():
            layer = doc.layers.add(name, color=colour)
            if name not in shown:
                layer.off()
        space, (width, height) = doc.modelspace(), size
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
            return text.getvalue().encode(doc.output_encoding)


@contextmanager
def _undated(ezdxf: Any) -> Iterator[None]:
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
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
        room = min(item.room) if item.room else letter
        size = min(0.35 * room, 2.0 * letter)
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
