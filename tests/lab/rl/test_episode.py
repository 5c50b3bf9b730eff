"""Stones that arrive, without the environment around them."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.planner.planner import Planner
from drystone.search.goal import figures_of, merit_of, possible_filling
from drystone.selection.policies.choices import LOWEST
from drystone_lab.rl.draw import draw_wall
from drystone_lab.rl.episode import ARRIVING, Episode, prepared
from tests.lab.rl.walls import SMALL, bricks


def test_builds_the_wall_of_the_planner_with_the_same_policy():
    settings = replace(ARRIVING, selection_rule="lowest")
    for seed in range(2):
        stones, site = draw_wall(SMALL, np.random.default_rng(seed))
        episode = Episode(prepared(stones, site))
        while not episode.over:
            episode.take(LOWEST.choose(episode.offers, np.random.default_rng(0)))
        planner = Planner(stones, site, settings=settings)
        list(planner.steps())
        assert np.array_equal(episode.build.wall.labels, planner.build.wall.labels)
        possible = possible_filling(planner.workshop)
        assert episode.merit == merit_of(figures_of(planner.build), possible, settings.goal)
        assert episode.aside == len(stones) - len(planner.build.actions)


def test_put_aside_for_good():
    episode = Episode(prepared(*bricks(3)))
    first = episode.stone_id
    episode.take(None)
    assert (episode.aside, episode.build.actions) == (1, ())
    while not episode.over:
        assert episode.stone_id != first
        episode.take(None)
    assert (episode.aside, episode.merit, episode.potential) == (3, 0.0, 0.0)


def test_full_wall_is_over_with_stones_left():
    episode = Episode(prepared(*bricks(6)))
    while not episode.over:
        lying = [k for k, offer in enumerate(episode.offers) if offer.width_px == 20]
        episode.take(lying[0])
    assert episode.build.wall.filling == 1.0
    assert (len(episode.build.actions), episode.aside, episode.waiting) == (4, 0, 2)


def test_keeps_the_lowest_of_the_offers():
    workshop = prepared(*bricks())
    every, few = Episode(workshop).offers, Episode(workshop, most=3).offers
    heights, kept = ([offer.centroid_px[1] for offer in offers] for offers in (every, few))
    assert len(heights) > 3
    assert sorted(kept) == sorted(heights)[:3]
    assert [offer for offer in every if offer in few] == list(few)


@pytest.mark.parametrize("position", [-1, 8])
def test_there_is_no_such_place(position):
    with pytest.raises(IndexError):
        Episode(prepared(*bricks())).take(position)
