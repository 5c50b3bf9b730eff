"""The page of SVG by hand: viewBox, preserveAspectRatio, per cents; drawings in it are refused."""

import numpy as np
import pytest

from drystone.errors import InputError
from drystone.io.outlines_in.svg import read_svg
from drystone.io.read_stones import ReadSettings

RECT = '<rect x="1" y="1" width="8" height="4"/>'


def bounds(body, page='width="200mm" height="100mm" viewBox="0 0 200 100"'):
    """Boxes around all that is read of a drawing: left, top, width, height; and what is said."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>'
    found = read_svg(text.encode(), ReadSettings())
    rings = [np.concatenate(stone.areas[0].rings) for stone in found.stones]
    boxes = [[*ring.min(axis=0), *np.ptp(ring, axis=0)] for ring in rings]
    return np.array(boxes).round(9).tolist(), " ".join(n.message for n in found.notices)


@pytest.mark.parametrize(
    ("ratio", "box"),
    [("", [12, 2, 16, 8]), ("xMidYMid meet", [12, 2, 16, 8]), (" none ", [4, 2, 32, 8])],
)
def test_a_box_lies_in_the_middle_of_the_page_unless_it_is_stretched(ratio, box):
    page = f'width="40mm" height="20mm" viewBox="0 0 10 10" preserveAspectRatio="{ratio}"'
    assert bounds(RECT, page)[0] == [box]
    shifted = page.replace("0 0 10 10", "-5 3 10 10")
    moved = [box[0] + 5 * box[2] / 8, box[1] - 3 * box[3] / 4, *box[2:]]
    np.testing.assert_allclose(bounds(RECT, shifted)[0], [moved])


def test_per_cents_are_of_the_page_and_of_nothing_else():
    assert bounds('<rect x="10%" y="1%" width="25%" height="50%"/>')[0] == [[20, 1, 50, 50]]
    boxes, said = bounds(f'<rect width="100%" height="100%"/>{RECT}')
    assert boxes == [[1, 1, 8, 4]]
    assert "1 rectangles over the whole page" in said
    with pytest.raises(InputError, match=r"E114 .*x in % is not read"):
        bounds('<rect x="3%" width="8" height="4"/>', "")


@pytest.mark.parametrize(
    ("body", "page"),
    [
        (f"<svg>{RECT}</svg>", ""),
        (f'<symbol id="s">{RECT}</symbol><use href="#s"/>', ""),
        (RECT, 'width="40mm" height="20mm" viewBox="0 0 1 1" preserveAspectRatio="xMinYMax"'),
    ],
)
def test_what_few_drawings_have_is_refused(body, page):
    with pytest.raises(InputError, match=r"E114 .*Save it as plain SVG"):
        bounds(body, page)
    assert bounds(f'<symbol id="s">{RECT}</symbol>{RECT}')[0] == [[1, 1, 8, 4]]
