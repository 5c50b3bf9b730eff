"""DXF: closed polylines, circles, ellipses and splines, in the unit of the drawing."""

import io
from collections import Counter
from importlib import import_module
from typing import Any

import numpy as np
from scipy.interpolate import BSpline

from drystone.errors import InputError, Notice, UsageError
from drystone.io.foreign import foreign
from drystone.io.outlines_in.dxf_blocks import Drawn, drawn_entities
from drystone.io.outlines_in.model import (
    METRES,
    Area,
    OutlinedStone,
    OutlineFile,
    damaged,
    left_aside,
    number_in,
    ring,
)
from drystone.io.outlines_in.silhouettes import with_holes
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

BINARY = b"AutoCAD Binary DXF"
_OUTLINES = frozenset({"LWPOLYLINE", "POLYLINE", "CIRCLE", "ELLIPSE", "SPLINE"})
_LAYER, _APPLICATION = "STONES", "DRYSTONE"
"""Of what drystone writes: the layer of stones, and whose extended data name them."""
_CHORDS = 32
"""Of a spline between two knots."""
_CLOSED = 1e-6
"""How far the ends of a closed spline may be apart, as a share of its size."""
_FLATNESS = 2e-4
"""How far chords may stay away from a curve, as a share of the size of the outline."""
_MOST_CORNERS = 10_000_000
_MOST_DEGREE = 32


def is_dxf(data: bytes, suffix: str) -> bool:
    """Tell DXF by its beginning or its ending."""
    if data.startswith(BINARY):
        return True
    lines = [line.strip() for line in data[:4096].lstrip(b"\xef\xbb\xbf").split(b"\n")[:200]]
    return suffix == ".dxf" or (b"SECTION" in lines and lines[0] in {b"0", b"999"})


def read_dxf(data: bytes, where: str, settings: ReadSettings) -> OutlineFile:
    """Read the closed outlines of the model space, also within block references.

    Where there is a layer of the name STONES, only its outlines are stones.  An outline in
    another one is its hole.  What is hidden, or on a layer that is off or frozen, does not count.
    """
    ezdxf = load_ezdxf()
    document = _document(ezdxf, data, where)
    unit_m = _unit(ezdxf, document, where, settings)
    aside: Counter[str] = Counter()
    shown = drawn_entities(document, where, aside)
    named = [drawn for drawn in shown if drawn.layer.upper() == _LAYER]
    if named:
        aside["entities outside the layer STONES"] = len(shown) - len(named)
    rings, names = [], []
    room = _MOST_CORNERS
    for drawn in named or shown:
        corners = _outline(drawn, where, aside)
        if corners is None:
            continue
        room -= len(corners)
        if room < 0:
            raise InputError(
                "E110", f"the drawing has more than {_MOST_CORNERS} corners, those on curves.",
                where=where, cure="Export the outlines of stones only, with fewer corners.",
            )  # fmt: skip
        rings.append(corners)
        with foreign(lambda why: damaged(where, f"the name of an outline cannot be used ({why})")):
            names.append(_name(drawn))
    with foreign(lambda why: damaged(where, f"its outlines cannot be put in order ({why})")):
        found = with_holes(rings)
    return _file(found, rings, names, unit_m, +aside)


def load_ezdxf() -> Any:
    """Return ezdxf; it is an extra, so it is loaded only when it is needed (E305)."""
    try:
        return import_module("ezdxf")
    except ImportError as error:
        raise UsageError(
            "E305", "ezdxf is not installed, and it reads DXF.", where="dxf",
            cure="Install it with `pip install drystone[cad]`.",
        ) from error  # fmt: skip


def _document(ezdxf: Any, data: bytes, where: str) -> Any:
    def cut(why: str) -> InputError:
        return InputError(
            "E106", f"the drawing is damaged or cut short ({why}).", where=where,
            cure="Copy or export it again.",
        )  # fmt: skip

    with foreign(cut):
        if data.startswith(BINARY):
            tagger = import_module("ezdxf.lldxf.tagger")
            drawing = import_module("ezdxf.document").Drawing
            return drawing.load(tagger.binary_tags_loader(data, errors="surrogateescape"))
        return ezdxf.read(io.StringIO(_text(data)))


def _text(data: bytes) -> str:
    """Decode a drawing: what is no UTF-8 is in the code page that it names (before R2007)."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        head = io.StringIO(data.decode("utf-8", "surrogateescape"))
        page = import_module("ezdxf.filemanagement").dxf_stream_info(head).encoding
        return data.decode(page, "surrogateescape")


def _unit(ezdxf: Any, document: Any, where: str, settings: ReadSettings) -> float | None:
    units = import_module("ezdxf.units")
    with foreign(lambda why: damaged(where, f"its unit cannot be used ({why})")):
        number = int(document.header.get("$INSUNITS", 0))
    if number in {int(known) for known in ezdxf.units.InsertUnits} - {0}:
        return float(units.conversion_factor(ezdxf.units.InsertUnits(number), units.M))
    if settings.unit:
        return METRES.get(settings.unit)
    raise InputError(
        "E116",
        f"the drawing does not say its unit ($INSUNITS is {number}), so its stones could be of "
        "any size.",
        where=where,
        cure="Say it with --unit mm (or cm, m, in, ft, px; ReadSettings.unit), or set it in the "
        "CAD program.",
    )


def _outline(drawn: Drawn, where: str, aside: Counter[str]) -> Points | None:
    """Return the corners of a closed outline; what is none is counted."""
    entity = drawn.entity
    kind, handle = entity.dxftype(), entity.dxf.get("handle", "?")
    unusable = f"the {kind} of handle {handle} cannot be used"
    with foreign(lambda why: damaged(where, f"{unusable} ({why})")):
        if kind not in _OUTLINES or (kind == "POLYLINE" and not _is_line(entity)):
            aside[kind] += 1
            return None
        if kind == "SPLINE" and len(entity.control_points):
            control = [v.xyz for v in drawn.matrix.transform_vertices(entity.control_points)]
            corners = spline(control, entity.knots, entity.weights, entity.dxf.degree)
            if np.abs(corners[0] - corners[-1]).max() > _CLOSED * np.ptp(corners, axis=0).max():
                aside["open SPLINE"] += 1
                return None
            return ring(corners[:-1])
        path = import_module("ezdxf.path").make_path(entity)
        if not len(path) or not path.is_closed:
            aside[f"open {kind}"] += 1
            return None
        # Curves stay curves also where a block is stretched, or mirrored.
        path = path.transform(drawn.matrix)
        # Few corners are enough to see how large it is.
        rough = ring([(v.x, v.y) for v in path.control_vertices()])
        size = float(np.ptp(rough, axis=0).max())
        chords = path.flattening(max(size * _FLATNESS, 1e-12), segments=8)
        return ring([(v.x, v.y) for v in chords])


def spline(control: Any, knots: Any, weights: Any, degree: int) -> Points:
    """Return points on a B-spline, its ends included."""
    if degree > _MOST_DEGREE:
        raise ValueError(f"its degree is {degree}; the limit is {_MOST_DEGREE}")
    points = np.asarray(control, dtype=float)[:, :2]
    heavy = np.asarray(weights, dtype=float) if len(weights) else np.ones(len(points))
    t = np.asarray(knots, dtype=float)
    curve = BSpline(t, np.column_stack([points * heavy[:, None], heavy]), degree)
    spans = np.unique(t[degree : len(points) + 1])
    inner = np.arange(_CHORDS) / _CHORDS
    at = (spans[:-1, None] + inner * np.diff(spans)[:, None]).ravel()
    found = curve(np.append(at, spans[-1]))
    return np.asarray(found[:, :2] / found[:, 2:])


def _is_line(entity: Any) -> bool:
    return bool(entity.is_2d_polyline or entity.is_3d_polyline)


def _name(drawn: Drawn) -> str:
    """Return what drystone wrote to the outline of a stone, else the layer."""
    entity = drawn.entity
    if entity.has_xdata(_APPLICATION):
        said = [str(value) for code, value in entity.get_xdata(_APPLICATION) if code == 1000]
        return said[0] if said else ""
    return "" if drawn.layer.upper() in {"0", _LAYER} else drawn.layer


def _file(
    found: list[tuple[int, Area]],
    rings: list[Points],
    names: list[str],
    unit_m: float | None,
    aside: Counter[str],
) -> OutlineFile:
    # The one layer that all stones are on says nothing of a stone.
    shown = names if len(set(names)) > 1 or len(names) == 1 else [""] * len(names)
    stones = tuple(OutlinedStone(number_in(shown[i]), shown[i], (area,)) for i, area in found)
    cure = "Only closed outlines are read: join lines and arcs to polylines, bind references."
    notices = left_aside(aside, cure)
    if len(found) < len(rings):
        text = f"{len(rings) - len(found)} outlines lie in others and are their holes."
        cure = "If they are stones in a frame, put them on a layer STONES, or hide the frame."
        notices.append(Notice("W119", text, cure))
    return OutlineFile(stones, unit_m, y_up=True, notices=tuple(notices))
