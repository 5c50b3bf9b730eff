"""Straight runs and their normals, against distances and angles in floats (§4.2)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.straight import (
    SQUARED_TOLERANCE_PX,
    normal_beside,
    split_at_corners,
    straight_runs,
    without_hooks,
)
from tests.naive import contacts as naive
from tests.strategies import repeatable

STEPS = {"r": (1, 0), "u": (0, 1), "l": (-1, 0), "d": (0, -1)}


def path(word, start=(0, 0)):
    """x and y along a path of steps to the right, up, to the left, down."""
    nodes = np.cumsum([start, *(STEPS[letter] for letter in word)], axis=0)
    return nodes[:, 0].tolist(), nodes[:, 1].tolist()


# Mostly onwards, as boundaries go: no edge right back.
words = st.lists(st.sampled_from(["r", "ru", "rrr", "u", "rd", "ul", "lll", "d"]), min_size=1).map(
    "".join
)


def turns_back(word):
    return any(pair in word for pair in ("rl", "lr", "ud", "du"))


@pytest.mark.parametrize(
    ("points", "cuts"),
    [
        ([[0, 0], [9, 0]], [0, 1]),
        ([[0, 0], [5, 0], [9, 0]], [0, 2]),
        ([[0, 0], [5, 0], [5, 5]], [0, 1, 2]),
        ([[0, 0], [5, 0], [5, 1]], [0, 2]),
        ([[0, 0], [5, 0], [5, 5], [10, 5]], [0, 1, 2, 3]),
        ([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], [0, 2, 4]),
        ([[0, 0], [0, 2], [2, 2]], [0, 2]),  # sqrt 2 from the chord is not too far
        ([[0, 0], [0, 2], [3, 2]], [0, 1, 2]),
        ([[0, 0], [2, 3], [4, 3], [6, 0]], [0, 1, 3]),  # of two equals the first
    ],
)
def test_split_at_corners(points, cuts):
    x, y = zip(*points, strict=True)
    assert split_at_corners(x, y) == cuts


@given(word=words)
@repeatable(200)
def test_cuts_are_those_by_distances_in_floats(word):
    x, y = path(word)
    pieces = naive.split(list(zip(x, y, strict=True)))
    expected = np.cumsum([0, *(len(piece) - 1 for piece in pieces)]).tolist()
    assert split_at_corners(x, y) == expected
    assert naive.TOLERANCE_PX == math.sqrt(SQUARED_TOLERANCE_PX)


@pytest.mark.parametrize(
    ("word", "kept"),
    [
        ("rrru", (0, 3)),
        ("urrr", (1, 4)),
        ("urrru", (1, 4)),
        ("urru", (0, 4)),
        ("urdd", (0, 4)),
        ("urrrru", (1, 5)),
        ("rru", (0, 3)),
        ("rrurr", (0, 5)),
        ("ruruu", (0, 5)),
        ("uuur", (0, 3)),
        ("dlllld", (1, 5)),
    ],
)
def test_single_edges_that_turn_off_are_left_out(word, kept):
    x, y = path(word)
    assert without_hooks(x, y, 0, len(word)) == kept


@given(word=words.filter(lambda word: not turns_back(word)))
@repeatable(200)
def test_runs_and_normals_are_those_by_angles(word):
    x, y = path(word, (3, -2))
    nodes = list(zip(x, y, strict=True))
    expected = [naive.without_hooks(piece) for piece in naive.split(nodes)]
    runs = straight_runs(x, y)
    assert [nodes[first : last + 1] for first, last in runs] == expected
    for (first, last), run in zip(runs, expected, strict=True):
        normal = normal_beside(x, y, first, last)
        assert normal == pytest.approx(naive.fitted_normal(run), abs=1e-12)
        assert math.hypot(*normal) == pytest.approx(1.0, abs=1e-15)


@pytest.mark.parametrize(
    ("word", "normal"),
    [
        ("r", (0.0, 1.0)),
        ("llll", (0.0, -1.0)),
        ("u", (-1.0, 0.0)),
        ("dd", (1.0, 0.0)),
        ("rrurdrr", (0.0, 1.0)),  # a bump in the middle of a ledge
    ],
)
def test_normals_of_the_grid_are_exact_and_without_negative_zeros(word, normal):
    for count in (1, 50):
        x, y = path(word * count)
        assert list(map(repr, normal_beside(x, y, 0, len(x) - 1))) == list(map(repr, normal))


@pytest.mark.parametrize("word", ["ru", "ul", "ld", "dr", "rruu"])
@pytest.mark.parametrize("count", [1, 7, 400])
def test_normals_of_diagonals_have_components_of_one_size(word, count):
    x, y = path(word * count)
    normal_x, normal_y = normal_beside(x, y, 0, len(x) - 1)
    assert abs(normal_x) == abs(normal_y) == pytest.approx(0.5**0.5, abs=1e-15)


@pytest.mark.parametrize("where", [(0, 0), (10**6, -(10**6))])
def test_long_runs_far_away_are_fitted_as_well(where):
    x, y = path("rrrrru" * 8000)
    expected = naive.fitted_normal(list(zip(x, y, strict=True)))
    x, y = path("rrrrru" * 8000, where)
    assert normal_beside(x, y, 0, len(x) - 1) == pytest.approx(expected, abs=1e-12)
    x, y = path("r" * 100_000, where)
    assert normal_beside(x, y, 0, len(x) - 1) == (0.0, 1.0)
