"""Seats, towers of small stones, voids under corners, large wedges: on walls drawn by hand."""

import numpy as np
import pytest

from drystone.craft import Masonry
from tests.craft.walls import box, find
from tests.polygons import moved

FOOT = {1: box(0, 0, 2, 1), 2: box(2.6, 0, 2, 1)}
"""Two bricks with a gap between."""

KITE = np.array([[0.0, 0.0], [0.8, 1.0], [0.0, 1.2], [-0.8, 1.0]])
"""A stone with a point below."""


def wall(**stones):
    """The foot and stones named by letters, from 3 on."""
    return Masonry(FOOT | dict(enumerate(stones.values(), 3)))


def said(rule, masonry):
    finding = find(rule, masonry)
    return finding.number, [(case.stones, case.words) for case in finding.cases]


@pytest.mark.parametrize(("stone", "words"), [
    (moved(KITE, 1.0, 1.0), "rests on a point, 0.05 of its size wide"),
    # Down in the gap, between steep sides.
    (moved(KITE, 2.3, 0.63), "hangs between its neighbours, on no seat"),
    (box(3.9, 1, 2, 1), "its middle is 0.20 of its size beyond its seat"),
    (box(3.65, 1, 2, 1), "its middle is 0.03 of its size beyond its seat"),
    (box(3.5, 1, 2, 1), "its middle is only 0.06 of its size within its seat"),
    (box(3.2, 1, 2, 1), None),
    (box(1.3, 1, 2, 1), None),  # over the gap, on both
])  # fmt: skip
def test_a_stone_shall_sit(stone, words):
    number, cases = said("seats", wall(stone=stone))
    assert (number, [w for _, w in cases]) == ((0.0, []) if words is None else (1.0, [words]))


def test_small_stones_shall_not_make_a_tower():
    chips = [box(0.3, 1 + 0.3 * k, 0.5, 0.3) for k in range(3)]
    tower = said("towers", wall(a=chips[0], b=chips[1], c=chips[2]))
    assert tower == (3.0, [((3, 4, 5), "3 small stones on each other")])
    # Chips beside each other, or with a stone between, are no tower; nor is one that leans on a
    # large stone too.
    beside = wall(a=chips[0], b=chips[0] + [0.6, 0], c=box(0, 1.3, 2, 1), d=chips[0] + [0, 1.3])
    assert said("towers", beside) == (1.0, [])
    step = wall(a=chips[0], b=box(0.9, 1, 2, 0.3), c=box(0.5, 1.3, 0.7, 0.3))
    assert said("towers", step) == (1.0, [])


def test_no_corner_shall_hang_over_a_void():
    """The second brick reaches a third of its width out over its neighbour and the gap."""
    number, cases = said("voids", wall(stone=box(-0.7, 1, 2, 1)))
    assert number == pytest.approx(1 / 3)
    assert cases == [((3,), "nothing under its left corner, 0.35 of its width")]
    assert said("voids", wall(stone=box(-0.4, 1, 2, 1))) == (0.0, [])
    # A gap between two stones is under no corner, and a wedge fills.
    assert said("voids", wall(stone=box(1.3, 1, 2, 1))) == (0.0, [])
    loops = FOOT | {3: box(-0.7, 1, 2, 1), 9: box(-0.6, 0, 0.5, 1)}
    assert said("voids", Masonry(loops, wedge_ids={9}))[1] == []


def test_a_wedge_shall_be_a_chip():
    slope = np.array([[0.2, 1.0], [1.2, 1.5], [1.2, 1.6], [0.2, 1.6]])
    below = {1: np.array([[0.0, 0], [2.0, 0], [2.0, 1.9], [0.0, 0.9]]), 3: box(0, 1.9, 2, 1)}
    loops = below | {7: moved(slope, 0, 0.02)}
    number, cases = said("wedge_sizes", Masonry(loops, wedge_ids={7}))
    assert number == pytest.approx(0.35 / 2)
    assert cases == [((7, 3), "the wedge is 0.18 of the stone on it, on a slope of 27°")]
    chip = below | {7: box(0.2, 1.7, 0.3, 0.15)}
    assert said("wedge_sizes", Masonry(chip, wedge_ids={7})) == (pytest.approx(0.0225), [])
    assert find("wedge_sizes", Masonry(loops)).verdict == "not judged"
