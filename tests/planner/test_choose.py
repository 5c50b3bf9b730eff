"""Choosing: between sides (Eq. 29), by cost, and by policies, of which all walls are true."""

import sys
from dataclasses import replace
from importlib.metadata import EntryPoint, EntryPoints
from types import SimpleNamespace

import numpy as np
import pytest

import drystone as ds
from drystone.errors import UsageError
from drystone.io.plan_json import plan_to_json
from drystone.model.placement import Placement
from drystone.model.wall import Group, Wall
from drystone.planner.build import Build, Candidate, Proposal
from drystone.planner.choose import better_side, choose_by_policy, choose_by_score
from drystone.planner.events import Stopped
from drystone.planner.offers import holds, offer, support_px
from drystone.poses import PoseBook
from drystone.selection.algorithm2 import SelectionSettings
from drystone.selection.policies import registry
from drystone.selection.policies.registry import BUILT_IN, GROUP
from drystone.selection.policies.settings import PolicySettings
from drystone.selection.scored import ScoreSettings
from drystone.statics.model import Interface, RigidBlockModel
from tests.pages import printed
from tests.planner import scenes
from tests.selection.offers import INDICES

EMPTY = Build(Wall.empty(ds.Site(20, 20)), RigidBlockModel((), ()))


def _proposal(stone_id, side="left", cost=0.0):
    posed = PoseBook().pose(ds.Stone(stone_id, np.ones((2, 4), bool)), 0.0)
    return Proposal(Group(Placement(posed, 18, 0, side)), 0.0, cost=cost)


def _candidate(proposal, llc=0.5, gds=0.5):
    model = RigidBlockModel((), ())
    indices = replace(INDICES, LLC=llc, GDS=gds)
    return Candidate(proposal, indices, None, model, ds.lateral_resistance(model))


def test_the_larger_gds_wins_then_the_weighted_sum_then_the_side_used_less_then_left():
    def better(*winners, build=EMPTY):
        return better_side(winners, build, SelectionSettings())

    def winner(side, gds, llc=0.5):
        return _candidate(_proposal(1, side), llc, gds)

    for left, right in (((0.6, 0.1), (0.6 + 1e-8, 0.05)), ((1.0, 0.4), (1.0 - 5e-10, 0.5))):
        winners = winner("left", *left), winner("right", *right)
        assert better(*winners) is winners[1]
    left, right = winner("left", 1.0), winner("right", 1.0)
    for both in ([left, right], [right, left]):
        for used, taken in (((), left), ((left,), right), ((left, right), left)):
            assert better(*both, build=Build(EMPTY.wall, EMPTY.model, used)) is taken
    # A side without a winner loses.
    assert better(right) is right
    assert better() is None


def _by_score(costs, found, sure=None, **settings):
    """Choose from candidates of known LLC; say which were analysed, batch by batch."""
    batches = []

    def judge(proposals):
        batches.append([p.stone_id for p in proposals])
        return [_candidate(p, found[p.stone_id]) for p in proposals]

    proposals = [_proposal(i, cost=cost) for i, cost in costs.items()]
    weights = ScoreSettings(**{"llc": 0.0, "analysed": 2, **settings})
    surely = (lambda one: one.stone_id in sure) if sure is not None else lambda _: True
    return choose_by_score(proposals, judge, weights, surely), batches


def test_the_cheapest_that_stands_is_chosen_and_analysing_ends_when_enough_stand():
    chosen, batches = _by_score({1: 0.3, 2: 0.1, 3: 0.2}, {1: 0.5, 2: None, 3: 0.5})
    assert chosen.stone_id == 3
    assert batches == [[2, 3], [1]]  # one of the first two stands, so it goes on
    # What carries nothing does not stand.
    assert _by_score({1: 0.1, 2: 0.2}, {1: 0.0, 2: None})[0] is None
    assert _by_score({}, {})[0] is None
    costs = dict.fromkeys((5, 6, 7, 8), 1.0)
    chosen, batches = _by_score(costs, dict.fromkeys(costs, 0.5))
    assert batches == [[5, 6]]
    assert chosen.stone_id == 5  # equal costs: the lower id
    # Costs that differ by rounding alone are equal.
    costs = {3: 0.1 + 0.2, 2: 0.3, 1: 0.4}
    assert _by_score(costs, dict.fromkeys(costs, 0.5))[1] == [[2, 3]]


@pytest.mark.parametrize(
    ("sure", "chosen", "batches"),
    [({1, 2}, 1, 1), ({2, 3}, 2, 1), ({4}, 4, 2), ({5}, 5, 3), (set(), None, 3)],
)
def test_the_cheapest_that_is_sure_is_chosen(sure, chosen, batches):
    costs = {i: float(i) for i in range(1, 6)}
    found, asked = _by_score(costs, dict.fromkeys(costs, 0.5), sure)
    assert (None if found is None else found.stone_id) == chosen
    assert asked == [[1, 2], [3, 4], [5]][:batches]


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
    below, brick = (PoseBook().pose(ds.Stone(i, np.ones((10, 30), bool)), 0.0) for i in (1, 2))
    wall = Wall.empty(ds.Site(100, 40)).add(Placement(below, 30, 20, "left"))
    assert holds(wall, Group(Placement(brick, 20, left, "left")), 0.58) is stays


@pytest.mark.parametrize("scale", [1.0, 0.5])
@scenes.GEOMETRIES
def test_an_offer_is_where_the_stone_is_in_working_px(settings, scale):
    site = ds.Site.from_source(100, 36, scale)
    planner = scenes.finish(ds.Planner(scenes.rubble(1), site, seed=2, settings=settings))
    for candidate in planner.build.actions:
        seen, placement = offer(candidate, site), candidate.stabilised.placement
        assert (seen.wall_width_px, seen.wall_height_px) == (site.width_px, site.height_px)
        assert (seen.stone_id, seen.side) == (candidate.stone_id, candidate.side)
        assert seen.indices is candidate.indices
        assert seen.wedges == len(candidate.stabilised.wedges)
        mine = [
            {i.block, i.other}
            for i in candidate.model.interfaces
            if candidate.stone_id in (i.block, i.other)
        ]
        own = {candidate.stone_id, *(wedge.id for wedge in candidate.stabilised.wedges)}
        assert seen.touches == tuple(sorted(set().union(*mine) - {0, *own}))
        assert seen.centroid_px == placement.centroid(site.height_px)
        assert seen.left_px < seen.centroid_px[0] < seen.right_px
        assert seen.bottom_px < seen.centroid_px[1] < seen.top_px
        # A pixel that an outline covers by less than half is not filled.
        rows, cols = placement.window
        assert (seen.left_px, seen.right_px) == pytest.approx((cols.start, cols.stop), abs=1)
        ends = site.height_px - rows.stop, site.height_px - rows.start
        assert (seen.bottom_px, seen.top_px) == pytest.approx(ends, abs=1)
        assert seen.area_px == pytest.approx(placement.posed.stone.area_px * scale**2, rel=0.1)
        assert 0 <= seen.turned_deg <= 15
        assert seen.support_px is not None  # all of these rest on something
        (left, low), (right, high) = seen.support_px
        assert seen.left_px - 1e-9 <= left <= right <= seen.right_px + 1e-9
        assert min(low, high) >= seen.bottom_px - 0.2


def _interface(block, other, points, normal):
    return Interface(block, other, np.array(points), normal)


def test_only_what_bears_from_below_supports():
    beside = _interface(3, 1, [[0.0, 2.0], [0.0, 9.0]], (1.0, 0.05))
    above = _interface(3, 2, [[-9.0, 9.0], [9.0, 9.0]], (0.0, -1.0))
    others = _interface(2, 1, [[-8.0, 1.0], [8.0, 1.0]], (0.0, 1.0))
    below = _interface(3, 1, [[3.0, 1.0], [1.0, 2.0]], (0.0, 1.0))
    turned_round = _interface(1, 3, [[4.0, 3.0], [4.0, 1.0]], (0.6, -0.8))

    def found(*interfaces):
        return support_px(interfaces, 3, 0.5)

    assert found(beside, above, others) is None
    assert found(beside, below, above, others) == ((0.5, 1.0), (1.5, 0.5))
    assert found(below, turned_round) == ((0.5, 1.0), (2.0, 0.5))
    assert found(_interface(3, 0, [[2.0, 0.0]], (0.0, 1.0))) == ((1.0, 0.0), (1.0, 0.0))


def test_only_walls_that_stand_are_offered():
    seen = []

    def last(candidates, rng):  # noqa: ARG001
        seen.append([one.stone_id for one in candidates])
        return len(candidates) - 1

    made = scenes.of_rubble(scenes.RASTER).build.actions[:5]
    kept = [
        made[0],
        replace(made[1], sturdy=False),
        replace(made[2], indices=replace(made[2].indices, LLC=None)),
        replace(made[3], indices=replace(made[3].indices, LLC=0.0)),
        made[4],
    ]

    def choose(candidates):
        build, rng = Build.empty(scenes.RUBBLE_SITE, 0.58, 100.0), np.random.default_rng(0)
        proposals, policy = [one.proposal for one in candidates], SimpleNamespace(choose=last)
        return choose_by_policy(
            proposals, lambda _: candidates, policy,
            name="last", build=build, settings=PolicySettings(), rng=rng,
        )  # fmt: skip

    assert choose(kept) == (made[4], False)
    assert choose(kept[1:4]) == (None, False)
    assert seen == [[made[0].stone_id, made[4].stone_id]]


STONES = scenes.rubble(1, 6)


def by(name, changes=None):
    """A single pass with a policy, with few poses."""
    return scenes.greedy({"selection_rule": name, "orientations": "sf", **(changes or {})})


def by_mine(changes, steps=None):
    """A planner that has built a wall on pixels with a policy of another package."""
    settings = by("mine", {"geometry": "raster", **changes})
    return scenes.finish(ds.Planner(scenes.rubble(1), scenes.RUBBLE_SITE, settings=settings), steps)


def planned(settings, **options):
    """A wall of rubble, the plan of which is true."""
    result = ds.plan_wall(STONES, 100, 36, scale=1.0, settings=settings, **options)
    scenes.proven(result, STONES)
    assert len(result.plan.stone_steps) >= 4
    return result


def offered(offers):
    return {one.stone_id for one in offers}


@pytest.fixture
def installed(monkeypatch):
    """Pretend that a package has a policy, `mine`, that answers so, and tell what it is offered."""

    def install(answer=lambda _: 0, made=None):
        offers = []

        class Mine:
            def choose(self, candidates, rng):  # noqa: ARG002
                offers.append(candidates)
                return answer(candidates)

        monkeypatch.setitem(sys.modules, "mine_module", SimpleNamespace(Mine=made or Mine))
        points = EntryPoints([EntryPoint("mine", "mine_module:Mine", GROUP)])
        monkeypatch.setattr(registry, "entry_points", points.select)
        return offers

    return install


@pytest.mark.parametrize(
    ("name", "geometry"),
    [*((name, "exact") for name in ("algorithm2", *BUILT_IN)), ("towers", "raster")],
)
def test_walls_are_true_and_say_their_policy(name, geometry):
    settings = by(name, {"geometry": geometry})
    one = planned(settings, seed=3)
    if geometry == "raster":  # every policy is asked in the same place, after the threads
        two = planned(settings, seed=3, n_jobs=2)
        assert plan_to_json(one.plan) == plan_to_json(two.plan)
        assert one.wall.labels.tobytes() == two.wall.labels.tobytes()
    assert one.plan.settings["selection_rule"] == name
    assert ("policy" in one.plan.settings) == (name in BUILT_IN)
    assert ds.PlannerSettings().updated(one.plan.settings) == settings


@pytest.mark.parametrize("geometry", ["raster", "exact"])
def test_both_sides_are_offered_at_once(geometry, installed):
    seen = installed()
    by_mine({"geometry": geometry})
    assert {one.side for one in seen[0]} == {"left", "right"}
    assert offered(seen[0]) == {stone.id for stone in scenes.rubble(1)}
    assert all(one.indices.LLC and one.indices.LLC > 0 for offers in seen for one in offers)


def test_pinned_stones_come_first_an_order_is_kept_and_two_folds_are_two_choices(installed):
    seen = installed()
    planner = by_mine({"pin": [6, 4]})
    first, *_ = placed = scenes.ids(planner)
    assert {*placed[:2]} == {4, 6}
    assert [*map(offered, seen[:3])] == [{4, 6}, {4, 6} - {first}, {1, 2, 3, 5, 7, 8}]
    seen.clear()
    by_mine({"order": "given"})
    assert {len(offered(offers)) for offers in seen} == {1}
    seen.clear()
    clusters = by_mine({"sampling": "twofold"}, 1).workshop.clusters
    (first, *_), second = ([one.stone_id for one in offers] for offers in seen)
    assert {clusters[i] for i in second} == {clusters[first]}


def test_others_come_where_no_pinned_stone_can(installed):
    """The policy takes nothing where there is little to choose from."""
    seen = installed(lambda candidates: None if len(offered(candidates)) <= 2 else 0)
    assert len(scenes.ids(by_mine({"pin": [6, 4]}))) >= 4
    assert offered(seen[0]) == {4, 6}
    assert offered(next(offers for offers in seen if len(offered(offers)) > 2)) == set(range(1, 9))
    # One that takes nothing at all ends the wall, which says so.
    installed(lambda _: None)
    planner = by_mine({})
    why = Stopped("failures", "the policy took none of the places it was offered")
    assert (scenes.ids(planner), planner.stopped) == ([], why)


@pytest.mark.parametrize("rule", ["random", "paper", ""])
def test_a_policy_is_not_searched_with(rule):
    with pytest.raises(UsageError, match=f"E123 settings: .*'{rule}'"):
        ds.method_settings("best").updated({"selection_rule": rule})
    assert by("random").by_policy
    assert not scenes.greedy().by_policy
    assert not ds.PlannerSettings().by_policy


def test_the_policy_of_the_document_builds_a_wall_that_is_checked_without_it(
    installed, monkeypatch
):
    programs = printed("for-researchers.md", "python")
    (program,) = (one for one in programs if "class Largest" in one)
    names = {}
    exec(program, names)  # noqa: S102 - our own document
    installed(made=names["Largest"])
    result = planned(by("mine", {"geometry": "raster"}), seed=2)
    first = result.plan.stone_steps[0].stone
    assert first in [stone.id for stone in sorted(STONES, key=lambda s: -s.area_px)[:3]]
    monkeypatch.setattr(registry, "entry_points", lambda **_: EntryPoints())
    scenes.proven(result, STONES)
