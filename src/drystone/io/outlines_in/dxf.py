"""DXF: closed polylines, circles, ellipses and splines, in the unit of the drawing."""

import io
from codecs import BOM_UTF8
from collections import Counter
from collections.abc import Iterable, Iterator
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import BSpline, CubicSpline

from drystone.errors import InputError, Notice, extra
from drystone.io.files import damaged, foreign, listed, too_large, unusable
from drystone.io.outlines_in import model, silhouettes
from drystone.io.outlines_in.classes import layer
from drystone.io.outlines_in.model import OutlinedStone, OutlineFile
from drystone.io.outlines_in.silhouettes import Vector
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

BINARY = b"AutoCAD Binary DXF"
_FOOT_OF_SURVEY = 1200 / 3937
_INSUNITS_M = {
    1: 0.0254, 2: 0.3048, 3: 1609.344, 4: 1e-3, 5: 1e-2, 6: 1.0, 7: 1e3, 8: 0.0254e-6,
    9: 0.0254e-3, 10: 0.9144, 11: 1e-10, 12: 1e-9, 13: 1e-6, 14: 1e-1, 15: 10.0, 16: 100.0,
    17: 1e9, 18: 149597870700.0, 19: 9460730472580800.0, 20: 149597870700.0 * 648000 / np.pi,
    21: _FOOT_OF_SURVEY, 22: _FOOT_OF_SURVEY / 12, 23: _FOOT_OF_SURVEY * 3,
    24: _FOOT_OF_SURVEY * 5280,
}  # fmt: skip
"""Metres in each unit of $INSUNITS; ezdxf lacks some, and rounds others."""
_FRAME = 16
"""Flag of a vertex that shapes a spline-fit polyline, and is not drawn."""
_EDGEWISE = 0.5
"""Cosine of the angle to the plane of the drawing from which on an outline is not of it."""
_OUTLINES = frozenset({"LWPOLYLINE", "POLYLINE", "CIRCLE", "ELLIPSE", "SPLINE"})
_LAYER, _APPLICATION = "STONES", "DRYSTONE"
"""Of what drystone writes: the layer of stones, and whose extended data name them."""
_CHORDS = 32
"""Of a spline between two knots."""
_CLOSED = 1e-6
"""How far the ends of a closed spline may be apart, as a share of its size."""
_FLATNESS = 2e-4
"""How far chords may stay away from a curve, as a share of the size of the outline."""
_MOST_DEGREE = 32
_APART = "splines that say they are closed end apart ({}): a straight line joins their ends."
_WIDE = "polylines have a width ({}): the line in its middle was read."
"""How outlines were read that may be meant in another way."""


class Drawn(NamedTuple):
    """An entity where it is drawn."""

    entity: Any  # as its block defines it
    layer: str  # its own; that of the block reference for what is on layer 0 in a block
    matrix: Any  # from its block to the model space


def is_dxf(data: bytes, suffix: str) -> bool:
    """Tell DXF by its beginning or its ending."""
    if data.startswith(BINARY):
        return True
    lines = [line.strip() for line in data[:4096].removeprefix(BOM_UTF8).splitlines()[:200]]
    return suffix == ".dxf" or (b"SECTION" in lines and lines[0] in {b"0", b"999"})


def read_dxf(data: bytes, settings: ReadSettings) -> OutlineFile:
    """Read the closed outlines of the model space, also within block references.

    Where there is a layer of the name STONES, only its outlines are stones.  An outline in
    another one is its hole.  What is hidden, or on a layer that is off or frozen, does not count.
    """
    ezdxf = extra("ezdxf", "reads DXF", "dxf", "cad")
    document = _document(ezdxf, data)
    unit_m, notices = _unit(document, settings)
    aside: Counter[str] = Counter()
    with foreign(lambda why: unusable(f"a block or a dimension cannot be used ({why})")):
        start = import_module("ezdxf.math").Matrix44()
        shown = list(_Blocks(document, aside).drawn(document.modelspace(), start))
    named = [drawn for drawn in shown if drawn.layer.upper() == _LAYER]
    if named:
        aside["entities outside the layer STONES"] = len(shown) - len(named)
    papers = [layout for layout in document.layouts if not layout.is_modelspace]
    on_paper = sum(one.dxftype() in _OUTLINES for paper in papers for one in paper)
    aside["polylines and curves in paper space"] = on_paper
    outlines = []
    room = model.MOST_CORNERS
    for drawn in named or shown:
        outline = _outline(drawn, aside)
        if outline is None:
            continue
        room -= len(outline.corners)
        if room < 0:
            raise too_large(model.TOO_MANY_CORNERS, model.FEWER)
        outlines.append(outline)
    with foreign(lambda why: unusable(f"its outlines cannot be used ({why})")):
        outlines, rings, seen = _in_plane(outlines, aside, settings)
    with foreign(lambda why: unusable(f"its outlines cannot be put in order ({why})")):
        found = silhouettes.with_holes(rings)
    names = [outline.name for outline in outlines]
    # The one layer that all stones are on says nothing of a stone.
    names = names if len(set(names)) > 1 or len(names) == 1 else [""] * len(names)
    stones = [
        OutlinedStone(model.number_in(names[i]), names[i], (area,), label=layer(names[i]))
        for i, area in found
    ]
    cure = "Only closed outlines are read: join lines and arcs to polylines, bind references."
    notices += model.left_aside(+aside, cure) + seen
    for doubt in (_APART, _WIDE):
        if which := [outline.handle for outline in outlines if outline.doubt == doubt]:
            cure = "Draw them again if another line is meant."
            notices.append(Notice("W119", doubt.format(listed(which)), cure))
    if len(found) < len(rings):
        text = f"{len(rings) - len(found)} outlines lie in others and are their holes."
        cure = "If they are stones in a frame, put them on a layer STONES, or hide the frame."
        notices.append(Notice("W119", text, cure))
    return OutlineFile(stones, unit_m, y_up=True, notices=notices, in_space=True)


class _Outline(NamedTuple):
    corners: Vector  # (n, 3)
    facing: Vector | None  # (3,), away from which it was drawn; None for a line in space
    name: str
    handle: str
    doubt: str = ""  # in what other way it may be meant


def _in_plane(
    outlines: list[_Outline], aside: Counter[str], settings: ReadSettings
) -> tuple[list[_Outline], list[Points], list[Notice]]:
    """Return outlines in the plane of the drawing, their corners there, and what is to be said.

    A plan is seen from the top.  An elevation is seen from the side that its outlines face.
    """
    if not outlines:
        return [], [], []
    for outline in outlines:
        model.within_reach(outline.corners)
    normal, leaning = silhouettes.plane_of([outline.corners for outline in outlines])
    leans = [*zip(leaning.tolist(), outlines, strict=True)]
    kept = [outline for lean, outline in leans if lean >= _EDGEWISE]
    aside["outlines that are seen edgewise"] = len(outlines) - len(kept)
    normal, why = silhouettes.usual_side(normal, settings.up), "as CAD programs show it"
    facing = {float(np.sign(one.facing @ normal)) for one in kept if one.facing is not None}
    if facing == {-1.0} and normal[2] != 1.0:
        normal, why = -normal, "the side that its outlines face"
    seen = silhouettes.asked(normal, settings.up) if settings.up else silhouettes.view(normal, "z")
    rings = [model.ring(seen.of(outline.corners)) for outline in kept]
    notices = []
    if settings.up or normal[2] != 1.0:
        why = f"as --up {settings.up} says" if settings.up else why
        text = f"the drawing is seen {seen.said} ({why})."
        cure = "--up y takes another axis for up, and --up z or z-back one side or the other."
        notices.append(Notice("W119", text, cure))
    short = [(lean, outline.handle) for lean, outline in leans if _EDGEWISE <= lean < 1.0]
    if short:
        least, handle = min(short)
        most = f"most by {100 * (1 - least):.2g} % (handle {handle})"
        text = "outlines do not lie in the plane that is seen, and are shortened"
        text = f"{len(short)} {text}: {most}."
        notices.append(Notice("W119", text, "Draw them flat, in one plane."))
    return kept, rings, notices


def _document(ezdxf: Any, data: bytes) -> Any:
    with foreign(lambda why: damaged(why, what="drawing")):
        if data.startswith(BINARY):
            tagger = import_module("ezdxf.lldxf.tagger")
            drawing = import_module("ezdxf.document").Drawing
            return drawing.load(tagger.binary_tags_loader(data, errors="surrogateescape"))
        data = data.removeprefix(BOM_UTF8)
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError:  # it is in the code page that it names (before R2007)
            head = io.StringIO(data.decode("utf-8", "surrogateescape"), newline=None)
            page = import_module("ezdxf.filemanagement").dxf_stream_info(head).encoding
            text = data.decode(page, "surrogateescape")
        # Like a file that is open as text: any line end is one.
        return ezdxf.read(io.StringIO(text, newline=None))


def _unit(document: Any, settings: ReadSettings) -> tuple[float | None, list[Notice]]:
    """Return metres in the unit; that of the settings comes first."""
    with foreign(lambda why: unusable(f"its unit cannot be used ({why})")):
        number = int(document.header.get("$INSUNITS", 0))
    own = _INSUNITS_M.get(number)
    if settings.unit:
        said = model.overruled(own, f"$INSUNITS {number}, {own or 0.0:g} m", settings)
        return model.METRES.get(settings.unit), said
    if own is not None:
        return own, []
    what = f"the drawing does not say its unit ($INSUNITS is {number}), so its stones could be of "
    cure = "Say it with --unit mm (or cm, m, in, ft, px; ReadSettings.unit), or set it in the "
    raise InputError("E116", f"{what}any size.", cure=f"{cure}CAD program.")


def _outline(drawn: Drawn, aside: Counter[str]) -> _Outline | None:
    """Return a closed outline; what is none is counted."""
    entity = drawn.entity
    kind, handle = entity.dxftype(), str(entity.dxf.get("handle", "?"))
    named = f"the {kind} of handle {handle}"
    with foreign(lambda why: unusable(f"{named} cannot be used ({why})")):
        is_mesh = kind == "POLYLINE" and not (entity.is_2d_polyline or entity.is_3d_polyline)
        if kind not in _OUTLINES or is_mesh:
            aside[kind] += 1
            return None
        is_spline = kind == "SPLINE" and (len(entity.control_points) or entity.closed)
        curve = _spline_corners if is_spline else _path_corners
        corners, is_open = curve(drawn)
        if corners is None:
            aside[f"open {kind}"] += 1
            return None
        doubt = _APART if is_open else _WIDE if getattr(entity, "has_width", False) else ""
        facing = None
        if kind != "SPLINE" and not (kind == "POLYLINE" and entity.is_3d_polyline):
            front = drawn.matrix.transform_direction(entity.dxf.get("extrusion", (0, 0, 1)))
            facing = np.array(front.xyz)
    name = "" if drawn.layer.upper() in {"0", _LAYER} else drawn.layer
    with foreign(lambda why: unusable(f"the name of an outline cannot be used ({why})")):
        if entity.has_xdata(_APPLICATION):  # what drystone wrote
            said = [str(value) for code, value in entity.get_xdata(_APPLICATION) if code == 1000]
            name = said[0] if said else ""
    return _Outline(corners, facing, name, handle, doubt)


def _path_corners(drawn: Drawn) -> tuple[Vector | None, bool]:
    """Return the corners of what is no spline, if it is closed."""
    entity = drawn.entity
    if entity.dxftype() == "POLYLINE":
        entity.vertices[:] = [v for v in entity.vertices if not v.dxf.get("flags", 0) & _FRAME]
    path = import_module("ezdxf.path").make_path(entity)
    if not len(path) or not path.is_closed:
        return None, False
    # Curves stay curves also where a block is stretched, or mirrored.
    path = path.transform(drawn.matrix)
    # Few corners are enough to see how large it is.
    rough = model.within_reach(_xyz(path.control_vertices()))
    size = float(np.ptp(rough, axis=0).max())
    return _xyz(path.flattening(max(size * _FLATNESS, 1e-12), segments=8)), False


def _xyz(points: Iterable[Any]) -> Vector:
    return np.array([point.xyz for point in points]).reshape(-1, 3)


def _spline_corners(drawn: Drawn) -> tuple[Vector | None, bool]:
    """Return the corners of a spline that is or says it is closed, and if its ends are apart."""
    entity = drawn.entity
    given = entity.control_points if len(entity.control_points) else entity.fit_points
    points = _xyz(drawn.matrix.transform_vertices(given))
    if not len(entity.control_points):
        return closed_through(points), False
    degree, knots, weights = entity.dxf.degree, entity.knots, entity.weights
    corners = spline(points, knots, weights, degree)
    if not _ends_apart(corners):
        return corners[:-1], False
    if not entity.closed:
        return None, False
    if knots[0] < knots[degree]:
        # It has no ends; what makes its first points its last ones again was left out.
        points = np.concatenate([points, points[:degree]])
        weights = [*weights, *weights[:degree]]
        corners = spline(points, np.arange(len(points) + degree + 1.0), weights, degree)
    return corners, _ends_apart(corners)


def _ends_apart(corners: Vector) -> bool:
    size = np.ptp(corners, axis=0).max()
    return bool(np.abs(corners[0] - corners[-1]).max() > _CLOSED * size)


def closed_through(points: Vector) -> Vector | None:
    """Return points on the smooth closed curve through some, or None when they are too few."""
    points = points[(points != np.roll(points, 1, axis=0)).any(axis=1)]
    if len(points) < 3:
        return None
    around = np.concatenate([points, points[:1]])
    # Where it is at each point: as far as the chords are long.
    at = np.concatenate([[0.0], np.linalg.norm(np.diff(around, axis=0), axis=1).cumsum()])
    return np.asarray(CubicSpline(at, around, bc_type="periodic")(_between(at)))


def _between(at: Vector) -> Vector:
    """Return the places of chords from each to the next, without the last."""
    return (at[:-1, None] + np.arange(_CHORDS) / _CHORDS * np.diff(at)[:, None]).ravel()


def spline(control: Any, knots: Any, weights: Any, degree: int) -> Vector:
    """Return points, (n, 3), on a B-spline, its ends included.

    The curve lives between the ascending knots `degree` and n, the number of control points: of a
    periodic spline the others lie beyond its ends.  `weights` is empty for one that is not
    rational.
    """
    if degree > _MOST_DEGREE:
        raise ValueError(f"its degree is {degree}; the limit is {_MOST_DEGREE}")
    points = np.asarray(control, dtype=float)
    heavy = np.asarray(weights, dtype=float) if len(weights) else np.ones(len(points))
    t = np.asarray(knots, dtype=float)
    curve = BSpline(t, np.column_stack([points * heavy[:, None], heavy]), degree)
    spans = np.unique(t[degree : len(points) + 1])
    found = curve(np.append(_between(spans), spans[-1]))
    return np.asarray(found[:, :-1] / found[:, -1:])


class _Blocks:
    """All that the model space shows; what is hidden or missing is counted.

    A block on a frozen layer is hidden with all that is in it.  On a layer that is off, only what
    has its layer from the block reference is, as CAD programs show it.
    """

    def __init__(self, document: Any, aside: Counter[str]) -> None:
        self.document, self.aside, self.count = document, aside, 0
        self.composite = import_module("ezdxf.protocols").SupportsVirtualEntities

    def drawn(
        self, entities: Iterable[Any], matrix: Any, around: str = "0", depth: int = 0
    ) -> Iterator[Drawn]:
        """Yield entities, and the parts of those that have parts, in the order of the file."""
        for entity in entities:
            self._count(1, depth)
            own = str(_attribute(entity, "layer", "0"))
            layer = around if own == "0" else own
            if self._is_hidden(entity, layer):
                self.aside["entities that are hidden, or on hidden layers"] += 1
            elif entity.dxftype() == "INSERT":
                yield from self._inserted(entity, matrix, layer, depth + 1)
                yield from self.drawn(entity.attribs, matrix, around, depth)
            elif isinstance(entity, self.composite):
                # Dimensions are blocks too, but their parts are where they are drawn.
                parts = entity.__virtual_entities__()
                yield from self.drawn(parts, matrix, layer, depth + 1)
            else:
                yield Drawn(entity, layer, matrix)

    def _inserted(self, insert: Any, matrix: Any, layer: str, depth: int) -> Iterator[Drawn]:
        block = self.document.blocks.get(insert.dxf.get("name", ""))
        if block is None:
            self.aside["INSERT of a block that is not there"] += 1
            return
        if block.block.is_xref or block.block.is_xref_overlay:
            # What it shows is in another file; a copy of it here would be of some earlier day.
            self.aside["INSERT of an external reference"] += 1
            return
        # Definitions of attributes are not drawn, only the attributes of the block reference.
        entities = [entity for entity in block if entity.dxftype() != "ATTDEF"]
        self._count(insert.mcount, depth)
        for one in insert.multi_insert() if insert.mcount > 1 else [insert]:
            yield from self.drawn(entities, one.matrix44() @ matrix, layer, depth)

    def _count(self, number: int, depth: int) -> None:
        # One by one, also those in rows and columns, and in blocks.
        self.count += number
        if self.count > model.MOST_DRAWN or depth > model.DEEPEST:
            raise unusable("blocks are in each other too often or too deeply")

    def _is_hidden(self, entity: Any, layer: str) -> bool:
        if _attribute(entity, "invisible", 0):
            return True
        found = self.document.layers.get(layer) if layer in self.document.layers else None
        is_off = found is not None and found.is_off() and entity.dxftype() != "INSERT"
        return bool(is_off or (found is not None and found.is_frozen()))


def _attribute(entity: Any, name: str, default: Any) -> Any:
    """Return an attribute; entities that ezdxf does not know have none."""
    return entity.dxf.get(name, default) if entity.dxf.is_supported(name) else default
