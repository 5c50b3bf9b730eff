"""DXF of the known stones, written by ezdxf: curves, blocks, layers and what is hidden."""

import io
import math
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf import units, xref
from scipy.interpolate import BSpline
from shapely import affinity

from drystone.errors import InputError, UsageError
from drystone.io.outlines_in.dxf import read_dxf
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import METRIC, PIECES, PLACES, PX_PER_M, STONES, close, corners, turn
from tests.io.pictures import said


def saved(document, tmp_path, name="stones.dxf", **options):
    document.saveas(tmp_path / name, **options)
    return tmp_path / name


SURVEY = 1200 / 3937
UNITS_M = [
    0.0254, 0.3048, 1609.344, 1e-3, 1e-2, 1, 1e3, 2.54e-8, 2.54e-5, 0.9144, 1e-10, 1e-9, 1e-6,
    0.1, 10, 100, 1e9, 149597870700, 9.4607304725808e15, 3.0856775814913673e16, SURVEY,
    SURVEY / 12, 3 * SURVEY, 5280 * SURVEY,
]  # fmt: skip
"""Of the codes 1 ... 24."""


def drawn(place="top", kind="LWPOLYLINE", code=6, unit=1.0, version="R2010"):
    """Outlines as CAD draws them in a plane of its own, or as lines in space.

    Both pieces of stone 34 cannot be one in DXF: only the first.
    """
    document = ezdxf.new(version)
    document.header["$INSUNITS"] = code
    space = document.modelspace()
    to_place = np.eye(4)
    to_place[:3, :3] = turn(place).T
    for stone, polygons in STONES.items():
        for number, points in enumerate(polygons[0]):
            style = {"layer": f"stone {stone}" if number == 0 else "0"}
            if kind == "POLYLINE":
                ring = corners(points, place, unit)
                space.add_polyline3d(ring, close=True, dxfattribs=style)
                continue
            flat = corners(points, unit=unit)[:, :2]
            if stone % 2:
                line = space.add_lwpolyline(flat, close=True, dxfattribs=style)
            else:  # closed by its last point, and of the old kind
                line = space.add_polyline2d([*flat, flat[0]], dxfattribs=style)
            line.transform(ezdxf.math.Matrix44(to_place.ravel().tolist()))
    return document


@pytest.mark.parametrize("place", PLACES)
def test_dxf_in_every_plane(tmp_path, place):
    """Where nobody asks for a side, it is the one that the outlines face."""
    for kind in ("POLYLINE", "LWPOLYLINE"):
        path = saved(drawn(place, kind), tmp_path)
        stones = read_stones(path, settings=replace(METRIC, up=PLACES[place][2]))
        close(stones)
        assert "the drawing is seen along" in said(stones)
    if place in ("top", "front", "back", "right", "left", "slanting"):
        stones = read_stones(path, settings=METRIC)
        close(stones)
        told = [notice for notice in stones.notices if "is seen along" in notice.message]
        assert bool(told) == (place != "top")
        assert all("--up" in notice.cure for notice in told)


def test_dxf_outlines_out_of_the_plane_are_named(tmp_path):
    document = drawn()
    space = document.modelspace()
    edge = [(2, 0, 0), (2.1, 0, 0), (2.1, 0.03, 0.095), (2, 0.03, 0.095)]
    handle = space.add_polyline3d(edge, close=True).dxf.handle
    space.add_polyline3d([(1, 0, 0), (1.1, 0, 0), (1.1, 0.08, 0.06), (1, 0.08, 0.06)], close=True)
    stones = read_stones(saved(document, tmp_path), settings=METRIC)
    text = said(stones)
    assert "1 outlines that are seen edgewise" in text
    assert "1 outlines do not lie in the plane that is seen, and are shortened: most by 20" in text
    assert handle not in text.partition("shortened")[2]
    assert len(stones) == len(STONES) + 1
    # Plans are seen from the top, though mirrored copies face down.
    document = ezdxf.new("R2010", units=units.M)
    space = document.modelspace()
    for add in (space.add_lwpolyline, space.add_polyline2d):
        style = {"layer": add.__name__, "extrusion": (0, 0, -1)}
        add([(0, 0), (-4, 0), (-4, 3)], close=True, dxfattribs=style)
    shapes, _ = outlines(document)
    assert len(shapes) == 2
    assert all(shape.equals(shapely.Polygon([(0, 0), (4, 0), (4, 3)])) for shape in shapes.values())


def test_dxf_units(tmp_path):
    document, _ = with_blocks()
    document.modelspace().add_circle((0, 0), 1)
    for code, unit_m in enumerate(UNITS_M, start=1):
        document.header["$INSUNITS"] = code
        assert read_dxf(text_of(document), ReadSettings()).unit_m == pytest.approx(unit_m)
    with pytest.raises(InputError, match=r"E114 .*is beyond 1e9"):
        read_stones(saved(drawn(code=6, unit=1e-12), tmp_path), settings=METRIC)
    for code in (-1, 25, 999):
        with pytest.raises(InputError, match=r"E116 .*\$INSUNITS is .*--unit mm"):
            read_stones(saved(drawn(code=code), tmp_path))


def test_dxf_with_a_wrong_unit(tmp_path):
    for code, unit, metres, count in (
        (0, "mm", 1e-3, 0),
        (0, "px", 1 / PX_PER_M, 0),
        (2, "ft", 0.3048, 0),
        (6, "cm", 1e-2, 1),
        (19, "in", 0.0254, 1),
    ):
        path = saved(drawn("front", code=code, unit=metres), tmp_path)
        stones = read_stones(path, settings=replace(PIECES if unit == "px" else METRIC, unit=unit))
        close(stones)
        assert stones.source.px_per_m == (None if unit == "px" else PX_PER_M)
        assert dict(stones.source.reading)["unit"] == unit
        told = [note.message for note in stones.notices if "gives another unit" in note.message]
        assert len(told) == count
        assert all(f"$INSUNITS {code}" in text and f"--unit {unit}" in text for text in told)


def test_up_is_for_what_has_three_axes_and_a_unit_for_what_is_no_picture(tmp_path):
    (tmp_path / "s.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"><circle r="9"/></svg>')
    for source in (tmp_path / "s.svg", np.pad(np.ones((9, 9), np.uint8), 3)):
        with pytest.raises(UsageError, match=r"E118 .*no third axis .*--up"):
            read_stones(source, settings=ReadSettings(up="z-back"))
    with pytest.raises(UsageError, match=r"E118.*in px, not in mm"):
        read_stones(source, settings=ReadSettings(unit="mm"))


@pytest.mark.parametrize(
    ("version", "kind"), [("R2000", "asc"), ("R2000", "bin"), ("R2018", "asc")]
)
def test_dxf_versions_and_binary(tmp_path, version, kind):
    path = saved(drawn(version=version), tmp_path, "drawing", fmt=kind)
    stones = read_stones(path, settings=METRIC)
    close(stones)
    assert stones.source.px_per_m == PX_PER_M
    assert stones.by_id(8).name == "stone 8"
    assert "1 outlines lie in others and are their holes" in said(stones)
    # Names are in the code page of the drawing.
    document = ezdxf.new(version, units=units.MM)
    for layer, left in (("Stein ä", 0), ("Maß", 200)):
        corners = [(left, 0), (left + 100, 0), (left + 100, 60)]
        document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    data = saved(document, tmp_path, path.name, fmt=kind).read_bytes()
    begin_and_end = ((b"", b"\r"), (b"\xef\xbb\xbf", b"\r\n")) if kind == "asc" else ()
    for begin, end in ((b"", b"\n"), *begin_and_end):
        path.write_bytes(begin + data.replace(b"\n", end))
        assert [stone.name for stone in read_stones(path)] == ["Stein ä", "Maß"]


def test_dxf_curves(tmp_path):
    document = ezdxf.new("R2010", units=units.M)
    space = document.modelspace()
    # A circle, an ellipse, a spline, and half a circle as a bulge.
    space.add_circle((1, 1), 0.4)
    space.add_ellipse((3, 1), major_axis=(0.5, 0), ratio=0.4)
    corners = [(5, 0.5, 0), (6, 0.5, 0), (6, 1.5, 0), (5, 1.5, 0)]
    space.add_spline().set_closed(corners)  # periodic: its first knots are before its beginning
    space.add_lwpolyline([(7, 0.5, 0), (8, 0.5, 1), (8, 1.5, 0), (7, 1.5, 0)], "xyb", close=True)
    space.add_spline().set_open_rational(
        [(12, 0, 0), (14, 0, 0), (13, 1.7320508, 0), (12.5, 0.8660254, 0), (12, 0, 0)], [1] * 5, 1
    )
    # Not stones:
    space.add_line((0, 3), (1, 3))
    space.add_lwpolyline([(0, 3), (1, 3), (1, 4)])
    space.add_arc((2, 3), 0.3, 0, 120)
    space.add_text("stones")
    stones = read_stones(saved(document, tmp_path), settings=ReadSettings(px_per_m=400))
    areas = [stone.area_px / 400**2 for stone in stones]
    assert areas[0] == pytest.approx(math.pi * 0.4**2, rel=1e-3)
    assert areas[1] == pytest.approx(math.pi * 0.5 * 0.2, rel=2e-3)
    assert areas[2] == pytest.approx(61 / 90, rel=2e-3)  # uniform cubic around a unit square
    assert areas[3] == pytest.approx(1 + math.pi / 8, rel=1e-3)
    assert areas[4] == pytest.approx(math.sqrt(3), rel=2e-3)  # a triangle
    (notice,) = [n for n in stones.notices if "left aside" in n.message]
    for kind in ("1 ARC", "1 LINE", "1 TEXT", "1 open LWPOLYLINE"):
        assert kind in notice.message


ROUND = [(371, 1077), (371, 971), (253, 969), (182, 980), (90, 1022), (180, 1157), (335, 1147)]
"""What a curve goes through or near, mm."""


def cubic(points):
    """A closed uniform cubic near points."""
    count, around = len(points), np.array([*points, *points[:3]], float)
    spline = BSpline(np.arange(count + 7), around, 3)
    return spline(np.linspace(3, count + 3, 64 * count, endpoint=False))


def curves(tmp_path, *makers):
    document = ezdxf.new("R2010", units=units.MM)
    for make in makers:
        make(document.modelspace())
    # All lie in one place, so they look like repeats.
    settings = ReadSettings(px_per_m=1000, keep=tuple(range(1, len(makers) + 1)))
    stones = read_stones(saved(document, tmp_path), settings=settings)
    return [stone.area_px for stone in stones], said(stones)


def test_dxf_splines_that_say_they_are_closed(tmp_path):
    angles = np.arange(12) * (math.pi / 6)
    around = np.column_stack([100 * np.cos(angles), 100 * np.sin(angles)]).tolist()

    def fit(space, points=around, flags=1):
        space.add_spline(points).dxf.flags = flags

    def periodic(space):  # without the control points of its beginning at its end
        line = space.add_spline()
        line.control_points = ROUND
        line.knots = range(len(ROUND) + 4)
        line.dxf.flags = 3

    def clamped(space):
        space.add_open_spline(ROUND).dxf.flags = 1

    areas, text = curves(tmp_path, fit, lambda space: fit(space, [*around, around[0]]), periodic)
    known = [math.pi * 1e4, math.pi * 1e4, shapely.Polygon(cubic(ROUND)).area]
    assert areas == pytest.approx(known, rel=2e-3)
    assert "apart" not in text
    areas, text = curves(tmp_path, clamped)
    ends_apart = [point.xyz[:2] for point in ezdxf.math.BSpline(ROUND).approximate(500)]
    assert areas == pytest.approx([shapely.Polygon(ends_apart).area], rel=2e-3)
    assert "end apart" in text.partition("a straight line joins")[0]
    with pytest.raises(InputError, match=r"E104 .*1 open SPLINE"):
        curves(tmp_path, lambda space: fit(space, flags=0))


def test_dxf_of_wide_lines_the_middle_is_read_and_what_is_on_paper_is_counted():
    document, space = with_blocks()
    box = [(0, 0), (4, 0), (4, 3), (0, 3)]
    plain = {"close": True, "dxfattribs": {"layer": "0"}}
    lines = [
        space.add_lwpolyline(box, close=True, dxfattribs={"const_width": 2}),  # a DONUT
        space.add_lwpolyline([(*box[0], 0, 1), *box[1:]], **plain),
        space.add_polyline2d([(*point, 1, 0) for point in box], format="xyse", **plain),
    ]
    space.add_lwpolyline([(*point, 0, 0) for point in box], **plain)
    document.layout().add_lwpolyline(box, close=True)
    document.layout("Layout1").add_circle((0, 0), 1)
    document.layout("Layout1").add_text("title")
    found = read_dxf(text_of(document), ReadSettings())
    text = " ".join(notice.message for notice in found.notices)
    assert f"a width ({', '.join(line.dxf.handle for line in lines)}): the line in its" in text
    assert "2 polylines and curves in paper space" in text


@pytest.mark.parametrize("in_space", [False, True])
def test_dxf_points_that_shape_a_polyline_are_not_drawn(tmp_path, in_space):
    document = ezdxf.new("R2010" if in_space else "R12")
    space = document.modelspace()
    both = [(tuple(place), 8) for place in cubic(ROUND)]
    frame = [(place, 16) for place in ROUND]
    both = both + frame if in_space else frame + both
    add = space.add_polyline3d if in_space else space.add_polyline2d
    line = add([(*place, 0) if in_space else place for place, _ in both], close=True)
    line.dxf.flags |= 4
    line.dxf.smooth_type = 6
    for vertex, (_, flag) in zip(line.vertices, both, strict=True):
        vertex.dxf.flags |= flag
    settings = ReadSettings(px_per_m=1000, unit="mm")
    (stone,) = read_stones(saved(document, tmp_path), settings=settings)
    assert stone.area_px == pytest.approx(shapely.Polygon(cubic(ROUND)).area, rel=2e-3)


def test_damaged_dxf(tmp_path):
    data, path = text_of(drawn()), tmp_path / "stones.dxf"
    for share in (0.3, 0.9):
        path.write_bytes(data[: int(share * len(data))])
        with pytest.raises(InputError, match=r"E106 .*damaged or cut short"):
            read_stones(path)
    document = ezdxf.new(units=units.M)
    document.modelspace().add_line((0, 0), (1, 1))
    with pytest.raises(InputError, match=r"E104 .*no stones.*1 LINE"):
        read_stones(saved(document, tmp_path))


def text_of(document):
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def outlines(document):
    """What is read of a drawing: the polygon of every stone by its name."""
    found = read_dxf(text_of(document), ReadSettings())
    shapes = {s.name: shapely.Polygon(s.areas[0].rings[0]) for s in found.stones}
    assert len(shapes) == len(found.stones)
    return shapes, " ".join(notice.message for notice in found.notices)


def with_blocks():
    """A box on layer 0 and one on a layer of its own, in a block of its own each."""
    document = ezdxf.new("R2010", units=units.MM)
    box = [(0, 0), (4, 0), (4, 3), (0, 3)]
    for name, layer in (("BOX", "0"), ("OWN", "own")):
        style = {"layer": layer}
        document.blocks.new(name).add_lwpolyline(box, close=True, dxfattribs=style)
    return document, document.modelspace()


def insert(space, name, *place, **style):
    space.add_blockref(name, place, dxfattribs=style)


def test_dxf_layer_0_in_a_block_is_the_layer_of_its_insert(tmp_path):
    document, space = with_blocks()
    for number in (7, 3):
        insert(space, "BOX", 10 * number, 0, layer=f"stone {number}")
    group = document.blocks.new("GROUP")
    insert(group, "BOX", 0, 20)  # on layer 0, so on that of what inserts the group
    insert(group, "BOX", 0, 30, layer="stone 9")
    insert(space, "GROUP", 0, 0, layer="stone 5")
    stones = read_stones(saved(document, tmp_path))
    assert [stone.id for stone in stones] == [3, 5, 7, 9]
    assert outlines(document)[0]["stone 5"].bounds == (0, 20, 4, 23)


def test_dxf_inserts_on_hidden_layers_do_not_count():
    """Frozen hides all of a block; off only what has its layer from the insert."""
    document, space = with_blocks()
    document.layers.add("off").off()
    document.layers.add("frozen").freeze()
    for i, layer in enumerate(("off", "frozen")):
        insert(space, "BOX", 0, 10 * i, layer=layer)
        insert(space, "OWN", 10, 10 * i, layer=layer)
    insert(space, "BOX", 20, 0, layer="seen", invisible=1)
    for style in ({"layer": "off"}, {"layer": "frozen"}, {"layer": "seen", "invisible": 1}):
        space.add_circle((60, 0), 3, dxfattribs=style)
    insert(document.blocks.new("GROUP"), "BOX", 30, 0)
    insert(space, "GROUP", 0, 0, layer="off")
    insert(space, "BOX", 40, 0, layer="seen")
    insert(space, "NONE", 50, 0)
    shapes, text = outlines(document)
    assert {name: shape.bounds[0] for name, shape in shapes.items()} == {"own": 10, "seen": 40}
    assert "8 entities that are hidden" in text
    assert "1 INSERT of a block that is not there" in text


def test_dxf_blocks_in_rows_mirrored_and_stretched():
    document, space = with_blocks()
    insert(space, "BOX", 0, 0, layer="mirrored", xscale=-2)
    inner = document.blocks.new("GRID", base_point=(1, 1))
    insert(inner, "BOX", 1, 1, row_count=2, column_count=3, row_spacing=10, column_spacing=20)
    insert(space, "GRID", 100, 0, layer="grid", rotation=90, yscale=-1)
    # Half a disk, turned and stretched in a block that is stretched another way.
    disk = document.blocks.new("DISK")
    disk.add_lwpolyline([(-1, 0, 1), (1, 0, 0)], "xyb", close=True)
    insert(document.blocks.new("LENS"), "DISK", 3, 0, rotation=30, xscale=2)
    insert(space, "LENS", 10, 50, layer="lens", rotation=90, yscale=-3)
    found = read_dxf(text_of(document), ReadSettings()).stones
    shapes = [(s.name, shapely.Polygon(s.areas[0].rings[0])) for s in found]
    assert [shape.bounds for name, shape in shapes if name == "mirrored"] == [(-8, 0, 0, 3)]
    # Mirrored in x axis of the block, then turned: x and y change places.
    boxes = {tuple(np.round(shape.bounds, 9)) for name, shape in shapes if name == "grid"}
    assert boxes == {(100 + y, x, 103 + y, x + 4) for x in (0, 20, 40) for y in (0, 10)}
    (half,) = (shape for name, shape in shapes if name == "lens")
    assert half.area == pytest.approx(math.pi / 2 * 2 * 3, rel=2e-3)
    lower = shapely.Point(0, 0).buffer(1, quad_segs=250) & shapely.box(-1, -1, 1, 0)
    known = affinity.rotate(affinity.scale(lower, 2, 1, origin=(0, 0)), 30, (0, 0))
    known = affinity.scale(affinity.translate(known, 3), 1, -3, origin=(0, 0))
    known = affinity.translate(affinity.rotate(known, 90, (0, 0)), 10, 50)
    assert half.symmetric_difference(known).area < 2e-3 * known.area


def test_dxf_external_references_are_named_and_blocks_in_each_other_refused():
    """Attached or laid over, with or without what some program kept of the other drawing."""
    document, space = with_blocks()
    insert(space, "BOX", 40, 0)
    for name, kind in (("plan", xref.const.BLK_XREF), ("sheet", xref.const.BLK_XREF_OVERLAY)):
        document.add_xref_def(f"{name}.dxf", name, kind | xref.const.BLK_EXTERNAL)
        insert(space, name, 0, 0, row_count=2, row_spacing=9)
    document.blocks.get("sheet").add_circle((9, 9), 5)
    shapes, text = outlines(document)
    assert [shape.bounds for shape in shapes.values()] == [(40, 0, 44, 3)]
    assert "left aside: 2 INSERT of an external reference." in text
    insert(document.blocks.get("BOX"), "BOX", 1, 1)
    with pytest.raises(InputError, match=r"E114 .*blocks are in each other"):
        outlines(document)
