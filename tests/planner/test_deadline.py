"""A time limit leaves a wall as it is between two steps, and changes nothing unless it strikes."""

import math
from concurrent.futures import ThreadPoolExecutor

import pytest

from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from tests.planner import scenes

WAYS = {"best": {}, "given order": {"order": "given"}, "policy": {"selection_rule": "lowest"}}


def planner(way, **options):
    settings = method_settings("paper") if way == "paper" else scenes.greedy(WAYS[way])
    return Planner(scenes.rubble(), scenes.RUBBLE_SITE, seed=1, settings=settings, **options)


def test_it_strikes_once_the_clock_is_past_it():
    clock = scenes.Ticks()
    until = Deadline.after(2.0, clock)  # looks at the clock: it is 1
    until.look()
    until.look()
    with pytest.raises(TimeIsUp):
        until.look()


def test_no_limit_never_strikes():
    assert NEVER.at == math.inf
    assert Deadline.after(math.inf).at == math.inf
    NEVER.look()


@pytest.mark.parametrize("way", [*WAYS, "paper"])
def test_what_is_built_by_then_is_a_part_of_the_wall_and_can_be_gone_on_with(way):
    whole = scenes.finish(planner(way))
    clock = scenes.Ticks()
    watched = planner(way)
    assert len(list(watched.steps(Deadline(math.inf, clock)))) == len(scenes.order(whole))
    assert scenes.same(watched, whole)
    assert clock.count > len(scenes.order(whole))  # inside of steps as well
    for count in (0, 1, clock.count // 2, clock.count - 1):
        part = planner(way)
        with pytest.raises(TimeIsUp):
            list(part.steps(scenes.after_looks(count)))
        assert part.stopped is None
        assert scenes.order(part) == scenes.order(whole)[: len(scenes.order(part))]
        assert scenes.same(scenes.finish(part), whole)
        assert part.stopped == whole.stopped


def test_it_strikes_in_threads_too():
    whole = scenes.finish(planner("best"))
    with ThreadPoolExecutor(2) as threads:
        part = planner("best", executor=threads)
        with pytest.raises(TimeIsUp):
            list(part.steps(scenes.after_looks(60)))
        assert scenes.order(part) == scenes.order(whole)[: len(scenes.order(part))]
        assert scenes.same(scenes.finish(part), whole)
