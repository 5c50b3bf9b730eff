"""What an incremental answer tells needs a proof of its own: the end of alpha, and the fall."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.kernels.certificate import Figures
from drystone.statics import growing_large, growing_simplex
from drystone.statics.appending import units_of
from drystone.statics.contacts.given import model_from_json
from drystone.statics.ends import no_alpha, optimum, told
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.refined import RefinedSession
from tests.statics.growth import IMPLEMENTATIONS, implementation

PROVED = Figures(0.0, 0.0, 1.0, 1.0, 0.0, 1.0, -0.5)
"""Of alpha = -.5 to the right: the dead load does work of .5 on a mechanism without error."""


@pytest.mark.parametrize("sign", [1, -1])
def test_an_end_beyond_0_tells_the_fall(sign):
    found = optimum(PROVED._replace(live=float(sign)), -0.5 * sign, sign, "")
    assert found.alpha == -0.5 * sign
    assert found.falls.holds
    assert optimum(PROVED._replace(live=sign, rhs=0.5), 0.5 * sign, sign, "").falls is None


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("alpha", [-2e-9, -9e-9])
def test_no_end_where_the_end_is_proved_and_the_fall_is_not(sign, alpha):
    """The mechanism closes contacts faster than the dead load does work on it."""
    closing = PROVED._replace(live=float(sign), rhs=alpha, inadmissible=0.99e-8)
    assert optimum(closing, sign * alpha, sign, "") is None
    honest = closing._replace(inadmissible=1e-10)
    assert optimum(honest, sign * alpha, sign, "").falls.holds


@pytest.mark.parametrize(
    "error",
    [{"residual": 2e-8}, {"violation": 2e-8}, {"inadmissible": 2e-8}, {"rhs": -0.5 + 1e-7}],
)
def test_no_end_without_a_certificate(error):
    assert optimum(PROVED._replace(**error), -0.5, 1, "") is None


def test_no_alpha_needs_work_and_no_help_of_the_live_load():
    falling = PROVED._replace(live=0.0)
    assert np.isnan(no_alpha(falling, "").alpha)
    for error in ({"live": 0.1}, {"rhs": 0.5}, {"inadmissible": 1e-7}, {"largest": 0.0}):
        assert no_alpha(falling._replace(**error), "") is None


def test_the_wall_is_solved_from_the_start_without_an_end():
    """Whatever the other end says; and a fall is told from the first end that has one."""
    model = model_from_json({"blocks_xywh": [[0, 0, 1, 2]]})
    stands = optimum(PROVED._replace(rhs=0.5), 0.5, 1, "")
    least = optimum(PROVED._replace(live=-1.0, rhs=0.5), -0.5, -1, "")
    falls = optimum(PROVED, -0.5, 1, "")
    assert not told(model, (stands, least)).solved_cold
    for ends in ((None, least), (stands, None)):
        grown = told(model, ends)
        assert grown.solved_cold
        assert grown.resistance.stable
    for ends in ((falls,), (stands, falls)):
        both = told(model, ends).resistance
        assert both.left.status is both.right.status is LimitStatus.UNSTABLE
        assert both.left.certificate.holds


@pytest.mark.parametrize("name", IMPLEMENTATIONS)
def test_a_fall_that_is_not_proved_is_not_told_by_what_grows(name, monkeypatch):
    """The upper block is over the edge by a hair, and the mechanism slides a little as well.

    It proves alpha to 1e-8, as it must, and not that the wall falls.
    """
    begin = growing_large.begun if name == "large" else implementation(name, monkeypatch)
    rows = [[0, 0, 1, 1], [0.5 + 2e-9, 1, 1, 1]]
    both = model_from_json({"blocks_xywh": rows, "mu": 0.9})
    first = RigidBlockModel(both.blocks[:1], both.interfaces[:1], both.mu)
    analysis = begin(first, units_of(first))
    over = analysis.model.with_added(both.blocks[1:], both.interfaces[1:])
    honest = analysis.resistance_with(over)
    assert honest.resistance.left.status is LimitStatus.UNSTABLE
    assert not honest.solved_cold

    def slides(velocity):
        changed = velocity.copy()
        changed[-3] += 8e-9 * np.abs(velocity).max()
        return changed

    solve, minimise = growing_simplex.solve_added, RefinedSession.minimise

    def solved(tilt, added):
        answer = solve(tilt, added)
        return replace(answer, velocity=slides(answer.velocity))

    def minimised(session, costs):
        solution = minimise(session, costs)
        return replace(solution, duals=slides(solution.duals))

    monkeypatch.setattr(growing_simplex, "solve_added", solved)
    monkeypatch.setattr(growing_large, "guessed", lambda *_: None)
    monkeypatch.setattr(RefinedSession, "minimise", minimised)
    assert analysis.resistance_with(over).solved_cold
