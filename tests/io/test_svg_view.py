"""Viewports of SVG by hand: viewBox, preserveAspectRatio, and what per cents are of."""

import numpy as np
import pytest

from drystone.errors import InputError
from drystone.io.outlines_in.svg import read_svg
from drystone.io.read_stones import ReadSettings


def bounds(body, page='width="200mm" height="100mm" viewBox="0 0 200 100"'):
    """Boxes around all that is read of a drawing: left, top, width, height; and what is said."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>'
    found = read_svg(text.encode(), ReadSettings())
    rings = [np.concatenate(stone.areas[0].rings) for stone in found.stones]
    boxes = [[*ring.min(axis=0), *np.ptp(ring, axis=0)] for ring in rings]
    return np.array(boxes).round(9).tolist(), " ".join(n.message for n in found.notices)


def test_svg_viewports_of_symbols_and_inner_drawings():
    body = """
      <symbol id="s" viewBox="0 0 10 10"><rect x="1" y="1" width="4" height="2"/></symbol>
      <rect x="10" y="10" width="40" height="20"/>
      <use href="#s" x="100" width="100" height="100"/>
      <svg x="100" y="50" width="50" height="50" viewBox="0 0 10 10">
        <rect x="1" y="1" width="8" height="4"/></svg>
    """
    assert bounds(body)[0] == [[10, 10, 40, 20], [110, 10, 40, 20], [105, 55, 40, 20]]


@pytest.mark.parametrize(
    ("body", "box"),
    [
        # A use says how large an inner drawing is, and it stays where it says itself.
        ('<use href="#i" width="40" x="5"/>', [10 + 5 + 4, 2 + 5 + 4, 32, 16]),
        # What says no size fills what is around it: here the smaller side, in the middle.
        ('<use href="#s"/>', [50 + 10, 10, 80, 40]),
        ('<use href="#t" width="auto"/>', [4 + 2, 2 + 4, 16, 8]),
        ('<use href="#s" x="25%" width="10mm" height="1e9"/>', None),
        ('<svg width="50%" height="50%"><use href="#s" x="10%"/></svg>', [10 + 25 + 5, 5, 40, 20]),
        ('<svg width="50%"><rect x="10%" width="20%" height="20%"/></svg>', [10, 0, 20, 20]),
        ('<svg viewBox="0 0 20 10"><rect x="10%" width="50%" height="50%"/></svg>',
         [20, 0, 100, 50]),
        ('<svg viewBox="5 5 20 10" transform="scale(.5)"><rect x="7" y="7" width="8" height="4"/>'
         "</svg>", [10, 10, 40, 20]),
    ],
)  # fmt: skip
def test_svg_sizes_of_viewports(body, box):
    defined = """<defs><symbol id="s" viewBox="0 0 10 10"><rect id="r" x="1" y="1" width="8"
      height="4"/></symbol><symbol id="t" x="4" y="2" viewBox="0 0 10 10" width="20" height="24">
      <use href="#r"/></symbol><svg id="i" x="10" y="7" width="1" height="40" viewBox="0 0 10 10">
      <use href="#r"/></svg></defs>"""
    if box is None:  # 10 mm are 10 / 25.4 x 96 user units, whatever the page makes of them
        wide = 10 / 25.4 * 96
        box = [50 + wide / 10, 1e9 / 2 - wide / 2 + wide / 10, 0.8 * wide, 0.4 * wide]
    np.testing.assert_allclose(bounds(defined + body)[0], [box], atol=1e-6)


@pytest.mark.parametrize(
    ("ratio", "box"),
    [
        ("", [112, 52, 16, 8]),
        ("xMidYMid meet", [112, 52, 16, 8]),
        ("none", [104, 52, 32, 8]),
        ("none slice", [104, 52, 32, 8]),
        ("xMinYMax", [102, 52, 16, 8]),
        ("xMaxYMin meet", [122, 52, 16, 8]),
        ("xMinYMid slice", [104, 44, 32, 16]),
        (" xMidYMin  slice ", [104, 54, 32, 16]),
        ("defer xMaxYMax slice", [104, 34, 32, 16]),
    ],
)
def test_svg_preserves_the_aspect_ratio_as_it_is_told(ratio, box):
    told = f'viewBox="0 0 10 10" preserveAspectRatio="{ratio}" overflow="visible"'
    rect = '<rect x="1" y="1" width="8" height="4"/>'
    inner = f'<svg x="100" y="50" width="40" height="20" {told}>{rect}</svg>'
    assert bounds(inner)[0] == [box]
    symbol = f'<symbol id="s" {told}>{rect}</symbol>'
    assert bounds(f'{symbol}<use href="#s" x="100" y="50" width="40" height="20"/>')[0] == [box]
    root = bounds(rect, f'width="40mm" height="20mm" {told}')[0]
    np.testing.assert_allclose(root, [[box[0] - 100, box[1] - 50, *box[2:]]])


def test_svg_viewports_of_no_size_and_of_unknown_pages():
    stone = '<rect width="8" height="4"/>'
    boxes, said = bounds(f'<svg width="0">{stone}</svg>{stone}')
    assert boxes == [[0, 0, 8, 4]]
    assert "1 elements that are hidden" in said
    assert bounds(f'<svg x="3">{stone}</svg>', "")[0] == [[3, 0, 8, 4]]
    for body in (f'<svg viewBox="0 0 1 1">{stone}</svg>', f'<svg x="3%">{stone}</svg>'):
        with pytest.raises(InputError, match=r"E114 .*a svg .* in %"):
            bounds(body, "")
