"""Choosing between sides (Eq. 29) and by cost."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.indices import Indices
from drystone.model.placement import Placement
from drystone.model.site import Site
from drystone.model.stone import Stone
from drystone.model.wall import Group, Wall
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.choose import better_side, choose_by_algorithm2, choose_by_score
from drystone.planner.offers import holds
from drystone.poses import PoseBook
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.scored import ScoreSettings
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel

EMPTY = Build(Wall.empty(Site(20, 20)), RigidBlockModel((), ()))
INDICES = Indices(SF=1.0, LFR=1.0, GDS=0.5, NHR=0.0, IWR=0.5, IS=0.0, LLC=0.5, boundary=False)


def _proposal(stone_id, side="left", cost=0.0):
    posed = PoseBook().pose(Stone(stone_id, np.ones((2, 4), bool)), 0.0)
    return Proposal(Group(Placement(posed, 18, 0, side)), 0.0, cost=cost)


def _candidate(proposal, llc=0.5, gds=0.5):
    model = RigidBlockModel((), ())
    indices = replace(INDICES, LLC=llc, GDS=gds)
    return Candidate(proposal, indices, None, model, lateral_resistance(model))


def _winner(side, gds, llc=0.5):
    return _candidate(_proposal(1, side), llc, gds)


def test_the_larger_gds_wins():
    left, right = _winner("left", 0.6, llc=0.1), _winner("right", 0.6 + 1e-8, llc=0.05)
    assert better_side([left, right], EMPTY, SelectionSettings()) is right


def test_equal_gds_is_decided_by_the_weighted_sum():
    left, right = _winner("left", 1.0, llc=0.4), _winner("right", 1.0 - 5e-10, llc=0.5)
    assert better_side([left, right], EMPTY, SelectionSettings()) is right


def test_then_by_the_side_used_less_then_left():
    left, right = _winner("left", 1.0), _winner("right", 1.0)
    for winners in ([left, right], [right, left]):
        assert better_side(winners, EMPTY, SelectionSettings()) is left
        once = Build(EMPTY.wall, EMPTY.model, (left,))
        assert better_side(winners, once, SelectionSettings()) is right
        twice = Build(EMPTY.wall, EMPTY.model, (left, right))
        assert better_side(winners, twice, SelectionSettings()) is left


def test_a_side_without_a_winner_loses():
    right = _winner("right", 0.1)
    assert better_side([right], EMPTY, SelectionSettings()) is right
    assert better_side([], EMPTY, SelectionSettings()) is None


class _Judge:
    """Gives candidates a known LLC, and keeps what it was asked."""

    def __init__(self, llc):
        self.llc = llc
        self.batches = []

    def __call__(self, proposals):
        self.batches.append([p.stone_id for p in proposals])
        return [_candidate(p, self.llc[p.stone_id]) for p in proposals]


def test_algorithm_2_analyses_everything_and_gives_the_candidate_back():
    judge = _Judge({1: 0.2, 2: 0.9, 3: None})
    chosen = choose_by_algorithm2([_proposal(i) for i in (1, 2, 3)], judge, SelectionSettings())
    assert chosen.stone_id == 2
    assert judge.batches == [[1, 2, 3]]
    nothing = _Judge({1: None, 2: 0.0})
    assert choose_by_algorithm2([_proposal(1), _proposal(2)], nothing, SelectionSettings()) is None


def _by_score(costs, found, sure=None, **settings):
    judge = _Judge(found)
    proposals = [_proposal(i, cost=cost) for i, cost in costs.items()]
    weights = ScoreSettings(**{"llc": 0.0, "analysed": 2, **settings})
    surely = (lambda one: one.stone_id in sure) if sure is not None else lambda _: True
    return choose_by_score(proposals, judge, weights, surely), judge


def test_the_cheapest_that_stands_is_chosen():
    chosen, judge = _by_score({1: 0.3, 2: 0.1, 3: 0.2}, {1: 0.5, 2: None, 3: 0.5})
    assert chosen.stone_id == 3
    assert judge.batches == [[2, 3], [1]]  # one of the first two stands, so it goes on


def test_analysing_ends_when_enough_stand():
    chosen, judge = _by_score(dict.fromkeys((5, 6, 7, 8), 1.0), dict.fromkeys((5, 6, 7, 8), 0.5))
    assert judge.batches == [[5, 6]]
    assert chosen.stone_id == 5  # equal costs: the lower id
    # Costs that differ by rounding alone are equal.
    costs = {3: 0.1 + 0.2, 2: 0.3, 1: 0.4}
    assert _by_score(costs, dict.fromkeys(costs, 0.5))[1].batches == [[2, 3]]


@pytest.mark.parametrize(
    ("sure", "chosen", "batches"),
    [({1, 2}, 1, 1), ({2, 3}, 2, 1), ({4}, 4, 2), ({5}, 5, 3), (set(), None, 3)],
)
def test_the_cheapest_that_is_sure_is_chosen(sure, chosen, batches):
    costs = {i: float(i) for i in range(1, 6)}
    found, judge = _by_score(costs, dict.fromkeys(costs, 0.5), sure)
    assert (None if found is None else found.stone_id) == chosen
    assert judge.batches == [[1, 2], [3, 4], [5]][:batches]


def test_what_carries_nothing_does_not_stand():
    assert _by_score({1: 0.1, 2: 0.2}, {1: 0.0, 2: None})[0] is None
    assert _by_score({}, {})[0] is None


@pytest.mark.parametrize(
    ("settings", "chosen"),
    [
        ({"llc": 0.1}, 1),  # costs 0 - .01, .3 - .09
        ({"llc": 1.0}, 2),  # costs 0 - .1, .3 - .9; the third is not analysed
        ({"llc": 1.0, "analysed": 1}, 1),
        ({"llc": 9.0, "analysed": 3}, 3),
    ],
)
def test_resistance_counts_among_those_analysed(settings, chosen):
    best, _ = _by_score({1: 0.0, 2: 0.3, 3: 0.4}, {1: 0.1, 2: 0.9, 3: 1.0}, **settings)
    assert best.stone_id == chosen


@pytest.mark.parametrize(("left", "stays"), [(20, True), (8, True), (40, False)])
def test_an_engine_lets_a_brick_stay_where_its_middle_is_borne(left, stays):
    pytest.importorskip("pymunk")
    below, brick = (PoseBook().pose(Stone(i, np.ones((10, 30), bool)), 0.0) for i in (1, 2))
    wall = Wall.empty(Site(100, 40)).add(Placement(below, 30, 20, "left"))
    assert holds(wall, Group(Placement(brick, 20, left, "left")), 0.58) is stays
