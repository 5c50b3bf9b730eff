"""Curves of path data against closed forms."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone.io.outlines_in.svg_shapes import subpaths, transform


def area(data):
    return sum(shapely.Polygon(line.points).area for line in subpaths(data))


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("m 1 1 h4 v3 h-4 z m 10 0 h4 v3 h-4 z", 24.0),  # z comes back to where it began
        ("M10 10 A5 5 0 0 1 20 10 A5 5 0 0 1 10 10Z", math.pi * 25),
        ("M0 0 A10 5 0 1 0 20 0 Z", math.pi * 25),  # half an ellipse of 10 and 5
        ("M0,0A10,10,0,1,1,10,10L10,0Z", 0.75 * math.pi * 100),  # the large arc, with its corner
        ("M0 0 A1 1 0 0 1 20 0 Z", math.pi * 50),  # radii that cannot reach grow
        ("M0 0a10 10 0 0120 0z", math.pi * 50),  # flags without spaces
        ("M0 0 C 0 10 10 10 10 0 Z", 60.0),  # three fifths of the box of its handles
        ("M0 0 Q 5 10 10 0 Z", 100 / 3),  # two thirds of base times half the handle
        ("M0 0 q 5 10 10 0 t 10 0 V 0 Z", None),
        ("M0 0.5.5.5.5 1e0-.5 1z", None),
    ],
)
def test_areas_by_closed_forms(data, expected):
    if expected is None:
        assert subpaths(data)[0].closed
        return
    assert area(data) == pytest.approx(expected, rel=3e-4)


def test_smooth_curves_mirror_their_handles():
    whole = subpaths("M0 0 Q5 10 10 0 Q15 -10 20 0 Q25 10 30 0")[0].points
    np.testing.assert_allclose(subpaths("M0 0 Q5 10 10 0 T20 0 T30 0")[0].points, whole)
    cubic = subpaths("M0 0 C1 5 6 7 10 0 C14 -7 15 3 20 0")[0].points
    np.testing.assert_allclose(subpaths("M0 0 C1 5 6 7 10 0 S15 3 20 0")[0].points, cubic)
    np.testing.assert_allclose(subpaths("m0 0c1 5 6 7 10 0s5 3 10 0")[0].points, cubic)
    # After another command there is nothing to mirror: the handle is where the pen is.
    straight = subpaths("M0 0 L5 5 T10 5")[0].points
    assert straight[:, 1].max() == 5.0
    np.testing.assert_allclose(subpaths("M0 0 L5 5 S8 9 10 5")[0].points,
                               subpaths("M0 0 L5 5 C5 5 8 9 10 5")[0].points)  # fmt: skip


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
    (x0, y0), middle, (x1, y1) = known
    large, sweep = int(sweep_deg > 180), int(forwards)
    data = f"M{x0!r} {y0!r}A{rx!r} {ry!r} {turn_deg!r} {large} {sweep} {x1!r} {y1!r}".replace(
        "np.float64(", ""
    ).replace(")", "")
    points = subpaths(data)[0].points
    local = (points - (7.0, -3.0)) @ matrix / (rx, ry)
    if 175 < sweep_deg < 185:  # where the arc is half the ellipse the centre hardly matters
        np.testing.assert_allclose(np.hypot(*local.T), 1.0, atol=0.2)
    else:
        np.testing.assert_allclose(np.hypot(*local.T), 1.0, atol=1e-5)
        assert np.hypot(*(points - middle).T).min() <= 0.03 * max(rx, ry)


def test_closed_and_open_lines():
    lines = subpaths("M0 0 L4 0 4 4 M10 10 L14 10 14 14 10 10 M0 9 l1 0 0 1z")
    assert [line.closed for line in lines] == [False, True, True]
    assert len(lines[1].points) == 3


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ("L1 1", "not with a move"),
        ("M1", "not a multiple of 2"),
        ("M1 1 L1 x", "'x' is not a number"),
        ("M1 1 z 4", "numbers after z"),
        ("M0 0 A1 1 0 2 0 3 3", "not a number"),
    ],
)
def test_damaged_path_data(data, text):
    with pytest.raises(ValueError, match=text):
        subpaths(data)


@pytest.mark.parametrize(
    ("text", "point"),
    [
        ("", (3, 4)),
        ("translate(5 6)", (8, 10)),
        ("scale(2,-1)", (6, -4)),
        ("rotate(90, 3, 5)", (4, 5)),
        ("skewX(45)", (7, 4)),
        ("skewY(45)", (3, 7)),
        ("matrix(1 2 3 4 5 6)", (3 + 12 + 5, 6 + 16 + 6)),
        ("translate(10,0) rotate(90)", (6, 3)),
    ],
)
def test_transforms(text, point):
    np.testing.assert_allclose((transform(text) @ (3, 4, 1))[:2], point, atol=1e-12)


@pytest.mark.parametrize("text", ["spin(3)", "rotate(1 2)", "matrix(1)", "translate 4", "scale(a)"])
def test_damaged_transforms(text):
    with pytest.raises(ValueError, match=r"transform|convert"):
        transform(text)
