"""A time limit leaves a wall as it is between two steps, and changes nothing unless it strikes."""

import math
from concurrent.futures import ThreadPoolExecutor

import pytest

from drystone.planner.deadline import NEVER, Deadline, TimeIsUp
from drystone.planner.planner import Planner
from drystone.planner.settings import method_settings
from tests.planner.scenes import (
    RUBBLE_SITE,
    Ticks,
    after_looks,
    finish,
    greedy,
    order,
    rubble,
    same,
)

WAYS = {
    "best": {},
    "given order": {"order": "given"},
    "policy": {"selection_rule": "lowest"},
}


def planner(way, **options):
    settings = method_settings("paper") if way == "paper" else greedy(WAYS[way])
    return Planner(rubble(), RUBBLE_SITE, seed=1, settings=settings, **options)


def test_it_strikes_once_the_clock_is_past_it():
    clock = Ticks()
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
    whole = finish(planner(way))
    clock = Ticks()
    watched = planner(way)
    assert len(list(watched.steps(Deadline(math.inf, clock)))) == len(order(whole))
    assert same(watched, whole)
    assert clock.count > len(order(whole))  # inside of steps as well
    for count in (0, 1, clock.count // 2, clock.count - 1):
        part = planner(way)
        with pytest.raises(TimeIsUp):
            list(part.steps(after_looks(count)))
        assert part.stopped is None
        assert order(part) == order(whole)[: len(order(part))]
        assert same(finish(part), whole)
        assert part.stopped == whole.stopped


def test_it_strikes_in_threads_too():
    whole = finish(planner("best"))
    with ThreadPoolExecutor(2) as threads:
        part = planner("best", executor=threads)
        with pytest.raises(TimeIsUp):
            list(part.steps(after_looks(60)))
        assert order(part) == order(whole)[: len(order(part))]
        assert same(finish(part), whole)
