"""Rework: the wall never gets worse."""

import math
from collections.abc import Iterator
from dataclasses import fields, replace
from itertools import islice, pairwise
from types import SimpleNamespace
from typing import Any

import pytest

from drystone.model.site import Site
from drystone.planner.build import Build
from drystone.planner.events import Callbacks, Round, Step
from drystone.planner.planner import Planner
from drystone.planner.rework import rework, wall_merit
from drystone.search.plan_wall import plan_wall, run_to_end
from drystone.selection.scored import ScoreSettings
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, order, rubble, same


def _planner(rounds: int, seed: int = 1) -> Planner:
    settings = greedy({"rework": {"rounds": rounds}})
    return Planner(rubble(seed=seed), RUBBLE_SITE, seed=seed, settings=settings)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_merit_never_falls(seed: int) -> None:
    planner = finish(_planner(3, seed))
    before = order(planner)
    incumbents = list(rework(planner))
    assert len(incumbents) == 4
    assert incumbents[0].planner is planner
    assert incumbents[0].merit == wall_merit(planner)
    assert all(one.merit <= other.merit for one, other in pairwise(incumbents))
    for incumbent in incumbents:
        assert incumbent.merit == wall_merit(incumbent.planner)
        states = incumbent.planner.build.states()
        assert [len(state.actions) for state in states] == list(range(len(states)))
        assert states[-1] is incumbent.planner.build
        assert all(a.resistance.stable for a in incumbent.planner.build.actions)
    assert order(planner) == before


def test_a_wall_is_kept_when_its_merit_is_larger(monkeypatch: pytest.MonkeyPatch) -> None:
    merits = iter([1.0, 0.5, 2.0, 2.0])
    monkeypatch.setattr("drystone.planner.rework.wall_merit", lambda _: next(merits))
    planner = finish(_planner(3))
    incumbents = list(rework(planner))
    assert [incumbent.merit for incumbent in incumbents] == [1.0, 1.0, 2.0, 2.0]
    walls = [incumbent.planner for incumbent in incumbents]
    assert walls[0] is walls[1] is planner
    assert walls[2] is walls[3]
    assert walls[2] is not planner


def test_no_rounds_change_nothing() -> None:
    plain = finish(_planner(0))
    planner, stopped = run_to_end(_planner(0))
    assert same(planner, plain)
    assert stopped == plain.stopped


def test_rounds_are_repeatable_and_told() -> None:
    told: list[Round] = []
    steps: list[int] = []

    class Watch(Callbacks):
        def on_step(self, step: Step) -> None:
            steps.append(step.number)

        def on_round(self, round_: Round) -> None:
            told.append(round_)

    one = _planner(2)
    one.callbacks = Watch()
    best, _ = run_to_end(one)
    again, _ = run_to_end(_planner(2))
    assert same(best, again)
    assert [(r.number, r.rounds) for r in told] == [(0, 2), (1, 2), (2, 2)]
    assert told[-1].stones == len(best.build.actions)
    assert told[-1].merit == wall_merit(best)
    assert steps == sorted(set(steps))  # rework does not tell the steps of walls it tries


def test_an_interrupt_keeps_the_best_wall_so_far() -> None:
    class Impatient(Callbacks):
        def on_round(self, round_: Round) -> None:
            if round_.number == 1:
                raise KeyboardInterrupt

    settings = greedy({"rework": {"rounds": 5}})
    result = plan_wall(
        rubble(seed=1), 100, 36, scale=1.0, seed=1, settings=settings, callbacks=Impatient()
    )
    assert (result.status, result.success) == ("interrupted", False)
    assert result.plan.stopped == "interrupted"
    first_rounds = list(islice(rework(finish(_planner(5))), 2))
    kept = order(first_rounds[-1].planner)
    assert [step.stone for step in result.plan.stone_steps] == [action[0] for action in kept]


def test_an_empty_wall_has_no_merit() -> None:
    planner = _planner(2)
    assert wall_merit(planner) == -math.inf
    # No stone that is 100 px wide fits: there is nothing to take down, and nothing breaks.
    settings = greedy({"rework": {"rounds": 2}, "skip_too_large": True})
    small, stopped = run_to_end(Planner(rubble(), Site(6, 6), settings=settings))
    assert (small.build.actions, stopped.reason) == ((), "stones")


def test_merit_rises_with_what_is_good_and_falls_with_what_is_bad(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    planner = finish(_planner(0))
    measured = {"F_AV": 10.0, "F_AH": 2.0, "T_LEVEL": 0.2, "E_FLUSH": 0.2}

    def merit(**changes: float) -> float:
        values = SimpleNamespace(**{**measured, **changes})
        monkeypatch.setattr("drystone.planner.rework.measure_labels", lambda *_, **__: values)
        return wall_merit(planner)

    weights = planner.settings.rework
    base = merit()
    assert merit(F_AV=11.0) - base == pytest.approx(weights.vertical)
    assert merit(F_AH=3.0) - base == pytest.approx(-weights.horizontal)
    assert merit(T_LEVEL=1.2) - base == pytest.approx(-weights.level)
    assert merit(E_FLUSH=1.2) - base == pytest.approx(-weights.flush)
    resistance = planner.build.actions[-1].resistance.value
    assert resistance is not None
    filling = planner.build.wall.filling
    site = planner.build.wall.site
    possible = planner.workshop.stones.total_area_px / (site.width_px * site.height_px)
    expected = (
        weights.filling * filling / possible
        + weights.resistance * min(1.0, resistance)
        + weights.vertical * 10
        - weights.horizontal * 2
        - (weights.level + weights.flush) * 0.2
    )
    assert base == pytest.approx(expected)


def test_rounds_vary_every_craft_weight_and_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    planner = finish(_planner(1))
    made: list[Planner] = []
    init = Planner.__init__

    def spy(self: Planner, *arguments: Any, **keywords: Any) -> None:
        init(self, *arguments, **keywords)
        made.append(self)

    monkeypatch.setattr(Planner, "__init__", spy)
    list(rework(planner))
    (varied,) = made
    weights = [f.name for f in fields(ScoreSettings) if f.name != "analysed"]
    old, new = planner.settings.score, varied.settings.score
    assert all(getattr(old, name) != getattr(new, name) for name in weights)
    assert old.analysed == new.analysed
    assert replace(varied.settings, score=old, vary=0.3) == planner.settings
    assert varied.settings.vary == 0.0  # the rounds draw their own


def test_rounds_go_back_some_steps_of_the_best_wall(monkeypatch: pytest.MonkeyPatch) -> None:
    planner = finish(_planner(8))
    starts: list[Build] = []
    steps = Planner.steps

    def spy(self: Planner) -> Iterator[Step]:
        starts.append(self.build)
        return steps(self)

    monkeypatch.setattr(Planner, "steps", spy)
    incumbents = list(rework(planner))
    back = []
    for best, start in zip(incumbents, starts, strict=False):
        states = best.planner.build.states()
        assert any(state is start for state in states)
        back.append(len(states) - 1 - len(start.actions))
        assert 1 <= back[-1] <= math.ceil(0.6 * (len(states) - 1))
    assert len(back) == 8
    assert len(set(back)) > 1
