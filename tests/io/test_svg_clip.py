"""Clip paths of SVG in all the ways to say the same, against boxes worked out by hand."""

import numpy as np
import pytest

from drystone.errors import InputError
from drystone.io.outlines_in.silhouettes import region
from drystone.io.outlines_in.svg import read_svg
from drystone.io.read_stones import ReadSettings, read_stones

LEFT, MIDDLE, RIGHT = (
    f'<rect id="stone_{i}" x="{x}" y="10" width="40" height="40" {{0}}/>'
    for i, x in enumerate((0, 60, 120), start=1)
)
ALL = (LEFT + MIDDLE + RIGHT).format("")
CUT = {1: [0, 10, 40, 40], 2: [60, 10, 20, 40]}
"""What is there when all from x = 80 on is not: left, top, width, height."""


def boxes(body, page='width="200" height="100"', **settings):
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>'
    found = read_svg(text.encode(), ReadSettings(**settings))
    rings = {stone.id: np.concatenate(stone.areas[0].rings) for stone in found.stones}
    said = " ".join(notice.message for notice in found.notices)
    return {i: [*r.min(axis=0), *np.ptp(r, axis=0)] for i, r in rings.items()}, said


def clip(content, **attributes):
    more = " ".join(f'{name.replace("_", "-")}="{value}"' for name, value in attributes.items())
    return f'<defs><clipPath id="c" {more}>{content}</clipPath></defs>'


ON = f'<g clip-path="url(#c)">{ALL}</g>'
RECT = '<rect width="80" height="100"/>'
WAYS = {
    "group": clip(RECT) + ON,
    "each": clip(RECT) + (LEFT + MIDDLE + RIGHT).format('clip-path="url(#c)"'),
    "style": clip(RECT) + f"""<g style="clip-path: url('#c')">{ALL}</g>""",
    "sheet": clip(RECT) + f"<style>.k{{clip-path:url(#c)}}</style><g class='k'>{ALL}</g>",
    "after": f'<g clip-path="url( #c )">{ALL}</g>' + clip(RECT),
    "path": clip('<path d="M0 0H80V100H0"/>') + ON,
    "polygon": clip('<polygon points="0,0 80,0 80,99 0,99"/>') + ON,
    "two": clip('<rect width="50" height="99"/><rect x="40" width="40" height="99"/>')
    + ON,
    "moved": clip('<rect width="100" height="99" transform="scale(.5 1)"/>',
                  transform="scale(1.6 1)") + ON,
    "used": '<rect id="r" width="80" height="99" display="inline"/>'.join(["<defs>", "</defs>"])
    + clip('<use href="#r" x="0" y="0"/>') + ON,
    "hidden": clip(RECT + '<rect width="200" height="99" visibility="hidden"/>')
    + ON,
    "nested": clip(RECT + '<rect x="110" width="90" height="99"/>')
    + '<clipPath id="d"><rect width="109" height="99"/></clipPath>'
    + f'<g clip-path="url(#d)"><g clip-path="url(#c)">{ALL}</g></g>',
    "in its own units": clip('<rect width="40" height="50"/>')
    + '<g transform="scale(2)" clip-path="url(#c)">'
    + f'<g transform="scale(.5)">{ALL}</g></g>',
    "on a use": clip('<rect x="-20" width="80" height="100"/>')
    + f'<defs><g id="g" transform="translate(-20)">{ALL}</g></defs>'
    + '<use href="#g" x="20" clip-path="url(#c)"/>',
    "hole": clip('<path d="M0 0H200V100H0zM80 0H180V100H80z" clip-rule="evenodd"/>')
    + ON,
    "clipped itself": clip('<rect width="190" height="99"/>', clip_path="url(#d)")
    + '<clipPath id="d"><rect width="80" height="99"/></clipPath>' + ON,
}  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_what_is_outside_of_a_clip_is_not_there(way):
    found, said = boxes(WAYS[way])
    assert found == {i: pytest.approx(box) for i, box in CUT.items()}
    assert "outside of their clip paths, left out: stone_3." in said
    assert "cut by their clip paths: stone_2 (50 % is left)." in said


@pytest.mark.parametrize(
    "body",
    [
        clip('<rect width="190" height="99"/>') + ON,
        clip('<path d="M0 0H200V100H0zM50 0V100H55V0z"/>') + ON,
        clip(RECT) + f'<g clip-path="none">{ALL}</g>',
    ],
)
def test_what_is_within_a_clip_is_as_it_was(body):
    found, said = boxes(body)
    assert list(found) == [1, 2, 3]
    assert said == ""


def test_a_shape_within_a_clip_whose_box_is_not_is_as_it_was():
    round_clip = clip('<circle cx="50" cy="50" r="21"/>')
    circle = '<circle id="stone_1" cx="50" cy="50" r="20" clip-path="url(#c)"/>'
    assert boxes(round_clip + circle) == ({1: pytest.approx([30, 30, 40, 40])}, "")


def test_a_clip_that_is_not_there_cuts_nothing_and_is_named():
    found, said = boxes(f'<g clip-path="url(#nothing)">{ALL}</g>')
    assert list(found) == [1, 2, 3]
    assert "clip paths that are not there, so nothing was cut: nothing." in said


def test_an_empty_clip_leaves_nothing():
    assert boxes(clip("") + ON)[0] == {}


@pytest.mark.parametrize(
    ("body", "text"),
    [
        ('<mask id="m"/><g mask="url(#m)">{}</g>', "its mask is not read"),
        ('<g style="clip-path:circle(9px)">{}</g>', "its clip path 'circle"),
        ('<clipPath id="c"><text>a</text></clipPath><g clip-path="url(#c)">{}</g>', "a text in"),
        ('<clipPath id="c" clip-path="url(#c)"/><g clip-path="url(#c)">{}</g>', "too deeply"),
        ('<clipPath id="c" clipPathUnits="objectBoundingBox"/><g clip-path="url(#c)">{}</g>',
         "shares of its box.* release it"),
        ("<style>g > rect{{clip-path:url(#c)}}</style>{}", "style sheet says clip-path"),
    ],
)  # fmt: skip
def test_clips_of_other_kinds_are_refused(body, text):
    with pytest.raises(InputError, match=rf"E114 .*{text}"):
        boxes(body.format(ALL))


def test_clips_that_take_too_long_are_refused():
    rough = " ".join(f"{i % 200} {i * 7 % 100}" for i in range(3000))
    star = clip(f'<path d="M{rough}"/>')
    with pytest.raises(InputError, match=r"E114 .*cross themselves"):
        boxes(star + ON)
    fine = " ".join(f"{i / 100} {10 + i % 2}" for i in range(8000)) + " 80 99 0 99"
    with pytest.raises(InputError, match=r"E110 .*clip paths cut more than"):
        boxes(clip(f'<path d="M{fine}"/>') + f'<g clip-path="url(#c)">{ALL * 40}</g>')


@pytest.mark.parametrize(("rule", "area"), [("nonzero", 300.0), ("evenodd", 200.0)])
def test_regions_by_both_rules(rule, area):
    one = np.array([(0, 0), (20, 0), (20, 10), (0, 10)], float)
    other = one + np.array([10, 0])
    assert region([one, other], rule).area == area
    assert region([one, other[::-1]], rule).area == 200.0
    eight = np.array([(0, 0), (10, 10), (10, 0), (0, 10)], float)
    assert region([eight], rule).area == 50.0


@pytest.mark.parametrize("unit", ["mm", "cm", "m", "in", "ft", "px"])
@pytest.mark.parametrize("own", ["mm", "cm", "in", "pt", "pc", "q"])
def test_a_wrong_unit_of_a_drawing_is_corrected(tmp_path, own, unit):
    page = f'width="200{own}" height="100{own}" viewBox="0 0 400 200"'
    body = ALL.replace('id="', 'data-x="')
    (tmp_path / "s.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>')
    stones = read_stones(tmp_path / "s.svg", settings=ReadSettings(unit=unit))
    said = [n.message for n in stones.notices if "gives another unit" in n.message]
    assert len(said) == (own != unit)
    metres = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "ft": 0.3048}.get(unit)
    scale = stones.source.px_per_m
    if metres is None:
        assert (scale, stones.by_id(1).area_px) == (None, 1600)
        return
    shares = 0.5 if own == unit else 1.0  # of a unit, what a user unit is
    assert stones.by_id(1).area_px / scale**2 == pytest.approx(
        (40 * shares * metres) ** 2, rel=0.02
    )
