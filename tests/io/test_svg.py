"""SVG: the known stones, the page, what style hides and fills, and what clip paths leave."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.errors import InputError
from drystone.io.outlines_in.svg import read_svg, subpaths, transform
from drystone.io.read_stones import ReadSettings, read_stones
from tests.io.known_stones import HEIGHT, METRIC, PX_PER_M, STONES, WIDTH, close, compare
from tests.io.pictures import written

MM = 1000.0 / PX_PER_M
PAGE = 'width="200mm" height="100mm" viewBox="0 0 200 100"'


def bounds(body, page=PAGE):
    """Boxes around all that is read of a drawing: left, top, width, height; and what is said."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>'
    found = read_svg(text.encode(), ReadSettings())
    rings = [np.concatenate(stone.areas[0].rings) for stone in found.stones]
    boxes = [[*ring.min(axis=0), *np.ptp(ring, axis=0)] for ring in rings]
    return np.array(boxes).round(9).tolist(), " ".join(n.message for n in found.notices)


STONE = '<rect x="1" y="2" width="8" height="4"{}/>'
SEEN = [1, 2, 8, 4]
RECT = STONE.format("")


def test_a_box_lies_in_the_middle_of_the_page_unless_it_is_stretched():
    for ratio, box in (("xMidYMid meet", [12, 4, 16, 8]), (" none ", [4, 4, 32, 8])):
        page = f'width="40mm" height="20mm" viewBox="0 0 10 10" preserveAspectRatio="{ratio}"'
        assert bounds(RECT, page)[0] == [box]
        shifted = page.replace("0 0 10 10", "-5 3 10 10")
        moved = [box[0] + 5 * box[2] / 8, box[1] - 3 * box[3] / 4, *box[2:]]
        np.testing.assert_allclose(bounds(RECT, shifted)[0], [moved])


def test_per_cents_are_of_the_page_and_its_style_says_how_a_window_shows_it():
    assert bounds('<rect x="10%" y="1%" width="25%" height="50%"/>')[0] == [[20, 1, 50, 50]]
    assert bounds(f'<symbol id="s">{RECT}</symbol>{RECT}')[0] == [SEEN]
    assert bounds(RECT, f'{PAGE} style="width:100%;height:auto"')[0] == [SEEN]


def test_what_nobody_sees_is_left_aside():
    sheet = """<style>/* rect{display:none} */ @font-face { font-family: f; src: url(f) }
        .d {fill-opacity:0} .e {fill:none; stroke:#0000; stroke-width:9}
        .b, #c { display: none } rect.sheet {visibility:hidden !important} text{fill:none}
        g > rect:hover { cursor: pointer } rect:hover { display: none }</style>"""
    for hidden in (
        ' display="none"', ' visibility="hidden"', ' opacity="0"', ' style="opacity:0%"',
        ' style="display : none"', ' style="visibility:collapse;fill:red"',
        ' fill="NONE"', ' style="fill:none;stroke:none"', ' fill="transparent"',
        ' display="None"', ' style="fill:red;fill-opacity:0"', ' fill-opacity="0.0%"',
        ' fill="#f000"', ' fill="#FF000000"', ' fill="RGBA(0, 0, 0, 0)"', ' fill="url(#no)"',
        ' style="fill:rgb(0 0 0 / 0%)"', ' fill="hsla(0,0%,0%,.0)"', ' fill="url(#no) None"',
        ' style="fill:none;stroke:red;stroke-width:0mm"', ' class="d"', ' class="e"',
        ' fill="none" stroke="red" stroke-opacity="0"',
        ' class="a b"', ' id="c"', ' class="sheet"',
    ):  # fmt: skip
        boxes, said = bounds(sheet + STONE.format(hidden) + RECT)
        assert boxes == [SEEN]
        assert re.search("1 elements (that are hidden|without a fill or a line that is seen)", said)
    assert "without a fill" in bounds(STONE.format(' fill="none"') + RECT)[1]


def test_the_rule_that_says_most_counts():
    """Later rules win among equals; ids win over classes, these over tags, these over all."""
    for sheet, stone in (
        ("*{display:none} rect{display:inline}", ""),
        ("#c{display:inline} rect.a{display:none}", ' id="c" class="a"'),
        (".a{opacity:0} .a{opacity:1}", ' class="a"'),
        ("rect{visibility:hidden}", ' style="visibility:visible"'),
        (".a{fill:none;stroke:#000}", ' class="a"'),
        ("rect{display:inline}", ' display="none"'),
        ("g{width:3px}", ""),
        ("g > rect{stroke-width:2}", ' fill-opacity=".1" stroke-width="0" fill="rgb(0,0,0)"'),
        ("rect{fill:url(#no) red}", ""),
        ("rect{fill:url(#one)}", ' id="one"'),
        (".a{fill-opacity:0;stroke:rgba(0,0,0,0.1)}", ' class="a"'),
    ):
        assert bounds(f"<style>{sheet}</style>{STONE.format(stone)}")[0] == [SEEN]


def test_paint_and_visibility_are_inherited_and_a_fill_closes_lines_that_are_open():
    group = '<g fill="none" visibility="hidden">{}</g>'
    seen = STONE.format(' fill="red" visibility="visible"')
    assert bounds(group.format(RECT + seen))[0] == [SEEN]
    assert bounds(f'<g opacity="0">{seen}</g>{seen}')[0] == [SEEN]
    some = STONE.format(' fill-opacity="1"')
    assert bounds(f'<g fill-opacity="0">{RECT}{some}</g>')[0] == [SEEN]
    line = '<path d="M1 2h8v4h-8"{}/><polyline points="1 2 9 2 9 6 1 6"{}/>'
    assert bounds(line.format("", ""))[0] == [SEEN, SEEN]
    for clear in ("none", "red", "#0000"):
        stroke = f' fill="{clear}" stroke="red" fill-opacity="{int(clear != "red")}"'
        boxes, said = bounds(RECT + line.format(stroke, stroke))
        assert boxes == [SEEN]
        assert "1 open lines in path, 1 open lines in polyline" in said


def test_pages_ways_of_a_switch_and_other_layers_and_sheets_are_left_aside_and_named():
    other = '<g {}><rect width="5" height="5"/></g>'
    ways = [other.format(f'{name}="de"') for name in ("systemLanguage", "requiredExtensions")]
    sheet = "<style>@import url(a.css); .a{opacity:0}</style>"
    for body, text in (
        (f'<rect width="100%" height="100%"/>{RECT}', "1 rectangles over the whole page"),
        (f"<switch><title/>{''.join(ways)}{RECT}{other.format('')}</switch>",
         "3 elements that are hidden"),
        (f'<switch>{ways[1]}<g systemLanguage="de">{RECT}</g></switch>', "1 elements that are hid"),
        (sheet + RECT + STONE.format(' class="a"'), "a style sheet in another file was not read"),
        (f'<rect width="9" height="9"/><g id="STONES">{RECT}</g>',
         "1 shapes outside the group STONES"),
    ):  # fmt: skip
        boxes, said = bounds(body)
        assert boxes == [SEEN]
        assert text in said


LEFT, MIDDLE, RIGHT = (
    f'<rect id="stone_{i}" x="{x}" y="10" width="40" height="40" {{0}}/>'
    for i, x in enumerate((0, 60, 120), start=1)
)
ALL = (LEFT + MIDDLE + RIGHT).format("")
CUT = [[0, 10, 40, 40], [60, 10, 20, 40]]
"""What is there when all from x = 80 on is not."""


def clip(content, **attributes):
    more = " ".join(f'{name.replace("_", "-")}="{value}"' for name, value in attributes.items())
    return f'<defs><clipPath id="c" {more}>{content}</clipPath></defs>'


def clipped(content, **attributes):
    """All three, without what is outside."""
    return clip(content, **attributes) + ON


ON = f'<g clip-path="url(#c)">{ALL}</g>'
HALF = '<rect width="80" height="100"/>'
OTHER = '<clipPath id="d"><rect width="{}" height="99"/></clipPath>'
WAYS = {
    "each": clip(HALF) + (LEFT + MIDDLE + RIGHT).format('clip-path="url(#c)"'),
    "sheet": clip(HALF) + f"<style>.k{{clip-path:url(#c)}}</style><g class='k'>{ALL}</g>",
    "after": f'<g clip-path="url( #c )">{ALL}</g>' + clip(HALF),
    "two": clipped('<rect width="50" height="99"/><rect x="40" width="40" height="99"/>'),
    "moved": clipped('<rect width="100" height="99" transform="scale(.5 1)"/>',
                     transform="scale(1.6 1)"),
    "used": '<defs><rect id="r" width="80" height="99" display="inline"/></defs>'
    + clipped('<use href="#r" x="0" y="0"/>'),
    "hidden": clipped(HALF + '<rect width="200" height="99" visibility="hidden"/>'),
    "nested": clip(HALF + '<rect x="110" width="90" height="99"/>') + OTHER.format(109)
    + f'<g clip-path="url(#d)">{ON}</g>',
    "in its own units": clip('<rect width="40" height="50"/>')
    + f'<g transform="scale(2)" clip-path="url(#c)"><g transform="scale(.5)">{ALL}</g></g>',
    "on a use": clip('<rect x="-20" width="80" height="100"/>')
    + f'<defs><g id="g" transform="translate(-20)">{ALL}</g></defs>'
    + '<use href="#g" x="20" clip-path="url(#c)"/>',
    "hole": clipped('<path d="M0 0H200V100H0zM80 0H180V100H80z" clip-rule="evenodd"/>'),
    "clipped itself": clipped('<rect width="190" height="99"/>', clip_path="url(#d)")
    + OTHER.format(80),
}  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_what_is_outside_of_a_clip_is_not_there(way):
    found, said = bounds(WAYS[way])
    assert found == [pytest.approx(box) for box in CUT]
    assert "outside of their clip paths, left out: stone_3." in said
    assert "cut by their clip paths: stone_2 (50 % is left)." in said


ROUND = '<circle id="stone_1" cx="50" cy="50" r="20" clip-path="url(#c)"/>'


def test_clips_that_leave_all_or_nothing():
    for body, count, text in (
        (clipped('<rect width="190" height="99"/>'), 3, ""),
        (clipped('<path d="M0 0H200V100H0zM50 0V100H55V0z"/>'), 3, ""),
        (clip(HALF) + f'<g clip-path="none">{ALL}</g>', 3, ""),
        (clip('<circle cx="50" cy="50" r="21"/>') + ROUND, 1, ""),  # its box is not within
        (f'<g clip-path="url(#b)">{ALL}</g>', 3, "that are not there, so nothing was cut: b."),
        (clipped(""), 0, "outside of their clip paths, left out: stone_1, stone_2, stone_3."),
    ):
        found, said = bounds(body)
        assert len(found) == count
        assert text in said
        assert bool(text) == bool(said)


FEW = "E114 .*Save it as plain SVG"
SHEET = "E114 .*style sheet says .* for {}.*plain SVG"
MOVED = "E114 .*a rect cannot be used .*"
ROUGH, FINE = (
    " ".join(f"{x} {y}" for x, y in points)
    for points in (
        [(i % 200, i * 7 % 100) for i in range(3000)],
        [*((i / 100, 10 + i % 2) for i in range(8000)), (80, 99), (0, 99)],
    )
)


def test_what_is_refused(tmp_path):
    for body, text in (
        (f"<svg>{RECT}</svg>", FEW),
        (f'<symbol id="s">{RECT}</symbol><use href="#s"/>', FEW),
        # What moves or shapes by style.
        (STONE.format(' style="transform:scale(2)"'), MOVED + "says transform"),
        (STONE.format(' style="transform:none" transform="scale(2)"'), MOVED + "says transform"),
        (STONE.format(' style="x:3px"'), MOVED + "says x"),
        (f"<style>rect{{translate:3px}}</style>{RECT}", MOVED + "says translate"),
        (STONE.format(' transform="scale(2)" style="transform-origin:5px 5px"'),
         MOVED + "transform-origin"),
        # Rules that may hide something.
        (f"<style>g rect{{display:none}}</style>{RECT}", SHEET.format("'g rect'")),
        (f"<style>rect:not(.b){{visibility:hidden}}</style>{RECT}", SHEET.format("'rect:not")),
        (f"<style>[id=a]{{transform:scale(2)}}</style>{RECT}", SHEET.format("'.id=a.'")),
        (f"<style>@media print {{.h{{opacity:0}}}}</style>{RECT}", SHEET.format("'@media'")),
        ("<style>@import 'a'; @media print {*{fill:red}}</style>", SHEET.format("'@media'")),
        (f"<style>g > rect{{fill-opacity:0}}</style>{RECT}", SHEET.format("'g > rect'")),
        (f'<style media="print">.h{{display:none}}</style>{RECT}', SHEET.format("'media print'")),
        # Clips of other kinds, and those that take too long.
        (f'<mask id="m"/><g mask="url(#m)">{ALL}</g>', "E114 .*its mask is not read"),
        (f'<g style="clip-path:circle(9px)">{ALL}</g>', "E114 .*its clip path 'circle"),
        (clipped("<text>a</text>"), "E114 .*a text in"),
        (clipped("", clip_path="url(#c)"), "E114 .*too deeply"),
        (clipped("", clipPathUnits="objectBoundingBox"), "E114 .*shares of its box.* release it"),
        (f"<style>g > rect{{clip-path:url(#c)}}</style>{ALL}", "E114 .*style sheet says clip-path"),
        (clipped(f'<path d="M{ROUGH}"/>'), "E114 .*cross themselves"),
        (clip(f'<path d="M{FINE}"/>') + f'<g clip-path="url(#c)">{ALL * 40}</g>',
         "E110 .*clip paths cut more than"),
        # Damage.
        ('<path id="a" d="M0 0 L5"/>', r"E114 .*the path 'a' cannot be used \(L has 1 numbers"),
        ('<use href="#nothing"/>', r"E114 .*'#nothing', which is not there"),
        ('<g id="a"><use href="#a"/></g>', r"E114 .*use each other too often or too deeply"),
        ('<circle r="1em"/>', r"E114 .*a circle cannot be used \(r in em"),
        ('<use href="#a" x="1em"/><g id="a"/>', r"E114 .*a use .*x in em"),
        ('<polygon points="1 2 3"/>', r"E114 .*a polygon cannot be used"),
        ("<text>nothing</text>", r"E104 .*no stones in it.*1 text"),
        ("<g>", r"E106 .*damaged or cut short \(mismatched tag"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=text):
            kept(svg(body), tmp_path)
    page = 'width="40mm" height="20mm" viewBox="0 0 1 1" preserveAspectRatio="xMinYMax"'
    with pytest.raises(InputError, match=FEW):
        bounds(RECT, page)
    with pytest.raises(InputError, match=r"E114 .*x in % is not read"):
        bounds('<rect x="3%" width="8" height="4"/>', "")


def test_a_wrong_unit_of_a_drawing_is_corrected(tmp_path):
    for own, unit, metres in (
        ("mm", "px", None), ("mm", "mm", 1e-3), ("in", "m", 1.0), ("pt", "cm", 1e-2),
        ("pc", "ft", 0.3048),
    ):  # fmt: skip
        page = svg(ALL.replace('id="', 'data-x="'), f"200{own}", f"100{own}", "0 0 400 200")
        stones = kept(page, tmp_path, ReadSettings(unit=unit))
        said = [n.message for n in stones.notices if "gives another unit" in n.message]
        assert len(said) == (own != unit)
        scale = stones.source.px_per_m
        if metres is None:
            assert (scale, stones.by_id(1).area_px) == (None, 1600)
            continue
        # Shares of a unit are what a user unit is.
        side = 40 * metres * (0.5 if own == unit else 1.0)
        assert stones.by_id(1).area_px / scale**2 == pytest.approx(side**2, rel=0.02)


def svg(body, width=f"{WIDTH * MM}mm", height=f"{HEIGHT * MM}mm", box=f"0 0 {WIDTH} {HEIGHT}"):
    return (
        f'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="{width}" '
        f'height="{height}" viewBox="{box}" xmlns:xlink="http://www.w3.org/1999/xlink">\n'
        f"{body}\n</svg>\n"
    )


def paths():
    rings = {i: " ".join("M" + "L".join(f"{x} {y}" for x, y in ring) + "Z"
                         for rings in polygons for ring in rings)
             for i, polygons in STONES.items()}  # fmt: skip
    made = (f'<path id="stone-{i}" fill-rule="evenodd" d="{data}"/>' for i, data in rings.items())
    return "\n".join(made)


def kept(text, tmp_path, settings=METRIC):
    return read_stones(written(tmp_path, text, "stones.svg"), settings=settings)


def test_svg_to_scale_or_as_an_image(tmp_path):
    wide, high = WIDTH * MM, HEIGHT * MM / 25.4
    for width, height in ((f"{wide}mm", f"{HEIGHT * MM}mm"), (f"{wide / 10} cm", f"{high * 72}pt"),
                          (f"{wide}mm", f"{high}in")):  # fmt: skip
        stones = kept(svg(paths(), width, height), tmp_path)
        close(stones)
        assert stones.source.px_per_m == PX_PER_M
        assert stones.by_id(300).name == "stone-300"
    stones = kept(svg(paths(), "320px", "200"), tmp_path)
    assert compare(stones) == 1.0
    assert stones.source.px_per_m is None
    assert (stones.source.width_px, stones.source.height_px) == (WIDTH, HEIGHT)
    assert dict(stones.source.reading) == {"pieces": "keep-largest", "holes": "keep"}
    text = svg(paths(), "100%", "100%").replace("<path ", f'<path transform="scale({MM / 10})" ')
    close(kept(text, tmp_path, replace(METRIC, unit="cm")))


def test_stones_that_lie_far_apart_are_drawn_smaller(tmp_path):
    """Most of their picture would be empty: at 160 px a stone it would have 100 million px."""
    places = ((0, 0), (500, 0), (9, 700))
    three = "".join(f'<rect x="{x}" y="{y}" width="9" height="9"/>' for x, y in places)
    stones = kept(svg(three, "509mm", "709mm", "0 0 509 709"), tmp_path, ReadSettings())
    assert len(stones) == 3
    assert stones.source.width_px * stones.source.height_px < 3_000_000
    (notice,) = [n for n in stones.notices if "median stone" in n.message]
    assert int(re.search(r"it is (\d+) px", notice.message)[1]) < 160


def test_definitions_are_used_under_nested_transforms_and_of_one_id_the_first():
    """Turned where they are defined, mirrored around, and put back."""
    page = 'viewBox="0 0 200 100" xmlns:xlink="http://www.w3.org/1999/xlink"'
    defined = STONE.format(' id="stone" transform="rotate(90)"')
    used = "".join(f'<use {a}="#stone" transform="rotate(-90)"/>' for a in ("href", "xlink:href"))
    body = (
        f'<defs>{defined}</defs><g transform="matrix(2 0 0 -2 30 100)">'
        f'<a transform="translate(-15 50)"><g transform="scale(.5 -.5)">{used}</g></a></g>'
    )
    assert bounds(body, page)[0] == [SEEN, SEEN]
    twice = STONE.format(' id="s"') + '<circle id="s" r="3"/>'
    assert bounds(f'<defs>{twice}</defs><use href="#s"/>')[0] == [SEEN]


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
      <path d="M0 0 L9 9 L4 9" fill="none" stroke="red"/>
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


def test_a_number_beside_a_label_of_inkscape_counts():
    body = STONE.format(' id="stone_7" i:label="granite"')
    for inner in (' id="path1"', ' id="stone_4" i:label="stone 9"'):
        body += f'<g id="stone_5" i:label="slate">{STONE.format(inner)}</g>'
    inkscape = 'xmlns:i="http://www.inkscape.org/namespaces/inkscape"'
    stones = read_svg(svg(f"<g {inkscape}>{body}</g>").encode(), ReadSettings()).stones
    known = [(7, "granite"), (5, "path1"), (9, "stone 9")]
    assert [(stone.id, stone.name) for stone in stones] == known


def test_areas_by_closed_forms():
    for data, expected in (
        ("m 1 1 h4 v3 h-4 z m 10 0 h4 v3 h-4 z", 24.0),  # z comes back to where it began
        ("M10 10 A5 5 0 0 1 20 10 A5 5 0 0 1 10 10Z", math.pi * 25),
        ("M0 0 A1 1 0 0 1 20 0 Z", math.pi * 50),  # radii that cannot reach grow
        ("M0 0a10 10 0 0120 0z", math.pi * 50),  # flags without spaces
        ("M0 0 C 0 10 10 10 10 0 Z", 60.0),  # three fifths of the box of its handles
        ("M0 0 Q 5 10 10 0 Z", 100 / 3),  # two thirds of base times half the handle
        ("M0 0 q 5 10 10 0 t 10 0 V 10 H 0 Z", 200.0),
        ("M0 0.5.5.5.5 1e0-.5 1z", 0.375),
    ):
        found = sum(shapely.Polygon(line.points).area for line in subpaths(data))
        assert found == pytest.approx(expected, rel=3e-4)


def test_smooth_curves_mirror_their_handles():
    for smooth, written_out in (
        ("M0 0 Q5 10 10 0 T20 0 T30 0", "M0 0 Q5 10 10 0 Q15 -10 20 0 Q25 10 30 0"),
        ("M0 0 C1 5 6 7 10 0 S15 3 20 0", "M0 0 C1 5 6 7 10 0 C14 -7 15 3 20 0"),
        ("m0 0c1 5 6 7 10 0s5 3 10 0", "M0 0 C1 5 6 7 10 0 C14 -7 15 3 20 0"),
        # After another command there is nothing to mirror: the handle is where the pen is.
        ("M0 0 L5 5 S8 9 10 5", "M0 0 L5 5 C5 5 8 9 10 5"),
    ):
        found, known = (subpaths(data)[0].points for data in (smooth, written_out))
        np.testing.assert_allclose(found, known)
    assert subpaths("M0 0 L5 5 T10 5")[0].points[:, 1].max() == 5.0


@given(
    st.floats(1, 50), st.floats(1, 50), st.floats(-180, 180), st.floats(0, 360), st.floats(5, 355),
    st.booleans(),
)  # fmt: skip
def test_arcs_lie_on_their_ellipse(rx, ry, turn_deg, first_deg, sweep_deg, forwards):
    """An arc is made from a known centre; its points must be where the ellipse is."""
    turn = np.radians(turn_deg)
    matrix = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    sense = 1 if forwards else -1
    angles = np.radians(first_deg + sense * sweep_deg * np.array([0.0, 0.5, 1.0]))
    known = (np.column_stack([np.cos(angles), np.sin(angles)]) * (rx, ry)) @ matrix.T + (7.0, -3.0)
    (x0, y0), middle, (x1, y1) = known.tolist()
    large, sweep = int(sweep_deg > 180), int(forwards)
    data = f"M{x0!r} {y0!r}A{rx!r} {ry!r} {turn_deg!r} {large} {sweep} {x1!r} {y1!r}"
    points = subpaths(data)[0].points
    radii = np.hypot(*((points - (7.0, -3.0)) @ matrix / (rx, ry)).T)
    if 175 < sweep_deg < 185:  # where the arc is half the ellipse the centre hardly matters
        np.testing.assert_allclose(radii, 1.0, atol=0.2)
    else:
        np.testing.assert_allclose(radii, 1.0, atol=1e-5)
        assert np.hypot(*(points - middle).T).min() <= 0.03 * max(rx, ry)


def test_transforms():
    for text, point in (
        ("", (3, 4)),
        ("translate(5 6)", (8, 10)),
        ("scale(2,-1)", (6, -4)),
        ("rotate(90, 3, 5)", (4, 5)),
        ("skewX(45)", (7, 4)),
        ("skewY(45)", (3, 7)),
        ("matrix(1 2 3 4 5 6)", (3 + 12 + 5, 6 + 16 + 6)),
        ("translate(10,0) rotate(90)", (6, 3)),
    ):
        np.testing.assert_allclose((transform(text) @ (3, 4, 1))[:2], point, atol=1e-12)


def test_damaged_path_data_and_transforms():
    for read, data, text in (
        (subpaths, "L1 1", "not with a move"),
        (subpaths, "M1 1 L1 x", "'x' is not a number"),
        (subpaths, "M1 1 z 4", "numbers after z"),
        (subpaths, "M0 0 A1 1 0 2 0 3 3", "not a number"),
        *((transform, data, "transform|convert")
          for data in ("spin(3)", "rotate(1 2)", "matrix(1)", "translate 4", "scale(a)")),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=text):
            read(data)
