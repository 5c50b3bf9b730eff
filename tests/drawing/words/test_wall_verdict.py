"""What is said of a wall first, and of how wide the gaps are that are closed."""

import math

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.gaps import settle_gaps
from drystone.contacts.given import model_from_json
from drystone.drawing.words.analysis import ModelledWall, judge_wall
from drystone.drawing.words.modelling import ModelRequest, modelled
from drystone.io.walls import GivenWall
from drystone.statics.failing.mechanism import Names
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import LoadCase, Loads, point_load, weight
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from tests.contacts.test_gaps import bond

TALL, LOW = [[0, 0, 1, 2]], [[0, 0, 4, 1]]
LEANING = [[0, 0, 2, 1], [-0.5, 1, 2, 2], [10, 0, 2, 1], [10.5, 1, 2, 2]]
FLYING = [[0, 0, 2, 1], [0, 5, 1, 1], [4, 3, 1, 1]]


def judged(blocks, names=None, **more):
    model = model_from_json({"blocks_xywh": blocks, "mu": 0.6})
    wall = ModelledWall(model, np.ones((1, 1)), names or Names("stone", steps={1: 7}))
    return judge_wall("1 of 2 stones", wall, lateral_resistance(model, mechanism=True), **more)


@pytest.mark.parametrize(("blocks", "more", "stands", "words"), [
    # A block of 1 x 2 rocks at alpha = 1/2, atan(1/2) = 26.6 degrees.
    (TALL, {}, True, "stands; falls when tilted by 27 degrees; weakest place: stone 1 (step 7)"),
    (TALL, {"without_dilatancy": {"left": None, "right": 0.1}}, True,
     "stands; falls when tilted by 5.7 degrees; weakest place: stone 1 (step 7)"),
    # On the edge no load is needed, which is no fall by itself.
    (TALL, {"without_dilatancy": {"left": 0.0}}, True,
     "stands; falls when tilted by 0.0 degrees; weakest place: stone 1 (step 7)"),
    (TALL, {"can_fall": True}, False, "does not stand: let go, it can fall"),
    # The place is where the wall fails to the side of the least multiplier.
    (LEANING, {"without_dilatancy": {"left": 0.2}}, True,
     "stands; falls when tilted by 11 degrees; weakest place: stone 1 (step 7)"),
    (LEANING, {"without_dilatancy": {"right": 0.2}}, True,
     "stands; falls when tilted by 11 degrees; weakest place: stone 3"),
    # A low one slides at alpha = mu, atan(.6) = 31 degrees.
    (LOW, {}, True, "stands; falls when tilted by 31 degrees; weakest place: the joint with the "
     "ground"),
    (LOW, {"load_case": "growing with height"}, True, "stands; carries 0.600 times its own "
     "weight sideways (growing with height); weakest place: the joint with the ground"),
    (FLYING, {"names": Names()}, False, "does not stand: blocks 2 and 3 have nothing below that"),
    (FLYING[:2], {}, False, "does not stand: stone 2 has nothing below"),
    ([[0, 0, 2, 1], [1.5, 1, 4, 1]], {}, False,
     "does not stand: stone 2 rocks and slides on 1 (step 7)"),
])  # fmt: skip
def test_a_wall_is_judged_in_words(blocks, more, stands, words):
    found, said = judged(blocks, **more)
    assert found is stands
    assert said.startswith(f"1 of 2 stones, {words}")


@pytest.mark.parametrize(("force", "words"), [
    # At the corner (1, 2) of a block 1 x 2: 2 a = 2 / 2 about the right toe, 3 a about the left.
    ((1, -1), "0.500 times the live load (live); reversed, 0.333 times; weakest place: stone 1"),
    ((-1, 1), "0.333 times the live load (live); reversed, 0.500 times; weakest place: stone 1"),
    ((0, -1), "any multiple of the live load (live); reversed, 1.000 times"),
])  # fmt: skip
def test_a_load_that_is_not_sideways_counts_as_it_is_given(force, words):
    model = model_from_json({"blocks_xywh": TALL, "mu": 0.6})
    wall = ModelledWall(model, np.ones((1, 1)), Names("stone"))
    loads = Loads(weight(model), point_load(model, 1, (1.0, 2.0), force))
    both = lateral_resistance(model, loads, mechanism=True)
    without = {"left": both.left.alpha, "right": both.right.alpha or math.inf}
    said = judge_wall("1 stone", wall, both, load_case="live", without_dilatancy=without)
    assert said == (True, f"1 stone, stands; carries {words}")
    if force == (0, -1):
        without["right"] = None  # the search has failed
        _, said = judge_wall("1 stone", wall, both, load_case="live", without_dilatancy=without)
        assert "stands; no limit was found for the live load (live); reversed, 1.000" in said


def test_what_no_solver_could_answer_is_not_judged():
    failed = LimitResult(LimitStatus.FAILED, "left")
    wall = ModelledWall(model_from_json({"blocks_xywh": TALL}), np.ones((1, 1)), Names())
    stands, said = judge_wall("1 stone", wall, LateralResistance(failed, failed, 0.6))
    assert (stands, "no answer could be certified" in said) == (None, True)


def test_the_spread_says_what_the_reach_decides():
    def spread(labels, width, mu=None, live=()):
        case = LoadCase("points" if live else "tilting", 0.0, (), live, None)
        asked = ModelRequest(mu, None, "pixels", width, case)
        return modelled(GivenWall(labels), asked, "wall").remarks["gaps"].split("; ")[-1]

    labels = bond(6, 20, 38, 2)
    assert spread(labels, "2px") == (
        "F_LR .596 with gaps up to 2 px closed (unstable with gaps up to 1 px closed,"
        " .596 with gaps up to 4 px closed)"
    )
    settled, left, right = (
        lateral_resistance(model_from_labels(settle_gaps(labels, push)[0]).model).value
        for push in (None, "left", "right")
    )
    assert spread(labels, "settle") == (
        f"F_LR {settled:.3f} with stones settled ({left:.3f} with stones pushed left,"
        f" {right:.3f} with stones pushed right)"
    ).replace("0.", ".")
    # Up, a twentieth of the weight of both; down is without a limit.
    stack = np.kron([[1], [2]], np.ones((2, 8), int))
    for force, alpha in ("1.6", "20.000"), ("-1.6", "unbounded"):
        said = spread(stack, "2", live=(f"2@4,1:0,{force}",))
        assert said.startswith(f"alpha {alpha} with gaps up to 2 px closed")
    stack = np.kron([[1], [0], [2]], np.ones((2, 8), int))
    assert "F_LR not defined with gaps up to 2 px closed (unstable" in spread(stack, "2", (0, 0))
