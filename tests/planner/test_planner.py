"""Algorithm 1: the loop, its ways to stop, and that it can be left and taken up again."""

from itertools import islice

import pytest

from drystone.errors import UsageError
from drystone.model.site import Site
from drystone.planner.attempt import Attempt
from drystone.planner.deadline import Deadline, TimeIsUp
from drystone.planner.events import Callbacks, Stopped
from drystone.planner.measured import MeasuredPose
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings, StopSettings
from drystone.search.plan_result import result_of
from tests.planner.scenes import Ticks, blocks, bricks, finish, greedy, of_rubble, same


@pytest.mark.parametrize(
    ("stones", "changes", "stopped", "built"),
    [
        (bricks(8), {}, Stopped("filled", "filling above 0.99"), 6),
        # 4/6 is the first above .6.
        (bricks(8), {"stop": {"filling": 0.6}}, Stopped("filled", "filling above 0.6"), 4),
        (bricks(3), {}, Stopped("stones", "all stones placed"), 3),
        (
            blocks({1: (20, 10), 2: (90, 10)}),
            {"skip_too_large": True},
            Stopped("stones", "all stones that fit placed"),
            1,
        ),
    ],
)
def test_it_stops_when_the_wall_is_filled_or_no_stones_are_left(stones, changes, stopped, built):
    settings = PlannerSettings().updated(changes)
    planner = finish(Planner(stones, Site(60, 20), settings=settings))
    assert planner.stopped == stopped
    assert len(planner.build.actions) == built


@pytest.fixture
def attempts(monkeypatch):
    """What every attempt at a step chose."""
    chosen = []
    choose = Attempt.choose

    def watched(self, rng):
        action = choose(self, rng)
        chosen.append(None if action is None else action.stone_id)
        return action

    monkeypatch.setattr(Attempt, "choose", watched)
    return chosen


@pytest.mark.parametrize(("sampling", "failures"), [("variant", 1), ("variant", 3), ("full", 1)])
def test_it_stops_after_failures_in_a_row(sampling, failures, attempts):
    """With all stones tried there is nothing to draw anew: one failure is enough, of five."""
    stop = StopSettings() if sampling == "full" else StopSettings(failures=failures)
    settings = PlannerSettings(sampling=sampling, stop=stop)
    planner = finish(Planner(bricks(5), Site(30, 10), settings=settings))
    assert planner.stopped == Stopped("failures", "no stone that is left can be placed")
    assert attempts[0] is not None
    assert attempts[1:] == [None] * failures


def test_a_success_forgives_failures(monkeypatch, attempts):
    choose, count = Attempt.choose, iter(range(1000))

    def moody(self, rng):
        # Four failures before every success.
        return choose(self, rng) if next(count) % 5 == 4 else None

    monkeypatch.setattr(Attempt, "choose", moody)
    planner = finish(Planner(bricks(4), Site(60, 20)))
    assert len(planner.build.actions) == 4
    assert len(attempts) == 4


def test_every_attempt_draws_its_own_numbers(monkeypatch):
    choose = Attempt.choose
    drawn = []

    def watched(self, rng):
        drawn.append(int(rng.integers(2**62)))
        return choose(self, rng)

    monkeypatch.setattr(Attempt, "choose", watched)
    for seed in (1, 2):
        finish(Planner(bricks(5), Site(30, 10), seed=seed))
    assert len(drawn) == len(set(drawn)) == 2 * (1 + 5)  # one stone, five failures


BOTH = pytest.mark.parametrize("settings", [PlannerSettings(), greedy()], ids=["paper", "best"])


@BOTH
def test_steps_can_be_left_and_taken_up_again(settings):
    whole, parts = of_rubble(settings, seed=1), of_rubble(settings, 0, seed=1)
    numbers = []
    for steps in (2, 2, 1, None):
        for step in islice(parts.steps(), steps):
            assert parts.stopped is None
            assert step.build is parts.build
            assert step.build.actions[-1] is step.action
            assert step.candidates >= 1
            numbers.append(step.number)
    assert same(parts, whole)
    assert numbers == list(range(1, len(whole.build.actions) + 1))
    assert len(numbers) > 5


def test_callbacks_come_before_the_step_is_yielded_and_their_interrupt_keeps_it():
    told = []

    class Impatient(Callbacks):
        def on_step(self, step):
            told.append(f"told {step.number}")
            if step.number == 2:
                raise KeyboardInterrupt

    planner = of_rubble(None, 0, seed=1, callbacks=Impatient())
    with pytest.raises(KeyboardInterrupt):
        told.extend(f"got {step.number}" for step in planner.steps())
    assert told == ["told 1", "got 1", "told 2"]
    assert len(planner.build.actions) == 2
    assert same(finish(planner), of_rubble(seed=1))


@BOTH
def test_a_restored_wall_goes_on_as_if_never_interrupted(settings):
    whole, first, again = (of_rubble(settings, steps, seed=1) for steps in (None, 3, 0))
    again.restore(first.build.wall, first.build.course_heights_px())
    assert same(finish(again), whole)


def test_a_time_limit_strikes_once_the_clock_is_past_it():
    until = Deadline.after(2.0, Ticks())  # looks at the clock: it is 1
    until.look()
    until.look()
    with pytest.raises(TimeIsUp):
        until.look()


def test_why_it_stopped_is_of_the_wall_that_is_there():
    planner = finish(Planner(bricks(3), Site(60, 20)))
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
    finish(planner)
    planner.restore(whole.wall, {})
    assert planner.stopped is None


def test_a_lost_stone_is_one_fewer_to_stop_for():
    planner = finish(Planner(bricks(8), Site(60, 20)))
    unused = planner.workshop.remaining(planner.build)
    planner.observe(planner.build.wall.labels, lost=unused[:1])
    assert planner.stopped is None


def test_what_cannot_be_planned():
    with pytest.raises(UsageError, match="E126"):
        Planner(blocks({}), Site(10, 10))
    with pytest.raises(UsageError, match=r"E120 --wall: stones 2, 9 fit .*--skip-too-large"):
        Planner(blocks({1: (5, 5), 2: (11, 5), 9: (5, 11)}), Site(10, 10))
    with pytest.raises(UsageError, match="E137"):
        Planner(blocks({2**32 - 2: (5, 5)}), Site(10, 10))


def test_a_stone_that_fits_only_when_turned_is_not_too_large():
    stones = blocks({1: (5, 10)})
    with pytest.raises(UsageError, match="E120"):
        Planner(stones, Site(20, 6), settings=PlannerSettings(orientations="sf"))
    planner = finish(Planner(stones, Site(20, 6)))
    assert len(planner.build.actions) == 1
