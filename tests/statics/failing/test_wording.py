import pytest

from drystone.statics.failing.mechanism import MovingGroup, Names, Toe, in_words
from drystone.statics.model import GROUND

STONES = Names("stone", frozenset({300, 301}))


def rocking(*blocks, toe, on, side="right", speed=1.0):
    point = Toe((0.0, 0.0), toe, on, side)
    return MovingGroup(blocks, "rocking", (1, 0, -1), (0, 1), 1.0, speed, point, (on,), True)


def sliding(*blocks, on, on_bed=True, motion="sliding", turning=0.0):
    velocity = (1.0, 0.58, turning)
    return MovingGroup(blocks, motion, velocity, (0, 1), 1.0, 1.0, None, on, on_bed)


@pytest.mark.parametrize(
    ("ids", "words"),
    [
        ([12, 7, 3], "stones 3, 7 and 12"),
        ([301, 3, 300], "stone 3, wedges 300 and 301"),
        ([1, 2, 3, 4, 5, 6], "stones 1, 2, 3, 4, 5 and 6"),
        ([7, 1, 2, 3, 4, 5, 6], "stones 1, 2, 3, 4, 5 ... and 2 more"),
        ([*range(1, 19), 300], "stones 1, 2, 3, 4, 5 ... and 14 more"),
    ],
)
def test_lists_of_stones(ids, words):
    assert STONES.listed(ids) == words


def test_bodies_that_move_alike_share_a_clause():
    groups = [
        rocking(k, toe=k, on=GROUND, side=s) for k, s in ((1, "left"), (2, "left"), (3, "right"))
    ]
    assert in_words(groups, Names()) == (
        "Rocking of blocks 1 and 2, each about its left toe; block 3 rocks about its right toe."
    )


def test_four_motions_are_spelled_out():
    groups = [sliding(block, on=(block + 10,)) for block in range(1, 8)]
    words = in_words(groups, Names())
    assert words.endswith("; block 4 slides on 14; 3 others move with them.")
    assert in_words(groups[:5], Names()).endswith("; 1 other moves with them.")
    assert in_words(groups[:4], Names()).endswith("; block 4 slides on 14.")


@pytest.mark.parametrize(
    ("group", "alone", "falling"),
    [
        (
            sliding(2, 4, on=(1,), on_bed=False),
            "Sliding of blocks 2 and 4 along 1.",
            "blocks 2 and 4 slide along 1.",
        ),
        (
            sliding(2, on=(1,), motion="mixed", turning=0.1),
            "Rocking and sliding of block 2 on 1.",
            "block 2 rocks and slides on 1.",
        ),
        (
            sliding(2, on=(1, 3), motion="mixed"),
            "Shifting of block 2 on 1 and 3.",
            "block 2 shifts on 1 and 3.",
        ),
        (sliding(2, on=(), motion="mixed"), "Loosening of block 2.", "block 2 comes loose."),
        (sliding(2, on=(), motion="falling"), "Fall of block 2.", "block 2 falls."),
        (
            rocking(2, 5, toe=2, on=1, side=None),
            "Rocking of blocks 2 and 5 about the point where 2 meets 1.",
            "blocks 2 and 5 tip about the point where 2 meets 1.",
        ),
    ],
)
def test_every_motion_as_noun_and_as_fall(group, alone, falling):
    assert in_words([group], Names()) == alone
    assert in_words([group], Names(), falls=True) == f"Falls by itself: {falling}"
