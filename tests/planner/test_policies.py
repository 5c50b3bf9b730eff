"""Walls of policies: true, repeatable, and chosen by the policy."""

import re
import sys
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from types import ModuleType

import pytest

from drystone.errors import UsageError
from drystone.io.plan_json import plan_to_json
from drystone.planner.planner import Planner
from drystone.planner.settings import PlannerSettings, method_settings
from drystone.search.plan_wall import plan_wall
from drystone.selection.policies import registry
from drystone.selection.policies.registry import BUILT_IN, GROUP
from tests.planner.scenes import RUBBLE_SITE, finish, greedy, proven, rubble

PAGE = Path(__file__).resolve().parents[2] / "docs" / "for-researchers.md"
RASTER = {"geometry": "raster"}
STONES = rubble(1, 6)


def by(name, changes=None):
    """A single pass with a policy, with few poses."""
    return greedy({"selection_rule": name, "orientations": "sf", **(changes or {})})


def planned(settings, **options):
    """A wall of rubble, the plan of which is true."""
    result = plan_wall(STONES, 100, 36, scale=1.0, settings=settings, **options)
    proven(result, STONES)
    assert len(result.plan.stone_steps) >= 4
    return result


def built(settings):
    return finish(Planner(rubble(1), RUBBLE_SITE, settings=settings))


def ids(offers):
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
    if geometry == "raster":  # every policy is asked in the same place, after the threads
        two = planned(settings, seed=3, n_jobs=2)
        assert plan_to_json(one.plan) == plan_to_json(two.plan)
        assert one.wall.labels.tobytes() == two.wall.labels.tobytes()
    assert one.plan.settings["selection_rule"] == name
    assert ("policy" in one.plan.settings) == (name in BUILT_IN)
    assert PlannerSettings().updated(one.plan.settings) == settings


@pytest.mark.parametrize("geometry", ["raster", "exact"])
def test_both_sides_are_offered_at_once(geometry, seen):
    built(by("mine", {"geometry": geometry}))
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


def test_pinned_stones_come_first_and_an_order_is_kept(seen):
    planner = built(by("mine", {**RASTER, "pin": [6, 4]}))
    assert {action.stone_id for action in planner.build.actions[:2]} == {4, 6}
    assert [ids(offers) for offers in seen[:3]] == [
        {4, 6},
        {4, 6} - {planner.build.actions[0].stone_id},
        {1, 2, 3, 5, 7, 8},
    ]
    seen.clear()
    built(by("mine", {**RASTER, "order": "given"}))
    assert {len(ids(offers)) for offers in seen} == {1}


def test_others_come_where_no_pinned_stone_can(installed):
    """The policy takes nothing where there is little to choose from."""
    seen = installed(lambda candidates: None if len(ids(candidates)) <= 2 else 0)
    assert len(built(by("mine", {**RASTER, "pin": [6, 4]})).build.actions) >= 4
    assert ids(seen[0]) == {4, 6}
    assert ids(next(offers for offers in seen if len(ids(offers)) > 2)) == set(range(1, 9))
    # One that takes nothing at all ends the wall.
    installed(lambda _: None)
    full = built(by("mine", RASTER))
    assert (full.build.actions, full.stopped.reason) == ((), "failures")


@pytest.mark.parametrize("rule", ["random", "paper", ""])
def test_a_policy_is_not_searched_with(rule):
    with pytest.raises(UsageError, match=f"E123 settings: .*'{rule}'"):
        method_settings("best").updated({"selection_rule": rule})
    assert by("random").by_policy
    assert not greedy().by_policy
    assert not PlannerSettings().by_policy


def test_the_policy_of_the_document_builds_a_wall_that_is_checked_without_it(
    installed, monkeypatch
):
    text = PAGE.read_text(encoding="utf-8")
    programs = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    (program,) = (one for one in programs if "class Largest" in one)
    names = {}
    exec(compile(program, PAGE.name, "exec"), names)  # noqa: S102 - our own document
    installed(made=names["Largest"])
    result = planned(by("mine", RASTER), seed=2)
    first = result.plan.stone_steps[0].stone
    assert first in [stone.id for stone in sorted(STONES, key=lambda s: -s.area_px)[:3]]
    monkeypatch.setattr(registry, "entry_points", lambda **_: EntryPoints())
    proven(result, STONES)
