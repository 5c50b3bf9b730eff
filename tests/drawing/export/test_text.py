"""Numbers and JSON on the way out; words that fit the typeface and the room."""

import json

import numpy as np
import pytest
import yaml
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath

from drystone.drawing.lettering import ELLIPSIS, MISSING, drawable, fitted, one_line
from drystone.io.json_text import json_text, number


def test_json_is_json_of_any_shape():
    value = {
        "empty": {}, "none": None, "list": [], "text": "µm", "true": True,
        "matrix": np.eye(4), "deep": [{"a": [1, 2]}, {"b": {"c": (1.5,)}}],
        "long": {f"name {i}": "x" * 40 for i in range(20)},
    }  # fmt: skip
    text = json_text(value)
    expected = {**value, "matrix": np.eye(4).tolist(), "deep": [{"a": [1, 2]}, {"b": {"c": [1.5]}}]}
    assert json.loads(text) == expected
    assert max(map(len, text.splitlines())) < 340
    assert ' "matrix": [[1.0, 0.0, 0.0, 0.0], [0.0' in text
    for bad in (float("nan"), float("inf"), [1.0, float("nan")]):
        with pytest.raises(ValueError, match="JSON compliant"):
            json_text({"a": bad})


def test_numbers_are_floats_for_every_reader():
    for value in (0.0, -0.0, 1e-5, 1.25e-7, 1e300, -3.0, 0.1, 123456789.123456789):
        found = yaml.safe_load(number(value))
        assert type(found) is float
        assert found == value == float(number(value))
        assert not number(value + 0.0).startswith("-0.0")


def test_a_line_is_one_line_and_letters_that_the_typeface_lacks_are_boxes():
    assert one_line("a\nb\tc\x01d\u2028e\ud800f") == "a b c d e f"
    assert one_line("<é 漢>") == "<é 漢>"
    assert drawable("Mäuer → 漢字\n") == f"Mäuer → {MISSING}{MISSING} "


@pytest.mark.parametrize("weight", ["normal", "bold"])
@pytest.mark.parametrize("text", [300 * "W", 300 * "i", "dry stone " * 30])
def test_what_is_too_wide_is_cut_and_no_more(text, weight):
    """Matplotlib's own outlines of the letters are what is drawn."""
    said = fitted(text, 9.5, 180.0, bold=weight == "bold")
    assert said.endswith(ELLIPSIS)
    assert text.startswith(said[:-1])
    typeface = FontProperties(family="DejaVu Sans", weight=weight)
    width = TextPath((0, 0), said, size=9.5, prop=typeface).get_extents().x1
    assert 165.0 < width <= 181.0
    assert fitted("Build sheet", 9.5, 180.0) == "Build sheet"
    assert fitted("", 9.5, 0.0) == ""
