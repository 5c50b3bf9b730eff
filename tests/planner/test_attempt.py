"""One step: nothing is evaluated twice, the surest place is taken, and plans count it all."""

from dataclasses import replace
from itertools import count, pairwise
from types import SimpleNamespace

import numpy as np
import pytest

import drystone as ds
from drystone.model.landscape import Landscape
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Group
from drystone.planner.assemble import plan_metrics, plan_steps
from drystone.planner.attempt import SHORTLISTS, Attempt
from drystone.planner.build import Solves
from drystone.planner.evaluate import Evaluator
from drystone.planner.profile import Profile
from drystone.planner.proposing import RasterProposer
from drystone.search.whole_search import run_to_end
from drystone.statics.incremental import (
    SIMPLEX,
    HighsAnalysis,
    IncrementalAnalysis,
    IncrementalResult,
    incremental_analysis,
)
from drystone.statics.lp.highs import WARM
from tests.kernels.simplex_walls import needs_kernel
from tests.planner.scenes import RASTER, blocks, greedy, of_rubble, rubble, watched
from tests.statics.walls import gave_up


def _attempt(settings, planner=None):
    planner = planner or of_rubble(settings, 2)
    return Attempt(planner.workshop, settings, planner.build)


@pytest.mark.parametrize(
    "settings",
    [
        ds.PlannerSettings(sampling="twofold", two_sided=True),
        ds.PlannerSettings(sampling="uniform", orientations="quarter"),
        RASTER,
    ],
    ids=["two-fold", "quarter", "best"],
)
def test_nothing_is_evaluated_twice(settings, monkeypatch):
    attempt = _attempt(settings)
    spotted = watched(monkeypatch, RasterProposer, "spotted")
    judge = watched(monkeypatch, Evaluator, "judge")
    chosen = [attempt.choose(np.random.default_rng(seed)) for seed in range(4)]
    proposed = [trial.key for (_, trial), _ in spotted]
    judged = [(p.stone_id, p.trial_angle_deg, p.side) for (*_, p), _ in judge]
    assert len(set(proposed)) == len(proposed) == attempt.candidates
    assert len(set(judged)) == len(judged) > 0
    # What was tried before does not shape the choice.
    for seed, one in enumerate(chosen):
        fresh = _attempt(settings).choose(np.random.default_rng(seed))
        assert (one.stone_id, one.side, one.indices) == (fresh.stone_id, fresh.side, fresh.indices)
        assert one.course_height_px == fresh.course_height_px


@pytest.mark.parametrize(("clearance_px", "proposed"), [(0, True), (1, True), (2, False)])
def test_a_stone_that_turns_keeps_its_clearance(clearance_px, proposed):
    """From where it is stabilised it moves into a slot with one px to spare on both sides."""
    placing = {"reach": "above", "clearance_px": clearance_px}
    settings = greedy({"geometry": "raster", "placement": placing})
    planner = ds.Planner(blocks({1: (20, 10), 2: (20, 10)}), ds.Site(60, 40), settings=settings)
    proposer = RasterProposer(planner.workshop, settings, planner.build, Profile())
    posed = planner.workshop.poses(1)[0]
    assert posed.mask.shape == (10, 20)
    slot = np.zeros((40, 60), bool)
    slot[10:, :19] = slot[10:, 41:] = True
    turned = Group(Placement(posed, 30, 20, "left", 1))
    assert proposer._reached(Landscape(slot, ()), turned) is proposed


BRICKS = {k: (9 + k, 12) for k in range(1, 13)}


def _chosen(falls):
    """Choose a first brick of which some are sure; also return the stones in order of cost."""
    alone = {"shortlist": 1, "per_stone": 1, "spots": 1}
    settings, asked = greedy({"settle": alone, "two_sided": False, "orientations": "sf"}), []

    def told(group, _, least):
        asked.append(group.placement.stone_id)
        share = falls.get(asked[-1], 0.5)  # so often all other stones fall
        return share if share < least else None

    planner = ds.Planner(blocks(BRICKS), ds.Site(60, 40), settings=settings)
    workshop = replace(planner.workshop, seats=SimpleNamespace(falls=told))
    found = Attempt(workshop, settings, planner.build).choose(np.random.default_rng(0))
    return found.stone_id, asked


def test_the_surest_place_of_the_first_shortlists_is_taken():
    first, asked = _chosen({})
    assert first == asked[0]
    assert len(asked) == SHORTLISTS
    # A place that is sure is taken where it comes.
    for stone in asked[1], asked[-1]:
        assert _chosen({stone: 0.0})[0] == stone
    # Where none is, the one that falls least; what comes later is not asked for.
    assert _chosen({asked[3]: 0.2, asked[5]: 0.3})[0] == asked[3]
    later = next(stone for stone in BRICKS if stone not in asked)
    assert _chosen({later: 0.0}) == (first, asked)
    # Where a place is sure at once, no trial of another counts.
    assert _chosen({asked[0]: 0.0})[1] == asked[:1]


FULL = ds.PlannerSettings(sampling="full", two_sided=True)


@pytest.mark.parametrize(
    ("settings", "large"),
    [(FULL, False), (greedy(), False), pytest.param(FULL, True, marks=needs_kernel)],
    ids=["paper", "best", "large"],
)
def test_every_candidate_is_as_strong_as_its_model_analysed_whole(settings, large, monkeypatch):
    """Of those for a large wall the weaker side is enough; what is built knows both sides."""
    planner = of_rubble(settings, 0)
    if large:
        begun = planner.build
        few = incremental_analysis(begun.model, begun.analysis.program.units, most=1)
        planner.build = replace(begun, grown_from=few)
    judge = watched(monkeypatch, Evaluator, "judge")
    run_to_end(planner)
    judged, actions = [candidate for _, candidate in judge], planner.build.actions
    assert len(judged) > len(actions) > 4
    assert (sum(candidate.resistance.one_sided for candidate in judged) > 4) == large
    assert not any(action.resistance.one_sided for action in actions)
    for candidate in (*judged, *actions):
        whole, mine = ds.lateral_resistance(candidate.model), candidate.resistance
        assert mine.stable == whole.stable
        assert candidate.indices.LLC == pytest.approx(mine.value, abs=1e-9)
        assert mine.value == pytest.approx(whole.value, abs=1e-9)
        assert candidate.solves == Solves()
        for found, sought in ((mine.left, whole.left), (mine.right, whole.right)):
            exact = candidate in actions or not mine.one_sided
            assert found.alpha == pytest.approx(sought.alpha, abs=1e-9) or not exact
            assert sought.alpha is None or found.alpha <= sought.alpha + 1e-9
            # From the bases of the wall, not from the start.
            assert large or (found.certificate.holds and found.solver in {SIMPLEX, WARM})
    assert len({candidate.resistance.left.alpha for candidate in judged}) > 5


def test_states_are_kept_only_to_go_back_to_them():
    for rounds in (0, 1):
        settings = greedy({"search": {"budget": rounds + 1}})
        planner, again = of_rubble(settings, 0), of_rubble(settings, 0)
        builds = [planner.build, *(step.build for step in planner.steps())]
        assert planner.build.states() == (tuple(builds) if rounds else (planner.build,))
        again.restore(planner.build.wall, {})
        states = again.build.states()
        assert len(states) == (len(builds) if rounds else 1)
        for state, build in zip(states, builds[-len(states) :], strict=True):
            assert state.wall.labels.tobytes() == build.wall.labels.tobytes()
        assert all(one is other.before for one, other in pairwise(states))


def test_the_unit_of_weight_is_a_stone_of_the_set(monkeypatch):
    """Certificates must not depend on which stones were placed, as in a resumed plan."""
    asked = watched(monkeypatch, IncrementalAnalysis, "resistance_with")
    planner, again = of_rubble(greedy({"search": {"budget": 2}}), 0), of_rubble(greedy(), 0)
    run_to_end(planner)
    again.restore(planner.build.wall, {})
    programs = [
        one if isinstance(one, HighsAnalysis) else vars(one)["program"] for (one, _), _ in asked
    ]
    area = planner.workshop.stock.mean_area_px
    assert {(of.units.length, of.units.weight) for of in programs} == {(np.sqrt(area), area)}


def test_multipliers_stand_at_the_last_step_of_a_group_and_areas_are_of_the_source():
    # A slab of 40 x 8 source px on two wedges of 4 x 2 working px.
    site = ds.Site.from_source(60, 40, 0.5, 200.0)
    planner = ds.Planner(blocks({7: (40, 8)}), site)
    posed, row = planner.workshop.poses(7)[0], site.height_px - 2
    wedges = [Wedge(8 + k, 7, np.ones((2, 4), bool), row, col) for k, col in ((0, 2), (1, 16))]
    placement = Placement(posed, row - posed.height_px, 1)
    planner.restore(planner.build.wall.add(placement, tuple(wedges)), {})
    build = planner.build
    steps = plan_steps(build, {7: 1})
    assert [(step.step, step.kind) for step in steps] == [(1, "stone"), (2, "wedge"), (3, "wedge")]
    assert [step.alpha_left is None for step in steps] == [True, True, False]
    assert steps[-1].alpha_right == build.actions[0].resistance.right.alpha
    corners = np.array(steps[1].polygon) * 100  # metres
    assert [*corners.min(axis=0), *corners.max(axis=0)] == pytest.approx([2.0, 0.0, 6.0, 2.0])
    metrics = plan_metrics(build, build.actions[-1].resistance)
    # 16 working px of 2 source px each way, 200 source px in a metre
    assert metrics.wedge_area == pytest.approx(16 * (2 / 200) ** 2)
    assert metrics.F_SF == pytest.approx(40 * 8 / (60 * 40))
    # A stone of 5 x 3 source px is 3 x 2 or 2 x 2 px at half size, never 3.75.
    result = ds.plan_wall(blocks({1: (5, 3)}), 10, 8, method="paper", scale=0.5)
    assert result.metrics.F_SF == pytest.approx(15 / 80)


def test_a_plan_says_which_method_made_it_and_whether_it_is_complete():
    own = ds.method_settings("paper").updated({"sampling": "full"})
    for options, method in (
        ({"method": "paper"}, "paper"), ({"settings": own}, "custom"),
        ({"settings": own, "method": "paper"}, "paper"),
    ):  # fmt: skip
        result = ds.plan_wall(blocks({1: (20, 10)}), 40, 10, scale=1.0, **options)
        assert result.plan.method == method
    # Where nothing can be placed it is incomplete: a stone on its tip that may not be turned.
    tip = ds.StoneSet((ds.Stone(1, np.triu(np.ones((12, 12), bool))),))
    changes = {"orientations": "sf", "stabilise": {"method": "none"}}
    settings = ds.method_settings("paper").updated(changes)
    result = ds.plan_wall(tip, 14, 14, scale=1.0, settings=settings)
    assert (result.status, result.plan.steps) == ("incomplete", ())
    told = vars(result.metrics).items()
    assert [name for name, value in told if value is not None] == ["F_SF", "wedge_area"]


@pytest.mark.parametrize("failing", [0, 1])
def test_candidates_on_which_the_solver_gave_up_are_counted_and_said(failing, monkeypatch):
    """Also where it gave up on the sturdy model alone, which is the second."""
    calls, analyse = count(), IncrementalAnalysis.resistance_with

    def fails_once(analysis, model):
        if next(calls) != failing:
            return analyse(analysis, model)
        return IncrementalResult(gave_up(model.mu), solved_cold=True)

    monkeypatch.setattr(IncrementalAnalysis, "resistance_with", fails_once)
    stones = blocks({1: (20, 10), 2: (20, 10), 3: (20, 10)})
    result = ds.plan_wall(stones, 60, 10, scale=1.0, settings=greedy())
    (notice,) = (one for one in result.notices if one.code == "W303")
    assert "gave up on 1 candidates" in notice.message
    assert result.solves == Solves(failed=1, cold=1)


def test_candidates_that_were_solved_again_are_counted_and_change_nothing(monkeypatch):
    def planned(budget):
        settings = greedy({"search": {"budget": budget}})
        return ds.plan_wall(rubble(1, 7), 100, 36, scale=1.0, seed=1, settings=settings)

    def again(_, model):
        return IncrementalResult(ds.lateral_resistance(model), solved_cold=True)

    plain = planned(1)
    assert (plain.notices, plain.solves) == ((), Solves())
    monkeypatch.setattr(IncrementalAnalysis, "resistance_with", again)
    one, two = planned(1), planned(2)
    assert one.wall.labels.tobytes() == plain.wall.labels.tobytes()
    assert (one.notices, one.solves.failed) == ((), 0)  # it costs time alone
    assert two.solves.cold > one.solves.cold > 20  # those of the second wall are counted as well
