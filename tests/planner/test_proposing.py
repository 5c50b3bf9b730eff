"""What proposers propose: on pixels, on outlines, and what each side sees of the wall."""

import math
from collections import Counter

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from drystone import Planner, PlannerSettings, Site
from drystone.kernels.polygons import Polygons, no_polygons
from drystone.kernels.profiles import StoneProfile, bare, raised
from drystone.model.landscape import Landscape
from drystone.planner.attempt import Attempt
from drystone.planner.dropping import Drop, Dropped, _rank, in_order
from drystone.planner.profile import Profile
from drystone.planner.proposing import SPARE, RasterProposer, StoneTrial, one_by_one
from drystone.planner.settling import ExactProposer
from drystone.planner.stock import Stock
from drystone.planner.views import SideView, Views
from drystone.planner.workshop import wedge_limits
from drystone.settle.rest import SettlingScene
from tests.planner import scenes
from tests.polygons import box, random_polygon
from tests.strategies import repeatable


class _Step:
    """What is tried on the wall after some steps of the default method."""

    def __init__(self, stones, site, built=0, changes=None, settings=None):
        self.settings = settings or scenes.greedy({"vary": 0.0, **(changes or {})})
        planner = scenes.finish(Planner(stones, site, settings=self.settings), built)
        self.workshop, self.build = planner.workshop, planner.build

    def proposer(self):
        kind = RasterProposer if self.settings.geometry == "raster" else ExactProposer
        return kind(self.workshop, self.settings, self.build, Profile())

    def trials(self, sides=("left", "right"), choice="candidates"):
        """All poses of all stones that are left, each by itself or those of a stone together."""
        poses = map(self.workshop.poses, self.workshop.remaining(self.build))
        groups = [*poses] if choice == "placement" else [(one,) for some in poses for one in some]
        views = [Landscape.of(self.build.wall, side) for side in sides]
        return [StoneTrial(group, view) for view in views for group in groups]


def _key(proposal):
    """What tells a proposal from others, as that of the drop from which it comes."""
    return (proposal.stone_id, proposal.trial_angle_deg, proposal.side), proposal.spot


@pytest.mark.parametrize("choice", ["candidates", "placement"])
def test_algorithm_2_compares_each_trial_where_its_first_drop_rests(choice):
    step = _Step(scenes.rubble(), scenes.RUBBLE_SITE, 2, {"selection_rule": "algorithm2"})
    trials = step.trials(choice=choice)
    proposer = step.proposer()
    (found,) = proposer.proposals(trials, one_by_one)
    expected = []
    for mine in proposer.drops(trials, one_by_one):
        assert list(mine) == sorted(mine, key=_rank)
        resting = [p for drop in mine if (p := step.proposer()._settle(drop)) is not None]
        expected += resting[:1]
    assert len(found) > 4
    assert [_key(p) for p in found] == [_key(p) for p in expected]


@pytest.mark.parametrize(("shortlist_size", "choice"), [(2, "candidates"), (6, "placement")])
def test_batches_are_those_of_all_drops_in_order(shortlist_size, choice):
    """At first a proposer knows those drops only that may be among the cheapest."""
    settle = {"shortlist": shortlist_size, "per_stone": 2}
    step = _Step(scenes.rubble(), scenes.RUBBLE_SITE, 2, {"settle": settle})
    trials = step.trials(choice=choice)
    proposer = step.proposer()
    left = [drop for mine in proposer.drops(trials, one_by_one) for drop in mine]
    left.sort(key=_rank)
    assert len({drop.key for drop in left}) == len(left) > 30
    cautious = step.proposer()
    for count, batch in enumerate(cautious.batches(trials, one_by_one)):
        if not count:
            known = {trial.key: cautious.tried[trial.key] for trial in trials}
            assert max(one.limit for one in known.values()) < np.inf
            assert sum(len(p) for one in known.values() for p in one.places) < len(left)
        expected = []
        for drop in left:
            mine = sum(one.key[0][0] == drop.key[0][0] for one in expected)
            if len(expected) < shortlist_size and mine < 2:
                expected.append(drop)
        told = [(d.cost, d.start, d.key, len(d.trial.poses)) for d in batch]
        assert told == [(d.cost, d.start, d.key, 1) for d in expected]
        left = [drop for drop in left if drop not in expected]
    assert left == []


def test_drops_whose_costs_are_equal_but_for_rounding_are_in_the_order_of_their_keys():
    step = _Step(scenes.bricks(3), Site(60, 20))
    (trials, book) = step.trials(("left",)), step.workshop.outlines
    chosen = [next(t for t in trials if t.key[0] == stone_id) for stone_id in (1, 2, 3)]
    close = [0.3, 0.1 + 0.2, 0.3 + 1e-13, 0.3 - 1e-13, 0.3 + 2e-12, 0.2]
    places = np.array([[0.0, 0.0, cost, 0.0] for cost in close])
    dropped = [
        Dropped(chosen[2], (places[[3, 5]],), np.inf),
        Dropped(chosen[1], (places[[1]],), np.inf),
        Dropped(chosen[0], (places[[2, 0, 4]],), np.inf),
    ]
    found = list(in_order(dropped, book))
    assert [(d.key[0][0], d.spot) for d in found] == [
        (3, 1), (1, 0), (1, 1), (2, 0), (3, 0), (1, 2)
    ]  # fmt: skip
    assert found == sorted(found, key=_rank)
    assert list(in_order([], book)) == []


def test_drops_are_above_what_is_there_and_inside_the_wall():
    step = _Step(scenes.rubble(), scenes.RUBBLE_SITE, 3)
    proposer = step.proposer()
    found = proposer.drops(step.trials(), one_by_one)
    assert sum(map(len, found)) > 20
    for drop in (drop for mine in found for drop in mine):
        side, posed = drop.trial.landscape.side, drop.trial.poses[0]
        scene = proposer.view(side).scene
        corners = step.workshop.outlines.hung(posed.stone, posed.angle_deg, side).turned.corners
        shape = shapely.Polygon(corners + np.array(drop.start))
        left, low, right, _ = shape.bounds
        assert -0.25 <= left < right <= scenes.RUBBLE_SITE.width_px + 0.5 + 1e-9
        assert low >= 0.0
        # At most by what a profile leaves out.
        for k in range(len(scene.polygons)):
            other = shapely.Polygon(scene.polygons.polygon(k))
            over = shapely.intersection(shape, other)
            assert over.is_empty or over.bounds[2] - over.bounds[0] <= 0.51


def _let_go(step, stone_id, angle_deg, start):
    """A stone that is let go somewhere, turned so, or by half more: then it looks the same."""
    trials = (t for t in step.trials(("left",)) if t.key[0] == stone_id)
    trial = next(t for t in trials if abs(t.key[1]) in (angle_deg, 180.0 - angle_deg))
    return step.proposer()._settle(Drop(trial, 0, start, 0.0))


def _one(method, start, post=0.0):
    """Let a slab go over a post, which stands on the ground somewhere."""
    changes = {
        "stabilise": {"method": method, "margin": 0.0}, "wedge": {"height": 1.5, "area": 2.0}
    }  # fmt: skip
    stones = scenes.blocks({1: (8, 12), 2: (30, 6), 3: (8, 14), 4: (12, 6)})
    step = _Step(stones, Site(60, 30), changes=changes)
    proposal = _let_go(step, 1, 0.0, (post + 4.02, 6.01))
    (candidate,) = Attempt(step.workshop, step.settings, step.build)._judge([proposal])
    step.build = step.build.add(candidate)
    return _let_go(step, 2, 0.0, start)


@pytest.mark.parametrize("method", ["both", "wedge", "rotation", "none"])
def test_methods_of_stabilisation(method):
    found = _one(method, (15.02, 15.5))  # both left ends at that of the wall
    if method in ("both", "wedge"):
        (wedge,) = found.stabilised.wedges
        assert (wedge.id, wedge.under) == (5, 2)
        assert wedge.corners is not None
        assert wedge.area_px > 0
        assert found.stabilised.placement.rotation_moves == 0
    else:
        assert found is None
    # With its centroid over the post it rests, whatever may be done.
    assert _one(method, (28.0, 15.5), post=25.0).stabilised.wedges == ()
    # A brick that is let go tilted by 8 degrees over bare ground is turned only by some.
    changes = {"stabilise": {"method": method}, "orientations": "8deg"}
    step = _Step(scenes.blocks({1: (20, 10)}), Site(60, 30), changes=changes)
    found = _let_go(step, 1, 4.0, (30.0, 12.0))
    if method == "none":
        assert found is None
        return
    placement, turns = found.stabilised.placement, method != "wedge"
    assert (placement.rotation_moves, len(found.stabilised.wedges)) == (turns, not turns)
    assert abs(found.trial_angle_deg) == 4.0
    expected = pytest.approx(0.0, abs=0.1) if turns else found.trial_angle_deg
    assert placement.posed.angle_deg == expected


@pytest.mark.parametrize(("height", "rests"), [(9.7, False), (9.8, True), (10.0, True)])
def test_a_stone_that_would_stand_out_over_the_top_is_none(height, rests):
    step = _Step(scenes.bricks(1), Site.from_source(60, height), changes={"orientations": "sf"})
    assert (_let_go(step, 1, 0.0, (30.0, 5.1)) is not None) == rests


def test_it_moves_beside_the_neighbour_that_it_would_overlap():
    step = _Step(scenes.bricks(2), Site(60, 20))
    stone = StoneProfile(np.zeros(20), np.zeros(20), -10.0, -5.0, 10.0, 5.0)

    def beside(x, y, *boxes):
        profile = bare(60)
        for k, corners in enumerate(boxes):
            profile = raised(profile, box(*corners), k, 1.0)
        moved, same = step.proposer()._beside((x, y), stone, profile)
        assert same == y
        return moved

    low, high = (0.0, 0.0, 20.2, 10.0), (5.0, 10.0, 20.1, 18.0)
    assert beside(30.0, 5.02, low) == pytest.approx(30.22)
    assert beside(30.0, 12.0, low, high) == pytest.approx(30.22)
    assert beside(30.0, 15.02, low, high) == pytest.approx(30.12)  # over the first one
    assert beside(30.0, 25.0, low, high) == 30.0
    assert beside(30.0, 5.02, (0.0, 10.03, 20.2, 18.0)) == 30.0  # under the other one
    assert beside(30.2, 5.02, low) == 30.2  # it touches
    assert beside(29.9, 5.02, low) == 29.9  # too far in: what the profile counts carries it
    assert beside(30.1, 5.02, low, (0.0, 2.0, 20.3, 4.0)) == pytest.approx(30.32)


@pytest.mark.parametrize(
    ("width", "changes"),
    [(60.0, {}), (59.7, {"selection_rule": "algorithm2"}), (59.7, {"two_sided": False})],
)
def test_bricks_fill_a_wall_exactly(width, changes):
    """With their clearances they are wider than the wall, but may stand out by a little."""
    settings = scenes.greedy({"orientations": "sf", **changes})
    planner = scenes.finish(
        Planner(scenes.bricks(6), Site.from_source(width, 20), settings=settings)
    )
    assert len(planner.build.actions) == 6
    assert Counter(planner.build.wall.labels.ravel().tolist()) == dict.fromkeys(range(1, 7), 200)


@scenes.RULES
def test_what_was_asked_before_does_not_matter(rule):
    """A proposer that was asked before for other trials, and for some of these, gives the same."""
    step = _Step(scenes.rubble(1), scenes.RUBBLE_SITE, 2, {"selection_rule": rule})
    trials = step.trials()
    warm = step.proposer()
    for part in (trials[3:7], trials[5:]):
        list(warm.proposals(part, one_by_one))

    def told(proposer):
        return [
            (p.stone_id, p.spot, p.cost, p.stabilised.placement.exact.corners.tobytes())
            for batch in proposer.proposals(trials[::2], one_by_one)
            for p in batch
        ]

    assert told(warm) == told(step.proposer())
    assert len(warm.tried) == len(trials) - 1


def test_wedge_limits_are_in_source_px():
    settings = PlannerSettings().updated({"stabilise": {"margin": 0.1}, "wedge": {"area": 0.2}})
    stock = Stock(
        narrowest_px=4.0, mean_height_px=20.0, mean_area_px=400.0, median_area_px=400.0,
        sides={1: (7, 30), 2: (7, 30), 9: (9, 9)},
    )  # fmt: skip
    limits = wedge_limits(settings, stock, Site(100, 50, 0.5))
    # The median stone is 20 working px in size, 40 source px.
    assert (limits.least_thickness, limits.greatest_height) == (1.6, 10.0)
    assert (limits.greatest_area, limits.room_px) == (320.0, 14.0)
    assert (limits.margin, limits.mu, limits.setback) == (0.1, 0.58, 0.01)
    assert (limits.contact_px, limits.rest, limits.steep) == (0.05, 0.4, 0.3)
    metres = wedge_limits(settings, stock, Site(100, 50, 0.5, px_per_m=500.0))
    assert (metres.least_thickness, metres.greatest_height) == (2.5, 10.0)


@pytest.mark.parametrize("built", [2, 9])
def test_by_cost_the_cheapest_come_first_and_the_others_only_when_asked_for(built, monkeypatch):
    # Looked at often, so that it stops as soon as it may.
    monkeypatch.setattr("drystone.planner.proposing.TOGETHER", 2)
    step = _Step(scenes.rubble(count=30), scenes.RUBBLE_SITE, built, settings=scenes.RASTER)
    trials, proposer = step.trials(("left",)), step.proposer()
    placed, stable = (
        scenes.watched(monkeypatch, RasterProposer, n) for n in ("spotted", "stabilised")
    )
    batches = proposer.proposals(trials, one_by_one)
    first = next(batches)
    assert len(stable) < 0.7 * len(trials)
    later = [proposal for batch in batches for proposal in batch]
    assert sorted(trial.key for (_, trial), _ in placed) == sorted(trial.key for trial in trials)
    assert len(stable) == len({one.trial.key for (_, one), _ in stable})
    costs = sorted(proposal.cost for proposal in first)
    unturned = [proposal.cost for proposal in later if _stays(proposal)]
    # None that stays where it was placed is cheaper than as many as may be analysed first.
    assert len(unturned) > 8
    assert min(unturned) >= costs[SPARE * scenes.RASTER.score.analysed - 1]
    (again, *rest) = proposer.proposals(trials, one_by_one)
    assert again == first
    assert [proposal for batch in rest for proposal in batch] == later


def _stays(proposal):
    return not (proposal.stabilised.placement.rotation_moves or proposal.stabilised.wedges)


def test_a_promise_is_the_least_that_a_stone_costs_where_it_stays():
    step, stays = _Step(scenes.rubble(count=30), scenes.RUBBLE_SITE, 6, settings=scenes.RASTER), 0
    proposer = step.proposer()
    for trial in step.trials(("left",)):
        spotted = proposer.spotted(trial)
        proposal = proposer.stabilised(spotted)
        assert (spotted.promise == math.inf) == (not spotted.spots)
        assert proposal is None or proposal.trial_angle_deg == trial.key[1]
        if proposal is not None and _stays(proposal):
            assert spotted.promise <= proposal.cost + 1e-9
            stays += 1
    assert stays > 10


@pytest.mark.parametrize("geometry", ["raster", "exact"])
def test_without_craft_there_is_no_cost(geometry):
    settings = PlannerSettings().updated({"geometry": geometry})
    step = _Step(scenes.rubble(), scenes.RUBBLE_SITE, settings=settings)
    trials = step.trials(("left",), "placement")[:3]
    (found,) = step.proposer().proposals(trials, one_by_one)
    assert [(p.stone_id, p.cost) for p in found] == [(1, 0.0), (2, 0.0), (3, 0.0)]


SITE = Site.from_source(60.3, 30, 0.5)


def heap(seed, count):
    rng = np.random.default_rng(seed)
    at = rng.uniform([5.0, 8.0], [55.0, 20.0], (count, 2))
    return [random_polygon(rng, 7, 10.0) + at[k] for k in range(count)]


def bits(view):
    return [part.tobytes() for part in (*view.scene.polygons, *view.profile)]


def seen(views, built, side):
    return views.of(built, side, 0.58, SITE.width_px, 1.0 / SITE.scale)


def at_once(built, side):
    scene = SettlingScene.of(built, SITE.extent_px[0], side, 0.58)
    profile = bare(SITE.width_px)
    for index in range(len(scene.polygons)):
        profile = raised(profile, scene.polygons.polygon(index), index, 1.0 / SITE.scale)
    return SideView(scene, profile, 1.0 / SITE.scale)


@repeatable(40)
@given(
    seed=st.integers(0, 2**32 - 1),
    asked=st.lists(st.tuples(st.booleans(), st.integers(0, 5), st.booleans()), max_size=6),
)
def test_a_view_does_not_depend_on_what_was_asked_for_before(seed, asked):
    """Of two walls that differ from the third stone on."""
    one, other = heap(seed, 5), heap(seed + 1, 5)
    found = Views(SITE.extent_px[0])
    for first, count, from_left in asked:
        polygons = one if first else [*one[:2], *other[2:]]
        built = no_polygons().added(polygons[:count])
        side = "left" if from_left else "right"
        assert bits(seen(found, built, side)) == bits(at_once(built, side))


def test_a_wall_that_differs_in_the_last_bit_of_a_corner_is_another_one():
    polygons = heap(5, 2)
    found = Views(SITE.extent_px[0])
    seen(found, no_polygons().added(polygons), "left")
    moved = polygons[0].copy()
    moved[0, 0] = np.nextafter(moved[0, 0], 99.0)
    built = no_polygons().added([moved, polygons[1]])
    assert bits(seen(found, built, "left")) == bits(at_once(built, "left"))
    split = Polygons(built.corners, np.array([0, 4, 14], np.int32), built.boxes, built.edges)
    assert seen(found, split, "left").scene.polygons.first.tolist() == [0, 4, 14]
