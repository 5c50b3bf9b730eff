"""How surely stones rest where they are planned."""

import numpy as np
import pytest

from drystone.model.builder import HAND, BuilderErrors
from drystone.model.wall import outlined
from drystone.planner.planner import Planner
from drystone.planner.seats import Seats
from tests.naive import seats as naive
from tests.planner.scenes import ROUNDED, ROUNDED_SITE, finish, greedy


def seats_of(workshop, settings):
    return Seats(workshop.seats.mean_size, settings.settle, settings.mu)


@pytest.fixture(scope="module")
def careless():
    """A planner that has built without trials."""
    settings = greedy({"settle": {"trials": 0}})
    return finish(Planner(ROUNDED, ROUNDED_SITE, seed=2, settings=settings))


def shares(seats, wall, states):
    """The share of falls of every step; None where it is more than bearable."""
    return [seats.falls(group, state) for group, state in zip(wall.groups, states, strict=True)]


def walls_of(planner):
    """The wall before every step."""
    walls, wall = [], type(planner.build.wall).empty(ROUNDED_SITE, exact=True)
    for group in planner.build.wall.groups:
        walls.append(wall)
        wall = wall.add(group.placement, group.wedges)
    return walls


def test_trials_are_those_of_walls_that_are_built_anew(careless):
    settings = greedy()
    seats, wall = seats_of(careless.workshop, settings), careless.build.wall
    steps = [outlined(group.placement, group.wedges) for group in wall.groups]
    errors = BuilderErrors.of_precision(1.25 * HAND, seats.mean_size)  # DESIGN 4.10, a quarter more
    fallen = np.zeros(len(steps))
    for trial in range(settings.settle.trials):
        fallen += naive.falls(steps, errors, trial, settings.mu, settings.settle)
    assert fallen.any()
    fallen /= settings.settle.trials
    for group, share, state in zip(wall.groups, fallen, walls_of(careless), strict=True):
        bearable = share <= seats.bearable(group.placement.posed.stone)
        assert seats.falls(group, state) == (pytest.approx(share) if bearable else None)
        if bearable:  # what is not less than the least is not told
            assert seats.falls(group, state, share + 0.01) == pytest.approx(share)
            assert seats.falls(group, state, max(share, 0.01)) == (None if share else 0.0)


def test_what_was_asked_before_changes_nothing(careless):
    wall, before = careless.build.wall, walls_of(careless)
    settings = greedy()
    used = seats_of(careless.workshop, settings)
    asked = shares(used, wall, before)
    assert asked == shares(used, wall, before)
    for k in (len(before) - 1, 3, 7):  # in another order, each by one that remembers nothing
        assert seats_of(careless.workshop, settings).falls(wall.groups[k], before[k]) == asked[k]


def test_a_wall_of_many_stones_is_finished_though_it_is_not_sure(careless):
    stone, settings = next(iter(ROUNDED)), greedy()
    few, many = (
        Seats(careless.workshop.seats.mean_size, settings.settle, 0.58, count=count).bearable(stone)
        for count in (80, 81)
    )
    assert many == 2.0 * few


def test_no_stone_is_laid_where_it_falls_more_often_than_is_bearable(careless):
    assert None in shares(
        seats_of(careless.workshop, greedy()), careless.build.wall, walls_of(careless)
    )
    careful = finish(Planner(ROUNDED, ROUNDED_SITE, settings=greedy()))
    found = shares(careful.workshop.seats, careful.build.wall, walls_of(careful))
    assert None not in found
    assert len(found) >= 0.75 * len(ROUNDED)
    assert np.mean(found) < 0.02
