"""What is said of walls on the way that do not stand, or of which nothing is known."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.verify import claims
from drystone.verify.check import check_plan
from tests.verify.exact_examples import exact_example

Analyse = Callable[..., LateralResistance]


def ending(status: LimitStatus, side: str, *, from_call: int) -> Analyse:
    """An analysis of which one end is as said, from one call on."""
    calls: list[object] = []

    def analyse(model: object) -> LateralResistance:
        calls.append(model)
        both = lateral_resistance(model)  # type: ignore[arg-type]
        end = replace(getattr(both, side), status=status, alpha=None)
        return both if len(calls) <= from_call else replace(both, **{side: end})

    return analyse


MADE = exact_example()


def told(monkeypatch: pytest.MonkeyPatch, analyse: Analyse) -> list[tuple[str, str]]:
    monkeypatch.setattr(claims, "lateral_resistance", analyse)
    problems = check_plan(MADE.plan, MADE.stones).problems
    return [(one.code, one.message) for one in problems if one.code in ("E230", "E237")]


def test_a_solver_that_gives_up_is_no_wall_that_falls(monkeypatch: pytest.MonkeyPatch) -> None:
    # Of the walls as they are, and in their sturdy models.
    for from_call, side in ((0, "left"), (3, "right")):
        found = told(monkeypatch, ending(LimitStatus.FAILED, side, from_call=from_call))
        assert found
        for code, message in found:
            assert code == "E230"
            assert "the solver gave up, and it is not known whether the wall stands" in message


def test_a_wall_that_carries_any_load_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, ending(LimitStatus.UNBOUNDED, "left", from_call=0)) == []


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_wall_that_falls_is_said_to(monkeypatch: pytest.MonkeyPatch, side: str) -> None:
    found = told(monkeypatch, ending(LimitStatus.UNSTABLE, side, from_call=0))
    assert ("E230", f"the wall does not stand: {side} unstable.") in found
