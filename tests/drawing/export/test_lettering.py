"""Words that fit the typeface and the room."""

import pytest
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from drystone.drawing.lettering import ELLIPSIS, MISSING, drawable, fitted, one_line


def test_a_line_is_one_line() -> None:
    assert one_line("a\nb\tc\x01d\u2028e\ud800f") == "a b c d e f"
    assert one_line("<é 漢>") == "<é 漢>"


def test_letters_that_the_typeface_lacks_are_boxes() -> None:
    assert drawable("Mäuer → 漢字\n") == f"Mäuer → {MISSING}{MISSING} "


@pytest.mark.parametrize("weight", ["normal", "bold"])
@pytest.mark.parametrize("text", [300 * "W", 300 * "i", "dry stone " * 30])
def test_what_is_too_wide_is_cut_and_no_more(text, weight) -> None:
    """Matplotlib's own outlines of the letters are what is drawn."""
    said = fitted(text, 9.5, 180.0, bold=weight == "bold")
    assert said.endswith(ELLIPSIS)
    assert text.startswith(said[:-1])
    typeface = FontProperties(family="DejaVu Sans", weight=weight)
    width = TextPath((0, 0), said, size=9.5, prop=typeface).get_extents().x1
    assert 165.0 < width <= 181.0


def test_what_fits_stays() -> None:
    assert fitted("Build sheet", 9.5, 180.0) == "Build sheet"
    assert fitted("", 9.5, 0.0) == ""
