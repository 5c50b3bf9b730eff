"""DXF and SVG of the known stones, written by ezdxf and by hand."""

import io
import math
import re
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from ezdxf import units

from drystone.errors import InputError, UsageError
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import HEIGHT, METRIC, PIECES, PX_PER_M, STONES, WIDTH, close, compare
from tests.io.test_planes import drawn

MM = 1000.0 / PX_PER_M


def saved(document, tmp_path, name="stones.dxf", **options):
    document.saveas(tmp_path / name, **options)
    return tmp_path / name


@pytest.mark.parametrize(("version", "kind"), [("R2000", "bin"), ("R2018", "asc")])
def test_dxf_versions_and_binary(tmp_path, version, kind):
    path = saved(drawn(version=version), tmp_path, "drawing", fmt=kind)
    stones = read_stones(path, settings=METRIC)
    close(stones)
    assert stones.source.px_per_m == PX_PER_M
    assert stones.by_id(8).name == "stone 8"
    assert any("1 outlines lie in others and are their holes" in n.message for n in stones.notices)


def test_dxf_names_are_in_the_code_page_of_the_drawing(tmp_path):
    document = ezdxf.new("R2000", units=units.MM)
    for i, layer in enumerate(("Stein ä", "Maß")):
        corners = [(200 * i, 0), (200 * i + 100, 0), (200 * i + 100, 60)]
        document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    stones = read_stones(saved(document, tmp_path))
    assert [stone.name for stone in stones] == ["Stein ä", "Maß"]


def test_dxf_without_a_unit_may_be_told_to_be_in_px(tmp_path):
    stones = read_stones(
        saved(drawn(code=0, unit=1 / PX_PER_M), tmp_path), settings=replace(PIECES, unit="px")
    )
    close(stones)
    assert stones.source.px_per_m is None
    assert dict(stones.source.reading)["unit"] == "px"


def test_a_unit_of_a_picture_is_refused():
    with pytest.raises(UsageError, match=r"E118.*in px, not in mm"):
        read_stones(np.pad(np.ones((9, 9), np.uint8), 3), settings=ReadSettings(unit="mm"))


def test_dxf_curves_and_blocks(tmp_path):
    document = ezdxf.new("R2010", units=units.M)
    space = document.modelspace()
    space.add_circle((1, 1), 0.4)
    space.add_ellipse((3, 1), major_axis=(0.5, 0), ratio=0.4)
    corners = [(5, 0.5, 0), (6, 0.5, 0), (6, 1.5, 0), (5, 1.5, 0)]
    space.add_spline().set_closed(corners)  # periodic: its first knots are before its beginning
    space.add_spline().set_open_rational(
        [(12, 0, 0), (14, 0, 0), (13, 1.7320508, 0), (12.5, 0.8660254, 0), (12, 0, 0)], [1] * 5, 1
    )
    # Half a circle as a bulge.
    space.add_lwpolyline([(7, 0.5, 0), (8, 0.5, 1), (8, 1.5, 0), (7, 1.5, 0)], "xyb", close=True)
    block = document.blocks.new("STONE")
    block.add_lwpolyline([(0, 0), (0.4, 0), (0.4, 0.3), (0, 0.3)], close=True)
    space.add_blockref("STONE", (10, 1), dxfattribs={"rotation": 90, "xscale": 2, "yscale": 2})
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
    assert areas[3] == pytest.approx(math.sqrt(3), rel=2e-3)  # a triangle
    assert areas[4] == pytest.approx(1 + math.pi / 8, rel=1e-3)
    assert areas[5] == pytest.approx(0.8 * 0.6, rel=1e-3)
    assert stones.by_id(6).mask.shape == (320, 240)  # turned
    (notice,) = [n for n in stones.notices if "left aside" in n.message]
    for kind in ("1 ARC", "1 LINE", "1 TEXT", "1 open LWPOLYLINE"):
        assert kind in notice.message


ROUND = [(371, 1077), (371, 971), (253, 969), (182, 980), (90, 1022), (180, 1157), (335, 1147)]
"""What a curve goes through or near, mm."""


def cubic(points):
    """A closed uniform cubic near points, by its matrix."""
    basis = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6.0
    powers = np.arange(0, 1, 1 / 64)[:, None] ** np.arange(4)
    rows = np.array(points, float)
    near = [np.roll(rows, -k, axis=0)[:4] for k in range(len(rows))]
    return np.concatenate([powers @ basis @ four for four in near])


def curves(tmp_path, *makers):
    document = ezdxf.new("R2010", units=units.MM)
    for make in makers:
        make(document.modelspace())
    # All lie in one place, so they look like repeats.
    settings = ReadSettings(px_per_m=1000, keep=tuple(range(1, len(makers) + 1)))
    stones = read_stones(saved(document, tmp_path), settings=settings)
    return [stone.area_px for stone in stones], [n.message for n in stones.notices]


def area(points):
    x, y = np.array(points, float).T
    return abs(np.roll(x, -1) @ y - x @ np.roll(y, -1)) / 2.0


def test_dxf_splines_that_say_they_are_closed(tmp_path):
    angles = np.arange(12) * (math.pi / 6)
    around = np.column_stack([100 * np.cos(angles), 100 * np.sin(angles)]).tolist()

    def fit(space, *, closed=True):
        space.add_spline(around).dxf.flags = int(closed)

    def fit_again(space):
        space.add_spline([*around, around[0]]).dxf.flags = 1

    def periodic(space):  # without the control points of its beginning at its end
        line = space.add_spline()
        line.control_points = ROUND
        line.knots = range(len(ROUND) + 4)
        line.dxf.flags = 3

    def clamped(space):
        space.add_open_spline(ROUND).dxf.flags = 1

    areas, said = curves(tmp_path, fit, fit_again, periodic)
    smooth = area(cubic(ROUND))
    assert areas[:2] == pytest.approx([math.pi * 1e4] * 2, rel=2e-3)
    assert areas[2] == pytest.approx(smooth, rel=2e-3)
    assert not any("apart" in text for text in said)
    areas, said = curves(tmp_path, clamped)
    ends_apart = [point.xyz[:2] for point in ezdxf.math.BSpline(ROUND).approximate(500)]
    assert areas[0] == pytest.approx(area(ends_apart), rel=2e-3)
    assert any("end apart" in text and "straight line" in text for text in said)
    with pytest.raises(InputError, match=r"E104 .*1 open SPLINE"):
        curves(tmp_path, lambda space: fit(space, closed=False))


@pytest.mark.parametrize(
    ("version", "in_space", "frame_first"), [("R12", False, True), ("R2010", True, False)]
)
def test_dxf_points_that_shape_a_polyline_are_not_drawn(tmp_path, version, in_space, frame_first):
    document = ezdxf.new(version)
    space = document.modelspace()
    drawn = [((x, y), 8) for x, y in cubic(ROUND)]
    frame = [((x, y), 16) for x, y in ROUND]
    both = frame + drawn if frame_first else drawn + frame
    add = space.add_polyline3d if in_space else space.add_polyline2d
    points = [(*place, 0) if in_space else place for place, _ in both]
    line = add(points, close=True)
    line.dxf.flags |= 4
    line.dxf.smooth_type = 6
    for vertex, (_, flag) in zip(line.vertices, both, strict=True):
        vertex.dxf.flags |= flag
    settings = ReadSettings(px_per_m=1000, unit="mm")
    (stone,) = read_stones(saved(document, tmp_path), settings=settings)
    assert stone.area_px == pytest.approx(area(cubic(ROUND)), rel=2e-3)


def test_resolution_of_a_drawing_makes_the_median_stone_160_px_long(tmp_path):
    stones = read_stones(saved(drawn(), tmp_path), settings=ReadSettings(holes="keep"))
    sides = [max(stone.mask.shape) for stone in stones]
    assert 150 <= np.median(sides) <= 170
    scale = stones.source.px_per_m
    assert float(f"{scale:.2g}") == scale
    (notice,) = [n for n in stones.notices if "median stone" in n.message]
    assert f"{scale:g} px a metre" in notice.message
    assert "px_per_m" not in dict(stones.source.reading)


def svg(body, width=f"{WIDTH * MM}mm", height=f"{HEIGHT * MM}mm", box=f"0 0 {WIDTH} {HEIGHT}"):
    return (
        f'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="{width}" '
        f'height="{height}" viewBox="{box}" xmlns:xlink="http://www.w3.org/1999/xlink">\n'
        f"{body}\n</svg>\n"
    )


def data_of(polygons):
    return " ".join(
        "M" + "L".join(f"{x} {y}" for x, y in ring) + "Z" for rings in polygons for ring in rings
    )


def paths():
    return "\n".join(
        f'<path id="stone-{i}" fill-rule="evenodd" d="{data_of(polygons)}"/>'
        for i, polygons in STONES.items()
    )


def kept(text, tmp_path, settings=METRIC):
    (tmp_path / "stones.svg").write_text(text)
    return read_stones(tmp_path / "stones.svg", settings=settings)


@pytest.mark.parametrize(
    ("width", "height"),
    [
        (f"{WIDTH * MM}mm", f"{HEIGHT * MM}mm"),
        (f"{WIDTH * MM / 10} cm", f"{HEIGHT * MM / 25.4 * 72}pt"),
        (f"{WIDTH * MM}mm", f"{HEIGHT * MM / 25.4}in"),
    ],
)
def test_svg_to_scale(tmp_path, width, height):
    stones = kept(svg(paths(), width, height), tmp_path)
    close(stones)
    assert stones.source.px_per_m == PX_PER_M
    assert stones.by_id(300).name == "stone-300"


@pytest.mark.parametrize(("width", "box"), [("320", "0 0 320 200"), ("320px", "0 0 320 200")])
def test_svg_in_px_is_an_image(tmp_path, width, box):
    stones = kept(svg(paths(), width, "200", box), tmp_path)
    assert compare(stones) == (1.0, 0.0, 0.0)
    assert stones.source.px_per_m is None
    assert (stones.source.width_px, stones.source.height_px) == (WIDTH, HEIGHT)
    assert dict(stones.source.reading) == {"pieces": "keep-largest", "holes": "keep"}


def test_svg_in_px_with_a_unit_that_is_told(tmp_path):
    told = replace(METRIC, unit="cm")
    text = svg(paths(), "100%", "100%").replace("<path ", f'<path transform="scale({MM / 10})" ')
    close(kept(text, tmp_path, told))


def test_stones_that_lie_far_apart_are_drawn_smaller(tmp_path):
    """Most of their picture would be empty: at 160 px a stone it would have 100 million px."""
    places = ((0, 0), (500, 0), (9, 700))
    three = "".join(f'<rect x="{x}" y="{y}" width="9" height="9"/>' for x, y in places)
    stones = kept(svg(three, "509mm", "709mm", "0 0 509 709"), tmp_path, ReadSettings())
    assert len(stones) == 3
    assert stones.source.width_px * stones.source.height_px < 3_000_000
    (notice,) = [n for n in stones.notices if "median stone" in n.message]
    assert int(re.search(r"it is (\d+) px", notice.message)[1]) < 160


def test_svg_definitions_are_used_under_nested_transforms(tmp_path):
    """Every stone is defined turned and mirrored, and put back by the transforms around it."""
    defined, used = [], []
    for number, (i, polygons) in enumerate(STONES.items()):
        cos, sin = math.cos(math.radians(17 * number)), math.sin(math.radians(17 * number))
        turned = [
            [[(x * cos - y * sin, x * sin + y * cos) for x, y in ring] for ring in rings]
            for rings in polygons
        ]
        href = "href" if number % 2 else "xlink:href"
        defined.append(f'<path id="stone_{i}" style="fill-rule: evenodd" d="{data_of(turned)}"/>')
        used.append(f'<use {href}="#stone_{i}" transform="rotate({-17 * number})" id="u{i}"/>')
    body = (
        f"<defs>{''.join(defined)}</defs>"
        f'<g transform="matrix(2 0 0 -2 30 {HEIGHT})"><g transform="scale(.5 -.5)">'
        f'<a transform="translate(-25 {HEIGHT})"><g transform="translate(-5,{-HEIGHT})">'
        f'<g transform="translate(0 {HEIGHT})">{"".join(used)}</g></g></a></g></g>'
    )
    close(kept(svg(body), tmp_path))


def test_svg_shapes_by_closed_forms(tmp_path):
    body = """
      <rect width="320" height="200" fill="white"/>
      <rect id="stone1" x="10" y="10" width="60" height="40"/>
      <rect id="stone2" x="80" y="10" width="60" height="40" rx="10"/>
      <rect id="stone3" x="150" y="10" width="60" height="40" rx="10" ry="90"/>
      <circle id="stone4" cx="250" cy="40" r="30"/>
      <ellipse id="stone5" cx="60" cy="110" rx="40" ry="25" transform="rotate(30 60 110)"/>
      <polygon id="stone6" points="120,90 180,90 180,140 120,140"/>
      <polyline id="stone7" points="200 90 260 90 260 140 200 140 200 90"/>
      <defs><circle id="s" cx="10" cy="10" r="10"/></defs>
      <use href="#s" id="stone8" x="20" y="150"/>
      <path id="stone9" d="M100 150h60v40h-60zM110 160v20h40v-20z"/>
      <path id="stone10" d="M180 150h60v40h-60zM190 160h40v20h-40z"/>
      <polyline points="0 0 5 5 9 0" fill="none" stroke="red"/> <text>stone</text> <line x2="4"/>
      <path d="M0 0 L9 9 L4 9" fill="none" stroke="red"/> <circle r="5" display="none"/>
      <g style="visibility:hidden"><circle r="5"/></g>
      <clipPath><rect width="9" height="9"/></clipPath>
    """
    stones = kept(svg(body, "320", "200"), tmp_path, ReadSettings(holes="keep"))
    areas = {stone.id: stone.area_px for stone in stones}
    corner = 4 - math.pi  # of a square of 2, what its circle leaves
    known = [
        2400, 2400 - corner * 100, 2400 - corner * 200, math.pi * 900, math.pi * 1000, 3000, 3000,
        math.pi * 100,
        2400 - 800,  # the hole turns the other way
        2400,  # and here it does not
    ]  # fmt: skip
    assert areas == pytest.approx(dict(enumerate(known, start=1)), rel=6e-3)
    (notice,) = [n for n in stones.notices if "left aside" in n.message]
    for kind in ("1 text", "1 line,", "1 open lines in path", "1 open lines in polyline",
                 "1 rectangles over the whole page"):  # fmt: skip
        assert kind in notice.message


def test_svg_layer_of_stones_is_all_that_counts(tmp_path):
    body = f'<rect x="3" y="3" width="90" height="90"/><g id="STONES">{paths()}</g>'
    stones = kept(svg(body), tmp_path)
    close(stones)
    assert "1 shapes outside the group STONES" in stones.notices[0].message


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ('<path id="a" d="M0 0 L5"/>', r"E114 .*the path 'a' cannot be used \(L has 1 numbers"),
        ('<use href="#nothing"/>', r"E114 .*'#nothing', which is not there"),
        ('<g id="a"><use href="#a"/></g>', r"E114 .*use each other too often or too deeply"),
        ('<circle r="1%"/>', r"E114 .*a circle cannot be used \(r in %"),
        ('<circle r="1em"/>', r"E114 .*a circle cannot be used \(r in em"),
        ('<rect width="9em" height="9%"/>', r"E114 .*a rect .*width in em"),
        ('<use href="#a" x="1em"/><g id="a"/>', r"E114 .*a use .*x in em"),
        ('<polygon points="1 2 3"/>', r"E114 .*a polygon cannot be used"),
        ('<g transform="turn(3)"/>', r"E114 .*not a transform"),
        ("<text>nothing</text>", r"E104 .*no stones in it.*1 text"),
        ("<g>", r"E106 .*damaged or cut short \(mismatched tag"),
    ],
)
def test_damaged_svg(tmp_path, body, text):
    with pytest.raises(InputError, match=text):
        kept(svg(body), tmp_path)


def test_damaged_dxf(tmp_path):
    text = io.StringIO()
    drawn().write(text)
    path = tmp_path / "stones.dxf"
    for share in (0.3, 0.9):
        path.write_text(text.getvalue()[: int(share * len(text.getvalue()))])
        with pytest.raises(InputError, match=r"E106 .*damaged or cut short"):
            read_stones(path)
    document = ezdxf.new(units=units.M)
    document.modelspace().add_line((0, 0), (1, 1))
    with pytest.raises(InputError, match=r"E104 .*no stones.*1 LINE"):
        read_stones(saved(document, tmp_path))


def test_a_stray_outline_far_away_is_too_large_a_picture(tmp_path):
    document = drawn()
    document.modelspace().add_circle((1e3, 1e3), 0.005)
    with pytest.raises(InputError, match=r"E110.*far away"):
        read_stones(saved(document, tmp_path), settings=METRIC)
