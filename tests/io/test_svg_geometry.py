"""CSS geometry of SVG: sizes and places by style sheets, against what Chromium 150 shows."""

import pytest

from drystone.errors import InputError
from drystone.io.outlines_in.svg import read_svg
from drystone.io.read_stones import ReadSettings
from tests.io.test_svg_view import bounds


@pytest.mark.parametrize(
    ("sheet", "body", "box"),
    [
        ("r:60px", '<circle class="s" cx="80" cy="90" r="10"/>', [20, 30, 120, 120]),
        ("cx:5px; CY: 1in; r: 10mm", '<circle class="s" cx="80" r="10"/>',
         [5 - 960 / 25.4, 96 - 960 / 25.4, 1920 / 25.4, 1920 / 25.4]),
        ("x:160px;y:60px;width:90px;height:50px", '<rect class="s" width="1" height="1"/>',
         [160, 60, 90, 50]),
        ("x:0;width:50%", '<rect class="s" x="9" width="7" height="8"/>', [0, 0, 100, 8]),
        ("rx:9px", '<ellipse class="s" rx="5" ry="4"/>', [-9, -4, 18, 8]),
        ("rx:auto", '<ellipse class="s" rx="5" ry="9"/>', [-9, -9, 18, 18]),
        ("ry:unset;cx:initial", '<ellipse class="s" cx="8" rx="5" ry="9"/>', [-5, -5, 10, 10]),
        ('d:path("M5 0 H45 v30 Z")', '<path class="s" d="M0 0H1V1Z"/>', [5, 0, 40, 30]),
        ("D: PATH( 'm5 0 h10 v10 z' )", '<path class="s"/>', [5, 0, 10, 10]),
        ("x:100px;y:50px", '<defs><rect id="a" width="7" height="8"/></defs>'
         '<use class="s" href="#a" x="5" y="5"/>', [100, 50, 7, 8]),
        # What shows a shape is not the shape: its properties are its own.
        ("x:100px;y:50px", '<use href="#a" x="9"/><defs><rect id="a" class="s" width="7" '
         'height="8"/></defs>', [109, 50, 7, 8]),
    ],
)  # fmt: skip
def test_svg_geometry_by_css_comes_before_attributes(sheet, body, box):
    (found,), said = bounds(f"<style>.s{{{sheet}}}</style>{body}")
    assert found == pytest.approx(box, abs=1e-6)
    assert said == ""


@pytest.mark.parametrize(
    "body",
    [
        '<rect style="r:60px;cx:9px;d:path(\'M0 0H1V1Z\')" width="7" height="8"/>',
        '<path style="x:5px;width:calc(1px);rx:10%" d="M0 0H7V8H0z"/>',
        '<polygon style="x:5px;width:var(--w)" points="0 0 7 0 7 8 0 8"/>',
        '<g style="x:5px;y:5;width:1em"><rect width="7" height="8"/></g>',
        '<rect style="stroke-width:5;--x:5;max-width:1em" width="7" height="8"/>',
        '<g style="display:none"><rect style="x:calc(1px)" width="9" height="9"/></g>'
        '<rect width="7" height="8"/>',
        '<defs><rect id="a" width="7" height="8"/></defs><use style="width:99px;r:5px" href="#a"/>',
    ],
)
def test_svg_geometry_does_nothing_where_it_does_not_apply(body):
    assert bounds(body)[0] == [[0, 0, 7, 8]]


def test_svg_shapes_of_no_size_by_their_style_are_left_aside():
    body = """<rect style="width:auto" width="7" height="8"/><path style="d:none" d="M0 0H1V1Z"/>
      <circle style="r:0" r="5"/><path style="d:path('')" d="M0 0H1V1Z"/>"""
    boxes, said = bounds(body)
    assert boxes == []
    assert "1 circle without an area, 1 rect without an area" in said


def test_svg_rules_on_geometry_that_are_not_read_are_named():
    sheet = "@media (min-width:1px){rect{width:9px}} circle:is(.a){R:3px} text:is(.a){fill:red}"
    sheet += "@media print{.r:hover, #d:hover{fill:red}}"
    boxes, said = bounds(f'<style>{sheet}</style><rect width="7" height="8"/>')
    assert boxes == [[0, 0, 7, 8]]
    assert "were not read: @media (min-width:1px), circle:is(.a)." in said


@pytest.mark.parametrize(
    ("kind", "style", "why"),
    [
        ("circle", "r:calc(1px + 2px)", "the CSS property r: 'calc"),
        ("circle", "r:10%", "r in %"),
        ("circle", "r:5", "the CSS property r: 5 in CSS has no unit"),
        ("circle", "r:auto", "the CSS property r: 'auto' is no length"),
        ("rect", "x:var(--left)", "the CSS property x: 'var"),
        ("rect", "width:5 px", "the CSS property width: '5 px' is no length"),
        ("rect", "width:-5px", "the CSS property width is below 0"),
        ("rect", "height:2em", "height in em is not read"),
        ("rect", "x:inherit", "'inherit' is no length"),
        ("ellipse", "ry:revert-layer", "'revert-layer' is no length"),
        ("path", "d:path(evenodd, 'M0 0H1V1Z')", "the CSS property d is read as path"),
        ("path", "d:path('M0 0 x')", "no number"),
        ("use", "x:calc(1px)", "the CSS property x: 'calc"),
    ],
)
def test_svg_geometry_that_is_not_understood_is_refused(kind, style, why):
    body = f'<rect id="a" width="7" height="8"/><{kind} id="s" href="#a" style="{style}"/>'
    with pytest.raises(InputError, match=rf"E114 .*the {kind} 's' cannot be used \(.*{why}"):
        bounds(body)


@pytest.mark.parametrize("style", ["width:100px", "height:50%", "x:7px", "y:1mm"])
def test_svg_viewports_of_another_size_by_their_style_are_refused(style):
    """By SVG 2 they are of that size; Chromium keeps to the attributes."""
    rect = '<rect width="8" height="4"/>'
    inner = f'<svg id="s" width="20" height="20" style="{style}">{rect}</svg>'
    why = r"cannot be used \(the CSS property \w+ is not read here, only the attribute"
    with pytest.raises(InputError, match=f"E114 .*the svg 's' {why}"):
        bounds(inner)
    symbol = f'<symbol id="t" style="{style}">{rect}</symbol>'
    with pytest.raises(InputError, match=f"E114 .*the symbol 't' {why}"):
        bounds(f'{symbol}<use href="#t" width="9" height="9"/>')


def test_svg_viewports_of_which_style_and_attributes_say_the_same():
    same = "width:100%;height:20px;x:0"
    rect = '<rect width="50%" height="4"/>'
    assert bounds(f'<svg height="20" style="{same}">{rect}</svg>')[0] == [[0, 0, 100, 4]]
    used = f'<symbol id="t">{rect}</symbol><use id="s" href="#t" width="20" style="width:WIDE"/>'
    assert bounds(used.replace("WIDE", "20px"))[0] == [[0, 0, 10, 4]]
    for other in ("21px", "auto", "20mm"):
        with pytest.raises(InputError, match=r"E114 .*the use 's' .*property width"):
            bounds(used.replace("WIDE", other))


def page(attributes):
    text = f'<svg viewBox="0 0 200 100" {attributes}><rect width="8" height="4"/></svg>'
    found = read_svg(text.encode(), "a.svg", ReadSettings())
    return found.unit_m, float(found.stones[0].areas[0].rings[0].max())


def test_svg_pages_have_their_size_by_style():
    paper = 'width="200mm" height="100mm"'
    assert page(paper) == (0.001, 8)
    assert page(f'{paper} style="width:100mm; height:50mm; x:9px"') == (0.001, 4)
    assert page('style="width:20cm; height:10cm"') == (0.01, 0.8)
    assert page('style="width:100%; height:auto"') == page("") == (None, 8)
    assert page('width="400" height="200" style="width:200px;height:100px"') == (None, 8)


@pytest.mark.parametrize("style", ["width:100%;height:auto", "width:auto", "max-width:100%"])
def test_svg_pages_are_no_larger_for_the_window_that_shows_them(style):
    for size in ('width="100mm" height="50mm"', 'width="400" height="200"', ""):
        assert page(f'{size} style="{style}"') == page(size)


@pytest.mark.parametrize(
    ("size", "style", "why"),
    [
        ("200mm", "400px", "its width is 200mm, and 400px by its style"),
        ("400", "5em", "its width and height are in units"),
    ],
)
def test_svg_pages_of_two_sizes_are_refused(size, style, why):
    with pytest.raises(InputError, match=rf"E114 .*the element svg cannot be used \({why}"):
        page(f'width="{size}" height="{size}" style="width:{style}; height:{style}"')
