import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.statics.failing.mechanism import Names, describe_mechanism, kinematics
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from drystone.statics.result import LimitStatus, Mechanism
from tests.statics.walls import boxes, coursed, irregular, limit_load
from tests.strategies import repeatable

BLOCK = boxes([0, 0, 20, 40])


def told(model, direction="right", **options):
    result = limit_load(model, direction, mechanism=True)
    falls = result.status is LimitStatus.UNSTABLE
    return describe_mechanism(model, result.mechanism, falls=falls, **options)


def moved(model, rows):
    """Describe velocities made by hand, by block id."""
    mechanism = Mechanism(tuple(rows), np.array(list(rows.values()), float))
    return describe_mechanism(model, mechanism)


def centre(group):
    """Return the point about which a body turns."""
    vx, vy, turning = group.velocity
    return group.centroid[0] - vy / turning, group.centroid[1] + vx / turning


@pytest.mark.parametrize(("direction", "toe_x"), [("left", 0.0), ("right", 20.0)])
def test_a_tall_block_rocks_about_its_toe(direction, toe_x):
    failure = told(BLOCK, direction)
    assert failure.words == f"Rocking of block 1 about its {direction} toe."
    (group,) = failure.groups
    assert (group.motion, group.blocks, group.against) == ("rocking", (1,), (GROUND,))
    assert group.toe.point == (toe_x, 0.0)
    assert (group.toe.block, group.toe.other, group.toe.side) == (1, GROUND, direction)
    assert centre(group) == pytest.approx((toe_x, 0.0), abs=1e-9)
    kinds = ("opening", "closed") if direction == "right" else ("closed", "opening")
    assert failure.contact_kinds == kinds


@pytest.mark.parametrize("direction", ["left", "right"])
def test_a_flat_block_slides_although_the_flow_rule_lifts_it(direction):
    failure = told(boxes([0, 0, 40, 20]), direction, names=Names("stone"))
    assert failure.words == "Sliding of stone 1 on the ground."
    assert failure.contact_kinds == ("sliding", "sliding")
    (group,) = failure.groups
    assert (group.motion, group.toe, group.velocity[2], group.on_bed) == ("sliding", None, 0, True)


SLIP = 1 - 0.02 * 20
"""Of the toe (10, 0) of a block 10 x 40, 5 right of and 20 below its centroid, that turns by -.02;
it rises by mu times its slip."""
BACK = (1 - 0.58**2) / (1 + 0.58**2)
TOWER, STAIR = [[0, 0, 10, 40], [0, 40, 10, 10]], [[0, 0, 3, 1], [0, 1, 1, 1], [1, 1, 1, 1]]


@pytest.mark.parametrize(
    ("rows", "velocity", "words"),
    [
        (  # The upper one turns with the lower about its toe, and slides on it.
            TOWER,
            {1: (2.0, -0.5, -0.1), 2: (4.5 + 1, -0.5 + 0.58, -0.1)},
            "Rocking of block 1 about its right toe; block 2 slides on 1.",
        ),
        (
            TOWER[:1],
            {1: (1, 0.58 * SLIP + 0.02 * 5, -0.02)},
            "Rocking and sliding of block 1 on the ground.",
        ),
        (TOWER[:1], {1: (0.1, 1, 0)}, "Loosening of block 1."),
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
    assert moved(boxes(*rows), velocity).words == words


@pytest.mark.parametrize(
    ("upper", "mu", "words"),
    [
        ([12, 20, 20, 20], 0.9, "Falls by itself: stone 2 tips about its right toe, on wedge 1."),
        ([30, 40, 20, 20], 0.58, "Falls by itself: stone 2 falls."),
        (
            [0, 20, 20, 20],
            0.65,
            "Rocking of stone 2 and wedge 1 about the right toe of wedge 1.",
        ),
    ],
)
def test_falls_and_wedges_in_words(upper, mu, words):
    model = boxes([0, 0, 20, 20], upper, mu=mu)
    assert told(model, names=Names("stone", frozenset({1}))).words == words


@pytest.mark.parametrize("direction", ["left", "right"])
def test_it_does_not_matter_which_block_the_normal_points_into(direction):
    rows = [[2, 1, 1, 2], [0, 0, 6, 1]]  # the upper block has the lower id
    failure = told(boxes(*rows), direction)
    assert failure.words == f"Rocking of block 1 about its {direction} toe, on 2."
    toe = failure.groups[0].toe
    assert (toe.point, toe.other) == ((3.0 if direction == "right" else 2.0, 1.0), 2)


def test_a_bridging_stone_is_carried_by_two_rocking_pillars():
    failure = told(boxes([0, 0, 2, 4], [8, 0, 2, 4], [0, 4, 10, 2]))
    assert failure.words == (
        "Shifting of block 3 on 1 and 2; blocks 1 and 2 rock, each about its right toe."
    )
    assert failure.groups[0].against == (1, 2)


def test_a_bed_comes_before_a_moving_side_that_it_turns_on():
    """The upper end of the joint of two pillars stays closed; the right one drags its left toe."""
    model = boxes([0, 0, 1, 4], [1, 0, 1, 4])
    failure = moved(model, {1: (0.6, 0.58, 0), 2: (0.8, 0.63, 0.1)})
    (group,) = [group for group in failure.groups if group.blocks == (2,)]
    assert (group.motion, group.against, group.on_bed) == ("mixed", (GROUND,), True)


def test_largest_momentum_comes_first():
    rows = [[0, 0, 1, 1], [5, 0, 2, 1], [9, 0, 3, 1]]
    model = boxes(*rows)
    slides = {i: np.array([1, 0.58, 0]) * speed for i, speed in ((1, 1.0), (2, 0.9), (3, 0.1))}
    assert [group.blocks for group in moved(model, slides).groups] == [(2,), (1,), (3,)]


def test_creeping_blocks_stand_still_and_slow_ones_are_left_out_of_the_words():
    rows = [[0, 0, 1, 1], [5, 0, 1, 1], [9, 0, 1, 1]]
    model = boxes(*rows)
    slides = {i: np.array([1, 0.58, 0]) * speed for i, speed in ((1, 1.0), (2, 5e-3), (3, 5e-5))}
    failure = moved(model, slides)
    assert failure.moving == (1, 2)
    assert failure.words == "Sliding of block 1 on the ground."


def test_blocks_that_turn_about_a_shared_point_are_not_one_body():
    """The joint between two pillars shears; a contact at a point holds no angle."""
    pillars = told(boxes([0, 0, 1, 4], [1, 0, 1, 4]))
    assert sorted(group.blocks for group in pillars.groups) == [(1,), (2,)]
    point = model_from_json(
        {
            "blocks_xywh": [[0, 0, 1, 1], [0, 1, 1, 1]],
            "interfaces": [
                {"between": [1, 0], "points": [[0, 0], [1, 0]], "normal": [0, 1]},
                {"between": [2, 1], "points": [[0.5, 1]], "normal": [0, 1]},
            ],
        }
    )
    failure = moved(point, {1: (1, 0.58, 0), 2: (1.05, 0.58, -0.1)})
    assert sorted(group.blocks for group in failure.groups) == [(1,), (2,)]


def test_turning_about_the_centroid_moves_and_rest_does_not_and_other_walls_are_refused():
    assert moved(BLOCK, {1: (0, 0, 1)}).moving == (1,)
    failure = moved(BLOCK, {1: (0, 0, 0)})
    assert (failure.moving, failure.groups, failure.words) == ((), (), "Nothing moves.")
    assert failure.contact_kinds == ("closed", "closed")
    with pytest.raises(ValueError, match=r"lacks: \[7\]"):
        moved(BLOCK, {7: (0, 0, 0)})


def naive_contacts(model, mechanism):
    """Velocity of the first block against the second at every point, one at a time."""
    velocity = dict(zip(mechanism.block_ids, mechanism.velocity.tolist(), strict=True))
    centroid = {block.id: block.centroid for block in model.blocks} | {GROUND: (0.0, 0.0)}

    def at(block, x, y):
        vx, vy, turning = velocity.get(block, (0.0, 0.0, 0.0))
        cx, cy = centroid[block]
        return vx - turning * (y - cy), vy + turning * (x - cx)

    for interface in model.interfaces:
        nx, ny = interface.normal
        for x, y in interface.points.tolist():
            first, second = at(interface.block, x, y), at(interface.other, x, y)
            dx, dy = first[0] - second[0], first[1] - second[1]
            yield dx * nx + dy * ny, dx * ny - dy * nx


@given(seed=st.integers(0, 10**6), tilted=st.booleans())
@repeatable(12)
def test_the_parts_of_a_description_fit_together(seed, tilted):
    labels = irregular(seed, 14, 90, 50) if tilted else coursed(seed, 4, 90, seed % 3)
    model = model_from_labels(labels).model
    both = lateral_resistance(model, mechanism=True)
    for result in (both.left, both.right):
        failure = describe_mechanism(model, result.mechanism)
        expected = np.array(list(naive_contacts(model, result.mechanism)))
        found = kinematics(model, result.mechanism).relative
        np.testing.assert_allclose(found, expected, atol=1e-12)
        grouped = [block for group in failure.groups for block in group.blocks]
        assert sorted(grouped) == sorted(failure.moving)
        assert len(set(grouped)) == len(grouped)
        velocity = dict(zip(result.mechanism.block_ids, result.mechanism.velocity, strict=True))
        centroid = {block.id: np.array(block.centroid) for block in model.blocks}
        for group in failure.groups:
            for block in group.blocks:
                arm = centroid[block] - group.centroid
                vx, vy, turning = group.velocity
                rigid = (vx - turning * arm[1], vy + turning * arm[0])
                assert velocity[block][:2] == pytest.approx(rigid, abs=1e-3)
            if group.toe is not None and group.toe.other not in grouped:
                assert centre(group) == pytest.approx(group.toe.point, abs=0.05)
