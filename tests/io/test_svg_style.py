"""What style hides and fills in SVG; what it would move or shape is refused."""

import pytest

from drystone.errors import InputError
from tests.io.test_svg_view import bounds

STONE = '<rect x="1" y="2" width="8" height="4"{}/>'
SEEN = [1, 2, 8, 4]


@pytest.mark.parametrize(
    "hidden",
    [
        ' display="none"', ' visibility="hidden"', ' opacity="0"', ' style="opacity:0%"',
        ' style="display : none"', ' style="visibility:collapse;fill:red"',
        ' fill="none"', ' style="fill:none;stroke:none"', ' fill="transparent"',
        ' class="a b"', ' id="c"', ' class="sheet"',
    ],
)  # fmt: skip
def test_what_nobody_sees_is_left_aside(hidden):
    sheet = """<style>/* rect{display:none} */ @font-face { font-family: f; src: url(f) }
        .b, #c { display: none } rect.sheet {visibility:hidden !important} text{fill:none}
        g > rect:hover { cursor: pointer }</style>"""
    boxes, said = bounds(sheet + STONE.format(hidden) + STONE.format(""))
    assert boxes == [SEEN]
    assert "1 elements that are hidden" in said


@pytest.mark.parametrize(
    ("sheet", "stone"),
    [
        # Later rules win among equals; ids win over classes, these over tags, these over all.
        ("*{display:none} rect{display:inline}", ""),
        ("#c{display:inline} rect.a{display:none}", ' id="c" class="a"'),
        (".a{opacity:0} .a{opacity:1}", ' class="a"'),
        ("rect{visibility:hidden}", ' style="visibility:visible"'),
        (".a{fill:none;stroke:#000}", ' class="a"'),
        ("rect{display:inline}", ' display="none"'),
        ("g{width:3px}", ""),
    ],
)
def test_the_rule_that_says_most_counts(sheet, stone):
    assert bounds(f"<style>{sheet}</style>{STONE.format(stone)}")[0] == [SEEN]


def test_paint_and_visibility_are_inherited_and_opacity_hides_a_group():
    group = '<g fill="none" visibility="hidden">{}</g>'
    seen = STONE.format(' fill="red" visibility="visible"')
    assert bounds(group.format(STONE.format("") + seen))[0] == [SEEN]
    assert bounds(f'<g opacity="0">{seen}</g>{seen}')[0] == [SEEN]


def test_a_fill_closes_lines_that_are_open():
    line = '<path d="M1 2h8v4h-8"{}/><polyline points="1 2 9 2 9 6 1 6"{}/>'
    assert bounds(line.format("", ""))[0] == [SEEN, SEEN]
    stroke = ' fill="none" stroke="red"'
    boxes, said = bounds(STONE.format("") + line.format(stroke, stroke))
    assert boxes == [SEEN]
    assert "1 open lines in path, 1 open lines in polyline" in said


def test_holes_are_those_of_the_fill_rule():
    path = '<path class="st0" d="M0 0h9v9h-9zM2 2h3v3h-3z"/>'
    assert bounds(f"<style>.st0{{fill-rule:evenodd;clip-rule:evenodd}}</style>{path}")[0]


@pytest.mark.parametrize(
    ("stone", "said"),
    [
        (' style="transform:scale(2)"', "says transform"),
        (' style="transform:none" transform="scale(2)"', "says transform"),
        (' style="-webkit-transform:scale(2)"', "says transform"),
        (' style="x:3px"', "says x"),
        (' style="width:30%"', "says width"),
        (' class="moved"', "says translate"),
        (' transform="scale(2)" style="transform-origin:5px 5px"', "transform-origin"),
    ],
)
def test_style_that_moves_or_shapes_is_refused(stone, said):
    sheet = "<style>.moved{translate:3px}</style>"
    with pytest.raises(InputError, match=rf"E114 .*a rect cannot be used .*{said}"):
        bounds(sheet + STONE.format(stone))


def test_the_style_of_the_page_says_how_a_window_shows_it():
    page = 'width="200mm" height="100mm" viewBox="0 0 200 100" style="width:100%;height:auto"'
    assert bounds(STONE.format(""), page)[0] == [SEEN]


@pytest.mark.parametrize(
    ("sheet", "said"),
    [
        ("<style>g rect{display:none}</style>", "'g rect'"),
        ("<style>rect:not(.b){visibility:hidden}</style>", "'rect:not"),
        ("<style>[id=a]{transform:scale(2)}</style>", "'.id=a.'"),
        ("<style>@media print {.h{opacity:0}}</style>", "'@media'"),
        ('<style media="print">.h{display:none}</style>', "'media print'"),
    ],
)
def test_rules_that_may_hide_something_are_read_or_refused(sheet, said):
    with pytest.raises(InputError, match=rf"E114 .*style sheet says .* for {said}.*plain SVG"):
        bounds(sheet + STONE.format(""))
