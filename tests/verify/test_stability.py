"""What is said of walls on the way that do not stand, or of which nothing is known."""

from collections.abc import Callable
from dataclasses import replace

import pytest

from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LateralResistance, LimitStatus
from drystone.verify import stability
from drystone.verify.check import check_plan
from tests.verify.exact_examples import exact_example

Analyse = Callable[..., LateralResistance]


def ending(status: LimitStatus, *, from_call: int) -> Analyse:
    """An analysis whose left end is as said, from one call on."""
    calls: list[object] = []

    def analyse(model: object) -> LateralResistance:
        calls.append(model)
        both = lateral_resistance(model)  # type: ignore[arg-type]
        left = replace(both.left, status=status, alpha=None)
        return both if len(calls) <= from_call else replace(both, left=left)

    return analyse


def told(monkeypatch: pytest.MonkeyPatch, analyse: Analyse) -> list[tuple[str, str]]:
    made = exact_example()
    monkeypatch.setattr(stability, "lateral_resistance", analyse)
    problems = check_plan(made.plan, made.stones).problems
    return [(one.code, one.message) for one in problems if one.code in ("E230", "E237")]


def test_a_solver_that_gives_up_is_no_wall_that_falls(monkeypatch: pytest.MonkeyPatch) -> None:
    for from_call in (0, 3):  # of the walls as they are, and in their sturdy models
        found = told(monkeypatch, ending(LimitStatus.FAILED, from_call=from_call))
        assert found
        for code, message in found:
            assert code == "E230"
            assert "the solver gave up, and it is not known whether the wall stands" in message


def test_a_wall_that_carries_any_load_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, ending(LimitStatus.UNBOUNDED, from_call=0)) == []


def test_a_wall_that_falls_is_said_to(monkeypatch: pytest.MonkeyPatch) -> None:
    found = told(monkeypatch, ending(LimitStatus.UNSTABLE, from_call=0))
    assert ("E230", "the wall does not stand: left unstable.") in found
