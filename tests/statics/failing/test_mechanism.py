from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.statics.failing import mechanism as failing
from drystone.statics.failing.mechanism import Names, Toe, describe_mechanism, in_words
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from drystone.statics.result import LimitStatus, Mechanism
from tests.naive.statics import contact_matrices
from tests.statics.walls import boxes, coursed, irregular, limit_load
from tests.strategies import repeatable


def told(model, direction="right", **options):
    result = limit_load(model, direction, mechanism=True)
    falls = result.status is LimitStatus.UNSTABLE
    return describe_mechanism(model, result.mechanism, falls=falls, **options)


def moved(velocity, *rows):
    """Describe velocities made by hand, by block id, of boxes."""
    mechanism = Mechanism(tuple(velocity), np.array(list(velocity.values()), float))
    return describe_mechanism(boxes(*rows), mechanism)


def centre(group):
    """The point about which a body turns."""
    vx, vy, turning = group.velocity
    return group.centroid[0] - vy / turning, group.centroid[1] + vx / turning


@pytest.mark.parametrize(
    ("rows", "on", "said", "feet"),
    [
        ([[0, 0, 20, 40]], GROUND, "", {"left": (0.0, 0.0), "right": (20.0, 0.0)}),
        # The upper block has the lower id: the normal points into the other one.
        ([[2, 1, 1, 2], [0, 0, 6, 1]], 2, ", on 2", {"left": (2.0, 1.0), "right": (3.0, 1.0)}),
    ],
)
@pytest.mark.parametrize("direction", ["left", "right"])
def test_a_tall_block_rocks_about_its_toe(rows, on, said, feet, direction):
    failure = told(boxes(*rows), direction)
    assert failure.words == f"Rocking of block 1 about its {direction} toe{said}."
    (group,) = failure.groups
    assert (group.motion, group.blocks, group.against) == ("rocking", (1,), (on,))
    assert group.toe == Toe(feet[direction], 1, on, direction)
    assert centre(group) == pytest.approx(feet[direction], abs=1e-9)
    if on == GROUND:
        kinds = ("opening", "closed") if direction == "right" else ("closed", "opening")
        assert failure.contact_kinds == kinds


def sliding_at(*speeds):
    """Velocities of blocks from 1 on that slide on their beds."""
    return {block: np.array([1, 0.58, 0]) * speed for block, speed in enumerate(speeds, 1)}


TURNS_AND_SLIDES = {1: (1, 0.58 * (1 - 0.02 * 20) + 0.02 * 5, -0.02)}
"""The toe (10, 0) of a block 10 x 40 is 5 right of and 20 below its centroid; it rises by mu times
its slip."""
BACK = (1 - 0.58**2) / (1 + 0.58**2)
TOWER, STAIR = [[0, 0, 10, 40], [0, 40, 10, 10]], [[0, 0, 3, 1], [0, 1, 1, 1], [1, 1, 1, 1]]
APART = [[0, 0, 1, 1], [5, 0, 2, 1], [9, 0, 3, 1]]


@pytest.mark.parametrize(
    ("rows", "velocity", "words"),
    [
        (  # The upper one turns with the lower about its toe, and slides on it.
            TOWER,
            {1: (2.0, -0.5, -0.1), 2: (4.5 + 1, -0.5 + 0.58, -0.1)},
            "Rocking of block 1 about its right toe; block 2 slides on 1.",
        ),
        (TOWER[:1], TURNS_AND_SLIDES, "Rocking and sliding of block 1 on the ground."),
        (TOWER[:1], {1: (0.1, 1, 0)}, "Loosening of block 1."),
        # Blocks that creep stand still, slow ones are left out of the words.
        (APART, sliding_at(1, 5e-3, 5e-5), "Sliding of block 1 on the ground."),
        (TOWER[:1], {1: (0, 0, 0)}, "Nothing moves."),
        (  # It turns about the upper end of its joint with a block that stands still.
            [[0, 0, 1, 4], [1, 0, 1, 2]],
            {2: (0.1, -0.05 + 0.1, 0.1)},
            "Rocking of block 2 about the point where it touches 1.",
        ),
        # A stone that leaves a still neighbour and slides on a still bed slides on the bed.
        (STAIR, {3: (0.58, 1, 0)}, "Sliding of block 3 along 2."),
        (STAIR, {3: (1, 0.58, 0)}, "Sliding of block 3 on 1."),
        (  # Block 3 slides back on block 2, which slides away, and up along block 1.
            [[0, 0, 1, 3], [1, 0, 2, 1], [1, 1, 1, 1]],
            {2: (1, 0.58, 0), 3: (1 - BACK, 0.58 * (1 + BACK), 0)},
            "Sliding of block 2 on the ground; block 3 slides on 2.",
        ),
        (
            [[0, 0, 4, 1], [1, 1, 1, 2]],
            {1: (1, 0.58, 0), 2: (1.1, 0.58 + 0.05, -0.1)},
            "Sliding of block 1 on the ground; block 2 rocks about its right toe, on 1.",
        ),
    ],
)
def test_motions_in_words(rows, velocity, words):
    assert moved(velocity, *rows).words == words


def test_a_lintel_rocks_on_two_posts_and_slides_only_where_a_joint_does():
    """Posts of 4 and of 3, the shorter one on a block that stays."""
    portal = boxes([0, 0, 1, 4], [4, 1, 1, 3], [0, 4, 5, 1], [4, 0, 2, 1], mu=0.9)
    failure = told(portal)
    assert failure.words == (
        "Rocking of block 3 on 1 and 2; block 1 rocks about its right toe; block 2 rocks about its"
        " right toe, on 4."
    )
    assert not any("sliding" in kind for kind in failure.contact_kinds)
    (lintel,) = [group for group in failure.groups if group.blocks == (3,)]
    assert (lintel.motion, lintel.slips) == ("mixed", False)


@pytest.mark.parametrize(
    ("upper", "mu", "words"),
    [
        ([12, 20, 20, 20], 0.9, "Falls by itself: stone 2 tips about its right toe, on wedge 1."),
        ([30, 40, 20, 20], 0.58, "Falls by itself: stone 2 falls."),
        ([0, 20, 20, 20], 0.65, "Rocking of stone 2 and wedge 1 about the right toe of wedge 1."),
    ],
)
def test_falls_and_wedges_in_words(upper, mu, words):
    model = boxes([0, 0, 20, 20], upper, mu=mu)
    assert told(model, names=Names("stone", frozenset({1}))).words == words


def test_a_bed_comes_before_a_moving_side_that_it_turns_on():
    """The upper end of the joint of two pillars stays closed; the right one drags its left toe."""
    failure = moved({1: (0.6, 0.58, 0), 2: (0.8, 0.63, 0.1)}, [0, 0, 1, 4], [1, 0, 1, 4])
    (group,) = [group for group in failure.groups if group.blocks == (2,)]
    assert (group.motion, group.against, group.on_bed) == ("mixed", (GROUND,), True)


@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_a_flat_block_slides_although_the_flow_rule_lifts_it(speed):
    failure = moved({1: (speed, 0.58, 0)}, [0, 0, 40, 20])
    assert failure.contact_kinds == ("sliding", "sliding")
    (group,) = failure.groups
    assert (group.motion, group.toe, group.velocity[2], group.on_bed) == ("sliding", None, 0, True)


def test_largest_momentum_comes_first_and_what_creeps_does_not_move():
    groups = moved(sliding_at(1.0, 0.9, 0.1), *APART).groups
    assert [group.blocks for group in groups] == [(2,), (1,), (3,)]
    groups = moved(sliding_at(1.0, 5e-3, 5e-5), *APART).groups
    assert [group.blocks for group in groups] == [(1,), (2,)]


def test_blocks_that_turn_about_a_shared_point_are_not_one_body():
    """The joint between two pillars shears; a contact at a point holds no angle."""
    pillars = told(boxes([0, 0, 1, 4], [1, 0, 1, 4]))
    assert sorted(group.blocks for group in pillars.groups) == [(1,), (2,)]
    stack = boxes([0, 0, 1, 1], [0, 1, 1, 1])
    floor, joint = stack.interfaces
    point = replace(stack, interfaces=(floor, replace(joint, points=np.array([[0.5, 1.0]]))))
    turns = Mechanism((1, 2), np.array([[1, 0.58, 0], [1.05, 0.58, -0.1]]))
    failure = describe_mechanism(point, turns)
    assert sorted(group.blocks for group in failure.groups) == [(1,), (2,)]


def test_turning_about_the_centroid_moves_and_rest_does_not_and_other_walls_are_refused():
    block = [0, 0, 20, 40]
    assert [group.blocks for group in moved({1: (0, 0, 1)}, block).groups] == [(1,)]
    failure = moved({1: (0, 0, 0)}, block)
    assert (failure.groups, failure.contact_kinds) == ((), ("closed", "closed"))
    with pytest.raises(ValueError, match=r"lacks: \[7\]"):
        moved({7: (0, 0, 0)}, block)


@given(seed=st.integers(0, 10**6), tilted=st.booleans())
@repeatable(12)
def test_the_parts_of_a_description_fit_together(seed, tilted):
    labels = irregular(seed, 14, 90, 50) if tilted else coursed(seed, 4, 90, seed % 3)
    model = model_from_labels(labels).model
    both = lateral_resistance(model, mechanism=True)
    for mechanism in (both.left.mechanism, both.right.mechanism):
        failure = describe_mechanism(model, mechanism)
        rates = [part.T @ mechanism.velocity.ravel() for part in contact_matrices(model)]
        found = failing.kinematics(model, mechanism).relative
        np.testing.assert_allclose(found, np.column_stack(rates), atol=1e-12)
        grouped = [block for group in failure.groups for block in group.blocks]
        assert len(set(grouped)) == len(grouped)
        velocity = dict(zip(mechanism.block_ids, mechanism.velocity, strict=True))
        centroid = {block.id: np.array(block.centroid) for block in model.blocks}
        for group in failure.groups:
            for block in group.blocks:
                arm = centroid[block] - group.centroid
                vx, vy, turning = group.velocity
                rigid = (vx - turning * arm[1], vy + turning * arm[0])
                assert velocity[block][:2] == pytest.approx(rigid, abs=1e-3)
            if group.toe is not None and group.toe.other not in grouped:
                assert centre(group) == pytest.approx(group.toe.point, abs=0.05)


# In words alone.


def rocking(*blocks, toe, on, side="right"):
    point = Toe((0.0, 0.0), toe, on, side)
    return failing.MovingGroup(
        blocks, "rocking", (1, 0, -1), (0, 1), 1.0, 1.0, point, (on,), True, False
    )


def sliding(*blocks, on=(), on_bed=True, motion="sliding", turning=0.0, slips=True):
    velocity = (1.0, 0.58, turning)
    return failing.MovingGroup(blocks, motion, velocity, (0, 1), 1.0, 1.0, None, on, on_bed, slips)


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
    assert Names("stone", frozenset({300, 301})).listed(ids) == words


def test_bodies_that_move_alike_share_a_clause_and_four_are_spelled_out():
    sides = ((1, "left"), (2, "left"), (3, "right"))
    groups = [rocking(k, toe=k, on=GROUND, side=side) for k, side in sides]
    assert in_words(groups, Names()) == (
        "Rocking of blocks 1 and 2, each about its left toe; block 3 rocks about its right toe."
    )
    groups = [sliding(block, on=(block + 10,)) for block in range(1, 8)]
    for count, more in ((7, " 3 others move with them."), (5, " 1 other moves with them.")):
        words = in_words(groups[:count], Names())
        assert words.endswith(f"; block 4 slides on 14;{more}")
    assert in_words(groups[:4], Names()).endswith("; block 4 slides on 14.")


@pytest.mark.parametrize(
    ("group", "noun", "who", "falls", "where"),
    [
        (sliding(2, 4, on=(1,), on_bed=False), "Sliding", "blocks 2 and 4", "slide", " along 1"),
        (
            sliding(2, on=(1,), motion="mixed", turning=0.1),
            *("Rocking and sliding", "block 2", "rocks and slides", " on 1"),
        ),
        (  # On two bodies that both turn, and slipping on neither.
            sliding(2, on=(1, 3), motion="mixed", turning=0.1, slips=False),
            *("Rocking", "block 2", "tips", " on 1 and 3"),
        ),
        (
            sliding(2, 4, on=(1, 3), motion="mixed", turning=0.1, on_bed=False, slips=False),
            *("Rocking", "blocks 2 and 4", "tip", " between 1 and 3"),
        ),
        (sliding(2, on=(1, 3), motion="mixed"), "Shifting", "block 2", "shifts", " on 1 and 3"),
        (sliding(2, motion="mixed"), "Loosening", "block 2", "comes loose", ""),
        (sliding(2, motion="falling"), "Fall", "block 2", "falls", ""),
        (
            rocking(2, 5, toe=2, on=1, side=None),
            *("Rocking", "blocks 2 and 5", "tip", " about the point where 2 meets 1"),
        ),
    ],
)
def test_every_motion_as_noun_and_as_fall(group, noun, who, falls, where):
    assert in_words([group], Names()) == f"{noun} of {who}{where}."
    assert in_words([group], Names(), falls=True) == f"Falls by itself: {who} {falls}{where}."
