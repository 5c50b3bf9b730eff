"""Style sheets and style attributes of SVG: what they hide, move, and what is not read of them."""

import pytest

from drystone.errors import InputError
from drystone.io.outlines_in.svg import read_svg
from drystone.io.read_stones import ReadSettings
from tests.io.test_svg_view import bounds

STONE = '<rect class="h big" id="a" width="8" height="4"/>'


@pytest.mark.parametrize(
    ("sheet", "more"),
    [
        (".h{display:none}", ""),
        ("/* .x{} */ .x, rect.h.big { fill : red; Display: NONE !important }", ""),
        ("#a{visibility:hidden}", ""),
        ("g > .h{opacity:0}", ""),
        ("svg g .h{visibility:collapse}", ""),
        ("@charset 'utf-8'; @font-face{font-family:x}\nrect{opacity:0%}", ""),
        ("rect{display:inline} .h{display:none} *{display:inline}", ""),
        ("rect{display:none!important}", 'style="display:inline"'),
        ("", 'style="opacity:0.0"'),
        ("", 'opacity="0"'),
        ("", 'visibility="hidden"'),
    ],
)
def test_svg_that_is_hidden(sheet, more):
    style = "display: inline !important; opacity: 1"
    shown = f'<rect class="x" id="b" style="{style}" width="3" height="2"/>'
    hidden = STONE.replace("/>", f" {more}/>")
    boxes, said = bounds(f"<style>{sheet}</style><g>{hidden}</g>{shown}")
    assert boxes == [[0, 0, 3, 2]]
    assert "1 elements that are hidden" in said
    assert "not read" not in said


@pytest.mark.parametrize(
    "sheet",
    [
        "svg > .h{display:none}",  # there is a group between
        ".h .big{display:none} text{display:none} .other, #b{opacity:0}",
        ".h{display:none} #a{display:inline}",
        ".h{fill-opacity:0; opacity:.5} .h:hover{display:none}",
        ".h:hover:not(.x, .y){display:none}",
        "g{visibility:hidden} rect{visibility:visible}",
    ],
)
def test_svg_that_is_shown_for_all_its_style(sheet):
    boxes, said = bounds(f"<style><![CDATA[{sheet}]]></style><g>{STONE}</g>")
    assert boxes == [[0, 0, 8, 4]]
    assert said == ""


@pytest.mark.parametrize(
    ("sheet", "what"),
    [
        ("<style>rect:not(.b){display:none}</style>", "rect:not(.b)"),
        ("<style>rect:not(:hover){display:none}</style>", "rect:not(:hover)."),
        ("<style>.x:hover, .h:is(:hover, .big){opacity:0}</style>", ".h:is(:hover, .big)."),
        ("<style>@media print {.h{opacity:0}} @media print{.h{fill:red}}</style>", "@media print."),
        ("<style>@import url(a.css);</style>", "@import url(a.css)"),
        ('<style media="print">.h{display:none}</style>', "media print"),
        ("<style>[id=a]{transform:scale(2)}</style>", "[id=a]"),
    ],
)
def test_svg_says_what_of_its_style_sheets_is_not_read(sheet, what):
    boxes, said = bounds(sheet + STONE)
    assert boxes == [[0, 0, 8, 4]]
    assert f"may hide or move something were not read: {what}" in said


def test_svg_says_that_its_style_is_in_another_file():
    text = f'<?xml-stylesheet href="a.css"?><svg width="9" height="9">{STONE}</svg>'
    (notice,) = read_svg(text.encode(), "a.svg", ReadSettings()).notices
    assert "a style sheet in another file was not read" in notice.message


@pytest.mark.parametrize(
    ("more", "box"),
    [
        ('style="transform: translate(1in, 5px) scale(2)"', [96, 5, 16, 8]),
        ('style="transform: scale(50%)" transform="scale(9)"', [0, 0, 4, 2]),
        ('style="-webkit-transform: translateX(10%) translateY(10%)"', [20, 10, 8, 4]),
        ('style="transform: scaleX(2) scaleY(3) rotate(0)"', [0, 0, 16, 12]),
        ('style="transform: rotate(.25turn)"', [-4, 0, 4, 8]),
        ('style="transform: rotate(90deg); transform-origin: 8px 4px"', [8, -4, 4, 8]),
        ('style="transform-origin: bottom right" transform="rotate(180)"', [392, 196, 8, 4]),
        ('transform-origin="10 0" transform="scale(2)"', [-10, 0, 16, 8]),
        ('style="transform-origin: 5px" transform="scale(2)"', [-5, -50, 16, 8]),
        ('style="transform: skew(45deg)"', [0, 0, 12, 4]),
        ('style="transform: skewY(50grad) matrix(1, 0, 0, 1, 2, 0)"', [2, 2, 8, 12]),
        ('style="transform: none" transform="scale(2)"', [0, 0, 8, 4]),
        ('style="transform-box: fill-box"', [0, 0, 8, 4]),
        ('class="twice"', [0, 0, 16, 8]),
    ],
)
def test_svg_is_moved_by_its_style(more, box):
    sheet = "<style>.twice{transform:scale(2)}</style>"
    assert bounds(f'{sheet}<rect {more} width="8" height="4"/>')[0] == [box]
    assert bounds(f'<g {more}><rect width="8" height="4"/></g>{sheet}')[0] == [box]


@pytest.mark.parametrize(
    ("style", "why"),
    [
        ("transform: rotate(45)", "45 is no angle of CSS"),
        ("transform: translate(10)", "10 in CSS has no unit"),
        ("transform: rotateX(45deg)", "rotate"),
        ("transform: perspective(3px)", "the transform perspective of 1 values is not read"),
        ("transform: inherit", "'inherit' is no transform"),
        ("scale: 2", "the CSS property scale is not read"),
        ("transform: scale(2); transform-box: fill-box", "its transform-box is not read"),
        ("transform: scale(2); transform-origin: 5 5", "5 in CSS has no unit"),
    ],
)
def test_svg_styles_that_move_in_other_ways_are_refused(style, why):
    with pytest.raises(InputError, match=rf"E114 .*the rect 's' cannot be used \(.*{why}"):
        bounds(f'<rect id="s" style="{style}" width="8" height="4"/>')


@pytest.mark.parametrize(
    ("body", "left"),
    [
        # Around the copy there is neither what is around the original nor what shows it.
        ('<g>{a}</g><use href="#a" x="150"/>', [30, 150]),
        ('<defs>{a}</defs><g><use href="#a" x="150"/></g>', [150]),
        ('<g id="b">{a}</g><use href="#b" x="150"/>', [30, 180]),
        ('<g><g id="b"><use href="#a" x="50"/></g>{a}</g><use href="#b" x="150"/>', [50, 30, 200]),
        ('<symbol id="b"><g>{a}</g></symbol><g><use href="#b" x="150"/></g>', [180]),
        ('{a}<use href="#a" x="150"/>', [0, 150]),
    ],
)
def test_svg_selectors_see_no_more_than_what_a_use_shows(body, left):
    """As Chromium 150 shows it, and SVG 2, 5.6 says: the copies are a shadow tree."""
    sheet = "<style>g .a{transform:translate(30px,0px)}</style>"
    a = '<rect class="a" id="a" width="8" height="4"/>'
    assert [box[0] for box in bounds(sheet + body.format(a=a))[0]] == left
    # What is said of the thing itself is said of all its copies.
    everywhere = bounds(sheet.replace("g .a", ".a") + body.format(a=a))[0]
    assert [box[0] % 50 for box in everywhere] == [30] * len(left)


def test_svg_selectors_of_several_steps_end_at_what_a_use_shows():
    sheet = "<style>svg g .a{transform:translate(30px,0px)}</style>"
    group = '<g id="b"><rect class="a" width="8" height="4"/></g>'
    boxes, _ = bounds(f'{sheet}{group}<use href="#b" x="150"/>')
    assert [box[0] for box in boxes] == [30, 150]


def test_svg_copies_inherit_from_where_they_are_shown():
    sheet = "<style>.off{visibility:hidden} .odd{fill-rule:evenodd}</style>"
    path = '<path id="a" d="M0 0H9V9H0zM1 1H3V3H1z"/>'
    assert bounds(f'{sheet}<defs>{path}</defs><g class="off"><use href="#a"/></g>')[0] == []
    shown = f'{sheet}<defs><g class="off odd">{path}</g></defs><use href="#a"/>'
    assert bounds(shown)[0] == [[0, 0, 9, 9]]
    for classes, rule in (("odd", "evenodd"), ("", "nonzero")):
        text = f'<svg>{sheet}<defs>{path}</defs><g class="{classes}"><use href="#a"/></g></svg>'
        (stone,) = read_svg(text.encode(), "a.svg", ReadSettings()).stones
        assert stone.areas[0].rule == rule
