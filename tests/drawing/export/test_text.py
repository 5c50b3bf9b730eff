"""Numbers and JSON on the way out."""

import json

import numpy as np
import pytest
import yaml

from drystone.drawing.export.text import json_text, number


def test_json_is_json_of_any_shape() -> None:
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


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), [1.0, float("nan")]])
def test_what_json_does_not_have_is_refused(bad: object) -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        json_text({"a": bad})


@pytest.mark.parametrize("value", [0.0, -0.0, 1e-5, 1.25e-7, 1e300, -3.0, 0.1, 123456789.123456789])
def test_numbers_are_floats_for_every_reader(value: float) -> None:
    found = yaml.safe_load(number(value))
    assert type(found) is float
    assert found == value == float(number(value))
    assert not number(value + 0.0).startswith("-0.0")
