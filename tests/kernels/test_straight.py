"""Straight runs and their normals, against distances and angles in floats (§4.2)."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.kernels.contacts import SQUARED_TOLERANCE_PX, straight_runs
from tests.naive import contacts as naive
from tests.strategies import repeatable

STEPS = {"r": (1, 0), "u": (0, 1), "l": (-1, 0), "d": (0, -1)}


def path(word, start=(0, 0)):
    """Points (x, y) along a path of steps to the right, up, to the left, down."""
    return np.cumsum([start, *(STEPS[letter] for letter in word)], axis=0)


def runs_of(points):
    """First and last point and normal of each run, of points in the wall frame, y up."""
    x, y = np.array(points, np.int64).T
    return straight_runs(np.column_stack((-y, x)))


def normal_of(points):
    """The normal of what is one run."""
    ((_, _, normal),) = runs_of(points)
    return normal


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
    assert [(first, last) for first, last, _ in runs_of(points)] == list(pairwise(cuts))


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
    ((*ends, _),) = runs_of(path(word))
    assert tuple(ends) == kept


@given(word=words.filter(lambda word: not turns_back(word)))
@repeatable(200)
def test_runs_and_normals_are_those_by_angles(word):
    nodes = list(map(tuple, path(word, (3, -2)).tolist()))
    expected = [naive.without_hooks(piece) for piece in naive.split(nodes)]
    runs = runs_of(nodes)
    assert [nodes[first : last + 1] for first, last, _ in runs] == expected
    for (_, _, normal), run in zip(runs, expected, strict=True):
        assert normal == pytest.approx(naive.fitted_normal(run), abs=1e-12)
        assert math.hypot(*normal) == pytest.approx(1.0, abs=1e-15)
    assert naive.TOLERANCE_PX == math.sqrt(SQUARED_TOLERANCE_PX)


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
        assert list(map(repr, normal_of(path(word * count)))) == list(map(repr, normal))


@pytest.mark.parametrize("where", [(0, 0), (10**6, -(10**6))])
def test_long_runs_far_away_are_fitted_as_well(where):
    # The last edge is a hook.
    points = path("rrrrru" * 8000)[:-1]
    expected = naive.fitted_normal(list(map(tuple, points.tolist())))
    assert normal_of(path("rrrrru" * 8000, where)) == pytest.approx(expected, abs=1e-12)
    assert normal_of(path("r" * 100_000, where)) == (0.0, 1.0)
