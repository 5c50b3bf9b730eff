"""Walls on outlines beside walls on pixels: bricks, of which all is known, and walls by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from drystone.drawing import wall_outlines
from drystone.experiments import exact, exact_walls
from drystone.experiments.exact_walls import BuiltWall, Target, built_walls, one_pass, targets
from drystone.experiments.table import BenchSettings
from drystone.generate.rubble import RubbleSettings, rubble_stones
from drystone.search.plan_wall import plan_wall
from tests.verify.exact_examples import exact_example

QUICK = BenchSettings(quick=True)
SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def moved(x, y):
    return SQUARE + np.array([x, y])


@pytest.fixture(scope="module")
def rows():
    (table,) = exact.run(QUICK)
    return table.records()


def by_hand(*groups, mu=0.5):
    plan = SimpleNamespace(settings={"mu": mu})
    return SimpleNamespace(groups=groups, result=SimpleNamespace(plan=plan))


def test_bricks_fill_their_wall_on_either_geometry(rows):
    assert [row["wall"] for row in rows] == ["bricks, exact", "bricks, raster"]
    for row in rows:
        assert (row["placed"], row["all placed"]) == ("9-9 of 9", "1 of 1")
        for name in ("F_SF", "F_LR", "outlines .05 px", ".1 px", ".2 px", "1 px"):
            assert row[name] == pytest.approx(1.0)
        assert (row["unstable"], row["wedges"], row["problems"]) == (0, 0, 0)
        assert row["deepest px"] == 0.0
        assert row["s"] > 0


def test_problems_and_falls_of_all_walls_are_counted(monkeypatch):
    walls = list(built_walls(QUICK, ("raster",))) * 3
    problems = iter([("one", "two"), (), ("three",)])
    monkeypatch.setattr(exact, "check_plan", lambda *_: SimpleNamespace(problems=next(problems)))
    found = iter([(None, 0.3, 0.5, 0.6), (None, None, 0.1, 0.2), (0.9, 0.9, 0.9, 0.9)])
    monkeypatch.setattr(exact, "outline_resistances", lambda _: next(found))
    row = dict(zip(exact.COLUMNS, exact._row(walls), strict=True))
    assert (row["problems"], row["unstable"], row["all placed"]) == (3, 1, "3 of 3")
    assert [row[name] for name in ("outlines .05 px", ".1 px", ".2 px", "1 px")] == [
        0,
        0.3,
        0.5,
        0.6,
    ]


def test_gaps_count_as_contacts_up_to_the_tolerance():
    wall = by_hand([(1, SQUARE)], [(2, moved(0, 10.15))])
    # Set back by .2 and by 1 px.
    near, far = (pytest.approx(value, abs=5e-3) for value in (0.953, 0.796))
    assert exact.outline_resistances(wall) == (None, None, near, far)
    wall = by_hand([(1, SQUARE)], [(2, moved(0, 10.07)), (3, moved(20, 0.5))])
    assert exact.outline_resistances(wall) == (None, None, None, far)


def test_resistance_is_that_of_the_friction_of_the_plan():
    """A tower 10 x 20 topples over its toe, which is set back by the tolerance at least."""
    tower = SQUARE * (1, 2)
    found = exact.outline_resistances(by_hand([(1, tower)], mu=0.8))
    backs = [max(tolerance, 0.01 * 200**0.5) for tolerance in exact.TOLERANCES_PX]
    assert found == pytest.approx([(5 - back) / 10 / 0.8 for back in backs])


def test_the_deepest_overlap_is_that_of_any_two():
    apart = by_hand([(1, SQUARE)], [(2, moved(10, 0))])
    assert exact.deepest(apart) == 0.0
    assert exact.deepest(by_hand([(1, SQUARE)], [(2, moved(9.7, 0))])) == pytest.approx(0.3)
    wedged = by_hand([(1, SQUARE)], [(2, moved(9.7, 0)), (3, moved(0, 9.2))])
    assert exact.deepest(wedged) == pytest.approx(0.8)


def test_medians_leave_out_what_is_not_defined():
    assert exact._median([3.0, None, 1.0, 5.0]) == 3.0
    assert exact._median([None]) is None


def test_outlines_of_a_wall_are_where_its_plan_has_them():
    example = exact_example()
    target = Target("by hand", lambda _: example.stones, 84, 30, 1.0)
    result = SimpleNamespace(wall=example.wall, plan=example.plan)
    groups = BuiltWall(target, "exact", 3, example.stones, result).groups
    assert [[block for block, _ in group] for group in groups] == [[3], [5], [7, 301], [12], [300]]
    for block, corners in (one for group in groups for one in group):
        np.testing.assert_array_equal(corners, dict(example.wall.outlines.blocks)[block])


def test_outlines_of_a_wall_of_pixels_are_those_of_its_stones_in_the_same_poses():
    stones = rubble_stones(
        RubbleSettings(width_px=200, height_px=72, courses=2, count=8), np.random.default_rng(1)
    )
    settings = replace(one_pass("raster"), orientations="10deg")
    result = plan_wall(stones, 200, 72, seed=2, settings=settings, scale=0.5)
    target = Target("rubble", lambda _: stones, 200, 72, 0.5)
    groups = BuiltWall(target, "raster", 2, stones, result).groups
    found = dict(one for group in groups for one in group)
    drawn = wall_outlines(result.wall)
    assert list(found) == list(drawn)
    turned = [step for step in result.plan.stone_steps if step.angle_deg % 90]
    assert len(turned) > 1
    for step in result.plan.stone_steps:
        np.testing.assert_allclose(found[step.stone], drawn[step.stone], atol=1e-9)
    for wedge in result.plan.wedge_steps:
        np.testing.assert_array_equal(found[wedge.id], wedge.polygon)


def test_targets_of_quick_runs_are_few_and_need_no_data():
    assert targets(QUICK) == targets(QUICK, 4) == exact_walls.QUICK
    assert targets(BenchSettings()) == exact_walls.TARGETS
    assert [target.name for target in targets(BenchSettings(), 2)] == ["R", "PR 600x160"]
    assert targets(BenchSettings())[0].stones(BenchSettings(data=None)) is None
    (bricks,) = exact_walls.QUICK
    stones = bricks.stones(QUICK)
    assert sum(stone.area_px for stone in stones) == 108 * 36
    assert bricks.size(stones) == (108, 36)
    unsized = replace(bricks, width=0, height=0)
    assert unsized.size(stones) == (stones.source.width_px, stones.source.height_px)


def test_every_target_is_planned_on_each_geometry_with_each_seed(monkeypatch):
    monkeypatch.setattr(exact_walls, "TARGETS", (exact_walls.TARGETS[0], *exact_walls.QUICK))
    walls = list(built_walls(BenchSettings(seed=5), seeds=2))
    assert [wall.name for wall in walls] == [
        f"bricks, {geometry}, seed {seed}" for geometry in ("exact", "raster") for seed in (5, 6)
    ]
    for wall in walls:
        plan = wall.result.plan
        assert (plan.settings["geometry"], plan.seed) == (wall.geometry, wall.seed)
        assert (plan.settings["search"]["budget"], plan.working_scale) == (1, 1.0)
    (twice,) = built_walls(QUICK, ("exact",), budget=2)
    assert twice.result.plan.settings["search"]["budget"] == 2
