"""Walls of policies: true, repeatable, and chosen by the policy."""

import json
import re
import sys
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from types import ModuleType

import pytest

from drystone.errors import UsageError
from drystone.io.plan_json import plan_from_json, plan_to_json
from drystone.planner.attempt import Attempt
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.plan_wall import plan_wall
from drystone.selection.policies import registry
from drystone.selection.policies.registry import BUILT_IN, GROUP
from drystone.verify import check_plan
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, order, rubble

PAGE = Path(__file__).resolve().parents[2] / "docs" / "for-researchers.md"
GEOMETRIES = ("raster", "exact")
RASTER = {"geometry": "raster"}


def by(name, changes=None):
    """A single pass with a policy, with few poses."""
    return greedy({"selection_rule": name, "orientations": "sf", **(changes or {})})


def true(result, stones):
    """See that a plan, written and read again, is true."""
    plan = plan_from_json(json.loads(json.dumps(plan_to_json(result.plan))))
    report = check_plan(plan, stones, wall_labels=result.wall.labels)
    assert report.problems == ()
    assert len(plan.stone_steps) >= 4


def ids(offers):
    return {one.stone_id for one in offers}


def planned(settings, **options):
    return plan_wall(rubble(1), 100, 36, scale=1.0, settings=settings, **options)


@pytest.fixture
def installed(monkeypatch):
    """Pretend that a package has a policy, `mine`, that answers so, and tell what it is offered."""

    def install(answer=lambda _: 0, made=None):
        offers = []

        class Mine:
            def choose(self, candidates, rng):  # noqa: ARG002
                offers.append(candidates)
                return answer(candidates)

        module = ModuleType("mine_module")
        module.Mine = made or Mine
        monkeypatch.setitem(sys.modules, "mine_module", module)
        points = EntryPoints([EntryPoint("mine", "mine_module:Mine", GROUP)])
        monkeypatch.setattr(registry, "entry_points", points.select)
        return offers

    return install


@pytest.fixture
def seen(installed):
    """What a policy is offered that takes the first."""
    return installed()


@pytest.mark.parametrize(
    ("name", "geometry"),
    [*((name, "exact") for name in ("algorithm2", *BUILT_IN)), ("towers", "raster")],
)
def test_walls_are_true_and_say_their_policy(name, geometry):
    settings = by(name, {"geometry": geometry})
    one = planned(settings, seed=3)
    true(one, rubble(1))
    if geometry == "raster":  # every policy is asked in the same place, after the threads
        two = planned(settings, seed=3, n_jobs=2)
        assert plan_to_json(one.plan) == plan_to_json(two.plan)
        assert one.wall.labels.tobytes() == two.wall.labels.tobytes()
    assert one.plan.settings["selection_rule"] == name
    assert ("policy" in one.plan.settings) == (name in BUILT_IN)
    again = PlannerSettings().updated(one.plan.settings)
    assert again == settings


def test_random_depends_on_the_seed():
    walls = [
        order(finish(Planner(rubble(1), RUBBLE_SITE, seed=seed, settings=by("random", RASTER))))
        for seed in (1, 2, 1)
    ]
    assert walls[0] == walls[2] != walls[1]


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_both_sides_are_offered_at_once(geometry, seen):
    finish(Planner(rubble(1), RUBBLE_SITE, settings=by("mine", {"geometry": geometry})))
    assert {one.side for one in seen[0]} == {"left", "right"}
    assert ids(seen[0]) == {stone.id for stone in rubble(1)}
    assert all(one.indices.LLC and one.indices.LLC > 0 for offers in seen for one in offers)


def test_two_folds_are_two_choices(seen):
    settings = by("mine", {**RASTER, "sampling": "twofold"})
    planner = Planner(rubble(1), RUBBLE_SITE, settings=settings)
    next(iter(planner.steps()))
    clusters = planner.workshop.clusters
    assert len(seen) == 2
    first, second = ([one.stone_id for one in offers] for offers in seen)
    assert {clusters[i] for i in second} == {clusters[first[0]]}


def test_pinned_stones_come_first(seen):
    settings = by("mine", {**RASTER, "pin": [6, 4]})
    planner = finish(Planner(rubble(1), RUBBLE_SITE, settings=settings))
    assert {action.stone_id for action in planner.build.actions[:2]} == {4, 6}
    assert [ids(offers) for offers in seen[:3]] == [
        {4, 6},
        {4, 6} - {planner.build.actions[0].stone_id},
        {1, 2, 3, 5, 7, 8},
    ]


def test_others_come_where_no_pinned_stone_can(installed):
    """The policy takes nothing where there is little to choose from."""
    seen = installed(lambda candidates: None if len(ids(candidates)) <= 2 else 0)
    settings = by("mine", {**RASTER, "pin": [6, 4]})
    planner = finish(Planner(rubble(1), RUBBLE_SITE, settings=settings))
    assert len(planner.build.actions) >= 4
    assert ids(seen[0]) == {4, 6}
    assert ids(next(offers for offers in seen if len(ids(offers)) > 2)) == set(range(1, 9))


def test_the_rule_of_an_order_is_kept(seen):
    finish(Planner(rubble(1), RUBBLE_SITE, settings=by("mine", {**RASTER, "order": "given"})))
    assert all(len(ids(offers)) == 1 for offers in seen)


def test_a_policy_that_takes_nothing_ends_the_wall(installed):
    installed(lambda _: None)
    full = finish(Planner(rubble(1), RUBBLE_SITE, settings=by("mine", RASTER)))
    assert full.build.actions == ()
    assert full.stopped.reason == "failures"


def test_a_broken_policy_ends_the_plan(installed):
    installed(len)
    with pytest.raises(UsageError, match=r"E147 .*'mine' returned"):
        planned(by("mine", RASTER))


def test_an_unknown_policy_is_refused_when_it_is_to_choose():
    settings = by("unheard of", RASTER)
    planner = Planner(rubble(1), RUBBLE_SITE, settings=settings)
    with pytest.raises(UsageError, match="E146"):
        next(iter(planner.steps()))
    with pytest.raises(UsageError, match="E146"):
        Attempt(planner.workshop, settings, planner.build)


def test_a_wall_is_checked_without_its_policy(installed, monkeypatch):
    installed()
    result = planned(by("mine", RASTER))
    monkeypatch.setattr(registry, "entry_points", lambda **_: EntryPoints())
    true(result, rubble(1))


@pytest.mark.parametrize("rule", ["random", "paper", ""])
def test_a_policy_is_not_searched_with(rule):
    with pytest.raises(UsageError, match=f"E123 settings: .*'{rule}'"):
        method_settings("best").updated({"selection_rule": rule})
    assert by("random").by_policy
    assert not greedy().by_policy
    assert not PlannerSettings().by_policy


def test_plans_without_a_policy_say_nothing_of_policies():
    for method in ("paper", "best"):
        assert "policy" not in method_settings(method).as_dict()


def test_the_policy_of_the_document_builds_a_wall(installed):
    text = PAGE.read_text(encoding="utf-8")
    programs = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    (program,) = (one for one in programs if "class Largest" in one)
    names = {}
    exec(compile(program, PAGE.name, "exec"), names)  # noqa: S102 - our own document
    installed(made=names["Largest"])
    result = planned(by("mine", RASTER), seed=2)
    true(result, rubble(1))
    first = result.plan.stone_steps[0].stone
    assert first in [stone.id for stone in sorted(rubble(1), key=lambda s: -s.area_px)[:3]]
