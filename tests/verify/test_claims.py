"""What a rigid-body engine says against a plan."""

from dataclasses import replace

import pytest

from drystone.contacts.settled import model_of_outlines
from drystone.physics.building import BlockMove, BuildUp, build_up, tilt_of
from drystone.physics.scatter import TiltResult
from drystone.physics.tilt import TiltTrial
from drystone.statics.limit import lateral_resistance
from drystone.verify.claims import check_engine, claimed_alpha
from tests.polygons import box
from tests.verify.exact_examples import exact_example
from tests.verify.examples import SLAB, WEDGE

PLAN = exact_example().plan
IDS = [step.stone for step in PLAN.stone_steps]


def claiming(left, right, **without):
    none = dict.fromkeys(("F_LR_coulomb", "alpha_left_coulomb", "alpha_right_coulomb"))
    claims = none | {"alpha_left": left, "alpha_right": right} | without
    return replace(PLAN, metrics=replace(PLAN.metrics, **claims))


def built(*fallen, first_fall=None):
    moves = [BlockMove(i, 9.0, 0.3, 0.0, 0.0, i in fallen) for i in IDS]
    moves.insert(3, BlockMove(WEDGE, 9.0, 0.3, 0.0, 0.0, WEDGE in fallen))
    return BuildUp(tuple(moves), {}, (0.0,) * len(IDS), (), first_fall, 0.58)


def tilts(left, right, resolution=0.001, **trial):
    return tuple(
        TiltResult(side, (TiltTrial(alpha, None, 0.0, resolution, **trial),))
        for side, alpha in (("left", left), ("right", right))
    )


def codes(problems):
    return [problem.code for problem in problems]


def test_blocks_that_fall_are_named_with_the_step():
    (problem,) = check_engine(PLAN, built(SLAB, WEDGE, first_fall=3), None)
    assert (problem.code, problem.step) == ("E241", PLAN.stone_steps[2].step)
    assert f"stone {SLAB}, wedge {WEDGE}." in problem.message


def test_a_tilt_below_the_claim_is_named():
    for plan, found, said in (
        (claiming(0.5, 0.4), (0.425, 0.34), []),
        (claiming(0.5, 0.4), (0.42, 0.34), ["left"]),
        (claiming(0.5, 0.4), (0.425, 0.33), ["right"]),
        (claiming(0.5, 0.4), (None, None), []),
        (claiming(None, 0.4), (0.1, 0.4), []),
        # Without dilatancy plans may claim less of a side.
        (claiming(0.5, 0.4, alpha_left_coulomb=0.2), (0.171, 0.341), []),
        (claiming(0.5, 0.4, alpha_left_coulomb=0.2), (0.171, 0.171), ["right"]),
        (claiming(0.5, 0.4, alpha_right_coulomb=0.2), (0.171, 0.16), ["left", "right"]),
        (claiming(0.5, 0.4, F_LR_coulomb=0.0), (0.01, 0.01), []),
    ):
        problems = check_engine(plan, built(), tilts(*found))
        assert [(p.code, p.message.split()[3]) for p in problems] == [("E242", s) for s in said]


def test_the_resolution_of_the_tilt_is_no_contradiction_and_what_falls_at_rest_carries_nothing():
    for resolution, named in ((0.1, 0), (0.02, 2)):
        found = tilts(0.4, 0.4, resolution=resolution)
        assert codes(check_engine(claiming(0.5, 0.5), built(), found)) == ["E242"] * named
    problems = check_engine(claiming(0.5, 0.4), built(), tilts(None, None, fell_at_rest=True))
    assert codes(problems) == ["E242"] * 2
    assert "alpha = 0.000 in the engine, 0% of the 0.500" in problems[0].message


def test_a_stack_that_claims_full_interlock_is_found_out():
    """Bricks in a stack tip at width over height, whatever a plan claims of them."""
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    bricks = [(IDS[k], box(0.0, k * 20.0, 20.0, (k + 1) * 20.0)) for k in range(2)]
    stack = build_up([[brick] for brick in bricks], 0.9)
    assert stack.stands
    tilted = tilt_of(stack)
    honest = lateral_resistance(model_of_outlines(bricks, 0.9))
    assert honest.left.alpha == pytest.approx(0.5, rel=0.05)
    claimed = claiming(honest.left.alpha, honest.right.alpha)
    assert check_engine(claimed, stack, tilted) == []
    assert codes(check_engine(claiming(0.9, 0.9), stack, tilted)) == ["E242"] * 2
    assert claimed_alpha(claimed, "left") == honest.left.alpha
