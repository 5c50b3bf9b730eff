"""Algorithm 1: its settings, the loop, its ways to stop, and how it is taken up again."""

import json
import math
import tomllib
from dataclasses import fields, replace
from itertools import islice

import numpy as np
import pytest
import tomli_w

from drystone import MeasuredPose, Planner, PlannerSettings, Site, method_settings, result_of
from drystone.errors import UsageError
from drystone.planner.attempt import Attempt
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.events import Callbacks, Stopped
from drystone.planner.profile import Profile
from drystone.planner.settings import METHODS, StopSettings
from drystone.planner.vary import varied
from drystone.planner.workshop import Workshop
from drystone.selection.scored import ScoreSettings
from tests.planner import scenes


@pytest.mark.parametrize(
    ("stones", "changes", "stopped", "built"),
    [
        (8, {}, ("filled", "filling above 0.99"), 6),
        (8, {"stop": {"filling": 0.6}}, ("filled", "filling above 0.6"), 4),  # 4/6 is the first
        (3, {}, ("stones", "all stones placed"), 3),
        (3, {"ban": [1]}, ("stones", "all stones that are not banned placed"), 2),
        (3, {"ban": [1, 2, 3]}, ("stones", "all stones that are not banned placed"), 0),
        ({1: (20, 10), 2: (90, 10)}, {"skip_too_large": True},
         ("stones", "all stones that fit placed"), 1),
    ],
)  # fmt: skip
def test_it_stops_when_the_wall_is_filled_or_no_stones_are_left(stones, changes, stopped, built):
    settings = PlannerSettings().updated(changes)
    stones = scenes.bricks(stones) if isinstance(stones, int) else scenes.blocks(stones)
    planner = scenes.finish(Planner(stones, Site(60, 20), settings=settings))
    assert planner.stopped == Stopped(*stopped)
    assert len(planner.build.actions) == built


@pytest.mark.parametrize(("sampling", "failures"), [("variant", 1), ("variant", 3), ("full", 1)])
def test_it_stops_after_failures_in_a_row(sampling, failures, monkeypatch):
    """With all stones tried there is nothing to draw anew: one failure is enough, of five."""
    attempts = scenes.watched(monkeypatch, Attempt, "choose")
    stop = StopSettings() if sampling == "full" else StopSettings(failures=failures)
    settings = PlannerSettings(sampling=sampling, stop=stop)
    planner = scenes.finish(Planner(scenes.bricks(5), Site(30, 10), settings=settings))
    assert planner.stopped == Stopped("failures", "no stone that is left can be placed")
    assert [chosen is None for _, chosen in attempts] == [False] + [True] * failures


def test_a_success_forgives_failures(monkeypatch):
    choose, count, drawn = Attempt.choose, iter(range(1000)), []

    def moody(self, rng):
        # Four failures before every success; each attempt draws its own numbers.
        drawn.append(int(rng.integers(2**62)))
        return choose(self, rng) if next(count) % 5 == 4 else None

    monkeypatch.setattr(Attempt, "choose", moody)
    for seed in (1, 2):
        planner = scenes.finish(Planner(scenes.bricks(4), Site(60, 20), seed=seed))
        assert len(planner.build.actions) == 4
    assert len(drawn) == len(set(drawn)) == 2 * 4 * 5


@pytest.mark.parametrize("settings", [PlannerSettings(), scenes.greedy()], ids=["paper", "best"])
def test_steps_can_be_left_and_taken_up_again_also_of_a_restored_wall(settings):
    whole, parts = scenes.of_rubble(settings, seed=1), scenes.of_rubble(settings, 0, seed=1)
    again, numbers = scenes.of_rubble(settings, 0, seed=1), []
    for steps in (2, 1, 2, None):
        for step in islice(parts.steps(), steps):
            assert parts.stopped is None
            assert step.build is parts.build
            assert step.build.actions[-1] is step.action
            assert step.candidates >= 1
            numbers.append(step.number)
        if len(numbers) == 3:
            again.restore(parts.build.wall, parts.build.course_heights_px())
    assert scenes.same(parts, whole)
    assert numbers == list(range(1, len(whole.build.actions) + 1))
    assert len(numbers) > 5
    assert scenes.same(scenes.finish(again), whole)


def test_callbacks_come_before_the_step_is_yielded_and_their_interrupt_keeps_it():
    told = []

    class Impatient(Callbacks):
        def on_step(self, step):
            told.append(f"told {step.number}")
            if step.number == 2:
                raise KeyboardInterrupt

    planner = scenes.of_rubble(None, 0, seed=1, callbacks=Impatient())
    with pytest.raises(KeyboardInterrupt):
        told.extend(f"got {step.number}" for step in planner.steps())
    assert told == ["told 1", "got 1", "told 2"]
    assert len(planner.build.actions) == 2
    assert scenes.same(scenes.finish(planner), scenes.of_rubble(seed=1))


def test_a_time_limit_strikes_once_the_clock_is_past_it():
    until = Deadline.after(2.0, scenes.Ticks())  # looks at the clock: it is 1
    until.look()
    until.look()
    with pytest.raises(TimeIsUp):
        until.look()


def test_why_it_stopped_is_of_the_wall_that_is_there():
    planner = scenes.finish(Planner(scenes.bricks(3), Site(60, 20)))
    whole = planner.build
    poses = {
        placement.stone_id: MeasuredPose(*placement.centroid(20), placement.posed.angle_deg)
        for placement in whole.wall.placements
    }
    planner.observe(poses)
    assert planner.stopped == Stopped("stones", "all stones placed")
    *left, _ = poses
    planner.observe({i: poses[i] for i in left})
    assert planner.stopped is None
    assert result_of(planner).status == "interrupted"
    scenes.finish(planner)
    planner.restore(whole.wall, {})
    assert planner.stopped is None
    # A lost stone is one fewer to stop for.
    planner = scenes.finish(Planner(scenes.bricks(8), Site(60, 20)))
    unused = planner.workshop.remaining(planner.build)
    planner.observe(planner.build.wall.labels, lost=unused[:1])
    assert planner.stopped is None


def test_what_cannot_be_planned():
    with pytest.raises(UsageError, match="E126"):
        Planner(scenes.blocks({}), Site(10, 10))
    with pytest.raises(UsageError, match=r"E120.* no orientation of stones 2, 9 fits.*--skip-too"):
        Planner(scenes.blocks({1: (5, 5), 2: (11, 5), 9: (5, 11)}), Site(10, 10))
    with pytest.raises(UsageError, match="E137"):
        Planner(scenes.blocks({2**32 - 2: (5, 5)}), Site(10, 10))
    # A stone that fits only when it is turned is not too large.
    stones = scenes.blocks({1: (5, 10)})
    with pytest.raises(UsageError, match=r"E120.*Build a larger wall: no stone fits"):
        Planner(stones, Site(20, 6), settings=PlannerSettings(orientations="sf"))
    assert len(scenes.finish(Planner(stones, Site(20, 6))).build.actions) == 1


@pytest.mark.parametrize("changes", [{}, {"geometry": "raster"}, {"selection_rule": "algorithm2"}])
def test_stones_are_banned_pinned_or_in_a_given_order(changes):
    def built(more=None, steps=None):
        return scenes.of_rubble(scenes.greedy({**changes, **(more or {})}), steps, seed=1)

    free = scenes.ids(built())
    without = scenes.ids(built({"ban": free[1:3]}))
    assert without
    assert not set(without) & set(free[1:3])
    assert scenes.ids(built({"pin": free[-1:]})).index(free[-1]) < len(free) - 2
    given = built({"order": "given"})
    assert len(given.build.actions) >= 5
    assert scenes.ids(given) == sorted(scenes.ids(given))
    # What is built says where to go on.
    assert scenes.order(scenes.finish(built({"order": "given"}, 3))) == scenes.order(given)


def test_a_banned_stone_may_be_too_large():
    stones, site = scenes.blocks({1: (20, 10), 2: (200, 100), 3: (20, 10)}), Site(60, 20)
    with pytest.raises(UsageError, match="E120"):
        Workshop.prepare(stones, site, PlannerSettings())
    workshop = Workshop.prepare(stones, site, PlannerSettings(ban=(2,)))
    assert workshop.fitting == (1, 3)
    assert len(workshop.stock.sides) == 2
    # Errors of a builder are those of the stones that may be laid.
    assert workshop.seats.mean_size == 200**0.5
    # Wedges are numbered after all stones, banned ones too.
    planner = Planner(stones, site, settings=PlannerSettings(ban=(2, 3)))
    assert planner.workshop.next_wedge(planner.build) == 4


@pytest.mark.parametrize("name", ["ban", "pin"])
def test_unknown_stones_are_refused(name):
    with pytest.raises(UsageError, match="E145") as caught:
        scenes.of_rubble(scenes.greedy({name: [1, 77, 99]}))
    assert caught.value.where == f"--{name}"
    assert "77, 99" in caught.value.what


def test_what_finds_no_place_in_its_turn_is_set_aside():
    stones = scenes.blocks({1: (20, 10), 2: (70, 10), 3: (20, 10), 4: (20, 10), 5: (20, 10)})
    settings = scenes.greedy({"geometry": "raster", "order": "given", "orientations": "sf"})
    settings = replace(settings, skip_too_large=True)
    small = scenes.finish(Planner(stones, Site(60, 10), settings=settings))
    assert scenes.ids(small) == [1, 3, 4]
    assert small.stopped.reason == "filled"
    narrow = scenes.finish(Planner(stones, Site(45, 10), settings=settings))
    assert scenes.ids(narrow) == [1, 3]
    assert narrow.stopped.text == "no stone is left that was not tried in its turn"


@pytest.mark.parametrize("changes", [{}, {"ban": [3], "pin": [1, 2]}])
@pytest.mark.parametrize("method", list(METHODS))
def test_what_is_not_said_stays_and_settings_survive_toml_and_json(method, changes):
    plain = method_settings(method)
    settings = plain.updated({**changes, "mu": 1, "placement": {"tries": 3}})
    assert (settings.mu, type(settings.mu)) == (1.0, float)
    assert settings.placement == replace(plain.placement, tries=3)
    written = settings.as_dict()
    assert PlannerSettings().updated(tomllib.loads(tomli_w.dumps(written))) == settings
    assert PlannerSettings().updated(json.loads(json.dumps(written))) == settings


WRONG = [
    *({"pin": value} for value in (7, [1.5], [True], ["7"], {"a": 1})),
    *({"mu": value} for value in (True, "0.58", 10**400, 0.0)),
    *({"placement": value} for value in (3, {"tries": True}, {"tries": 2.0}, {"tries": 10**5000})),
    {"two_sided": 1},
    {"orientations": 10},
    {"stop": {"failures": "five"}},
    {"search": {"pin": [2**63]}},
    {"stabilise": {"margin": 0.5}},
    {"clusters": {"distance": -1}},
]
"""Of the wrong type, or out of range."""


@pytest.mark.parametrize(
    ("changes", "code", "named", "cure"),
    [
        *((changes, "E123", next(iter(changes)), "") for changes in WRONG),
        ({"pin": [1, 3], "ban": [3, 4]}, "E123", "the same stones: 3.", "pin or ban"),
        ({"xyz": 1}, "E123", "'xyz'", "sampling"),
        ({"placement": {"wonder": 1}}, "E123", "'placement.wonder'", "reach"),
        ({"sampling": "some"}, "E123", "sampling must be one of", "sampling"),
        ({"stabilise": {"method": "glue"}}, "E123", "stabilise.method must be", "method"),
        ({"orientations": "north"}, "E122", "north", ""),
    ],
)
def test_settings_that_cannot_be_are_refused_with_the_known_ones(changes, code, named, cure):
    with pytest.raises(UsageError) as caught:
        PlannerSettings().updated(changes)
    assert caught.value.code == code
    assert named in str(caught.value)
    assert caught.value.cure
    assert cure in caught.value.cure
    with pytest.raises(UsageError, match=r"E124 --method: there is no method 'x'\. .*paper, best"):
        method_settings("x")


def test_every_weight_gets_its_own_factor_and_nothing_else_changes():
    settings = method_settings("best")
    new = varied(settings, 0.3, np.random.default_rng(5))
    rng = np.random.default_rng(5)
    weights = [field.name for field in fields(ScoreSettings) if field.name != "analysed"]
    for name in weights:
        factor = math.exp(0.3 * rng.normal())
        assert getattr(new.score, name) == getattr(settings.score, name) * factor
    assert new.vary == 0.0
    assert new.score.analysed == settings.score.analysed
    unvaried = {"score": settings.as_dict()["score"], "vary": settings.vary}
    assert new.updated(unvaried) == settings


@pytest.mark.parametrize("vary", [0.0, 0.3])
def test_another_seed_gives_another_wall(vary):
    """Where the weights vary: without it nothing is random here."""
    walls = [scenes.of_rubble(scenes.greedy({"vary": vary}), seed=seed) for seed in (1, 2)]
    assert scenes.same(*walls) == (vary == 0.0)


def test_parts_belong_to_the_step_in_which_they_end():
    now = [0.0]
    profile = Profile(lambda: now[0])

    def take(name, seconds):
        with profile.part(name):
            now[0] += seconds
            if name == "contacts":
                raise ZeroDivisionError

    take("preparation", 2.0)
    profile.begin_step()
    take("placement", 1.0)
    take("placement", 0.5)
    now[0] += 0.25
    profile.end_step(0, 7)
    profile.begin_step()
    with pytest.raises(ZeroDivisionError):  # what fails is measured too
        take("contacts", 4.0)
    profile.end_step(1, 3)
    # An attempt without an action counts outside of steps.
    profile.begin_step()
    take("indices", 8.0)
    profile.begin_step()
    profile.end_without_action(4)
    first, second = profile.steps
    assert (first.stones, first.candidates, first.seconds) == (0, 7, 1.75)
    assert first.parts == {"placement": 1.5}
    assert (second.seconds, second.parts) == (4.0, {"contacts": 4.0})
    assert profile.candidates == 7 + 3 + 4
    totals = {"preparation": 2.0, "placement": 1.5, "contacts": 4.0, "indices": 8.0, "metrics": 0.0}
    assert {name: profile.total(name) for name in totals} == totals
