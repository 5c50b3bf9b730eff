"""The block model beside a plan of outlines is compared with its poses."""

import numpy as np
import pytest

from drystone.verify.blocks import check_blocks
from drystone.verify.check import check_plan
from drystone.verify.claims import wall_model
from drystone.verify.replay import replay_plan
from tests.verify.exact_examples import block_model, exact_example
from tests.verify.examples import SLAB, WEDGE, example
from tests.verify.tampering import moved, step_of


@pytest.fixture(scope="module")
def true():
    return exact_example(0.5, 200.0)


@pytest.fixture(scope="module")
def found(true):
    """What is said of a block model beside the plan, whose wall is built again once."""
    replay = replay_plan(true.plan, true.stones)
    model = wall_model(replay.wall, replay.settings)
    return lambda blocks: [*check_blocks(blocks, true.plan, replay, model)]


def block(blocks, its_id):
    return next(one for one in blocks["blocks"] if one["id"] == its_id)


def contact(blocks):
    """That of the first pillar with the slab."""
    return next(one for one in blocks["interfaces"] if set(one["between"]) == {3, SLAB})


def turned(blocks, _unit):
    """Turn the L by 180 degrees about the middle of its box, which moves its outline by px."""
    corners = np.array(block(blocks, 12)["polygon"])
    block(blocks, 12)["polygon"] = (corners.min(axis=0) + corners.max(axis=0) - corners).tolist()


def shifted(blocks, unit):
    block(blocks, WEDGE)["polygon"][0][0] -= 0.02 * unit


def moved_contact(blocks, unit):
    contact(blocks)["points"][0][0] += 0.02 * unit


def other_id(blocks, _):
    block(blocks, 300)["id"] = 400
    blocks["interfaces"] = [i for i in blocks["interfaces"] if 300 not in i["between"]]


NO_MODEL = ["blocks.json is not a block model"]
WAYS = {
    "turned": (turned, ["outline of stone 12 in blocks.json is "]),
    "shifted": (shifted, [f"outline of wedge {WEDGE} in blocks.json is 0.02 source px"]),
    "another id": (
        other_id,
        ["has a block 400", "contacts between the ground and 300", "stone 300 is not in"],
    ),
    "heavy": (lambda b, _: block(b, 3).update(density=2.0), ["fixed or held in blocks.json: 3."]),
    "held": (lambda b, _: block(b, 3).update(held=["turn"]), ["fixed or held in blocks.json: 3."]),
    "friction": (lambda b, _: b.update(mu=0.7), ["friction in blocks.json is not mu = 0.58"]),
    "friction of a pair": (
        lambda b, _: b.update(friction=[{"between": [3, 0], "mu": 0.9}]),
        ["friction in blocks.json is not mu = 0.58"],
    ),
    "a contact less": (
        lambda b, _: b["interfaces"].remove(contact(b)),
        [f"contacts between 3 and {SLAB} in"],
    ),
    "another place": (moved_contact, [f"contacts between 3 and {SLAB} in"]),
    "another normal": (
        lambda b, _: contact(b).update(normal=[-x for x in contact(b)["normal"]]),
        [f"contacts between 3 and {SLAB} in"],
    ),
    "doubled": (lambda b, _: b["interfaces"].append(b["interfaces"][0]), ["contacts between "]),
    "nothing": (lambda b, _: b.clear(), NO_MODEL),
    "a number": (lambda b, _: b.update(blocks=1), NO_MODEL),
    "half a block": (lambda b, _: b.update(blocks=[{"id": 1}]), NO_MODEL),
}


@pytest.mark.parametrize(("tamper", "said"), WAYS.values(), ids=WAYS)
def test_another_block_model_is_named(true, found, tamper, said):
    blocks = block_model(true)
    tamper(blocks, 1.0 / true.plan.px_per_m)
    problems = found(blocks)
    assert {problem.code for problem in problems} == {"E238"}
    if tamper is turned:
        assert [problem.step for problem in problems] == [step_of(true.plan, 12).step]
    for words in said:
        assert any(words in problem.message for problem in problems), words


def test_the_same_in_other_words_is_the_same(true, found):
    assert {problem.code for content in (3, []) for problem in found(content)} == {"E238"}
    blocks = block_model(true)
    blocks["blocks"].reverse()
    blocks["interfaces"].reverse()
    for one in blocks["blocks"]:
        one["polygon"] = [*one["polygon"][2:], *one["polygon"][:2]]
    for one in blocks["interfaces"]:
        one["points"].reverse()
        if 0 not in one["between"]:
            one["between"].reverse()
            one["normal"] = [-x for x in one["normal"]]
    assert found(blocks) == []


def test_outlines_are_compared_where_the_wall_cannot_be_built(true):
    blocks = block_model(true)
    turned(blocks, 1.0)
    plan = moved(true.plan, SLAB, 0, -3.0 / true.plan.px_per_m)
    report = check_plan(plan, true.stones, blocks=blocks)
    said = [problem.message.split()[4] for problem in report.problems if problem.code == "E238"]
    assert said == [str(SLAB), "12"]
    # That there is none is said of outlines alone.
    on_pixels = example()
    for made, noted in ((true, True), (on_pixels, False)):
        notes = check_plan(made.plan, made.stones).notes
        assert any("There is no blocks.json to compare" in note for note in notes) is noted
    assert check_plan(on_pixels.plan, on_pixels.stones, blocks={"blocks": []}).ok
