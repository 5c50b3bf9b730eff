"""The items that show the method on a small run: Table 1, Figs. 3, 4, 10 and 11."""

import pytest

from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.selection.policies.registry import rule_of
from drystone_lab.reproduce import method
from tests.lab.reproduce.small_walls import RUBBLE, context, of, rows


def test_table_1_has_the_components_of_our_policies(tmp_path):
    table = rows(of("table1").make(context(tmp_path)), "table1")
    assert [row["component"] for row in table] == [name for name, *_ in method.ROWS.values()]
    for row, (_, count, _) in zip(table, method.ROWS.values(), strict=True):
        assert sum("ours" in str(row[policy]) for policy in method.MARKS) == count
    assert len({rule_of(name) for name in method.MARKS}) == 7


def test_a_run_is_followed_step_by_step(tmp_path):
    output = of("fig3-4", RUBBLE).make(context(tmp_path))
    table = rows(output, "steps")
    assert [row["step"] for row in table] == list(range(1, len(table) + 1))
    wall = context(tmp_path).wall(output.runs[0])
    stones = {placement.stone_id for placement in wall.placements}
    assert {row["stone"] for row in table} == stones
    area = sum(int((wall.labels == stone).sum()) for stone in stones)
    assert table[-1]["filled"] == pytest.approx(area / wall.labels.size, abs=1e-4)


def test_the_step_is_the_planners_own(tmp_path):
    step = method.selection_step(context(tmp_path), RUBBLE)
    stones = RUBBLE.source.stones(None)
    site = Site.from_source(*RUBBLE.size(stones), RUBBLE.scale)
    planner = Planner(stones, site, seed=1, settings=RUBBLE.run(1).settings())
    actions = [each.action for each in planner.steps()]
    chosen = step.candidates[step.selected.position]
    expected = actions[len(stones) // 2]
    assert (chosen.stone_id, chosen.indices) == (expected.stone_id, expected.indices)
    counts = [len(survivors) for survivors in step.selected.survivors]
    assert counts == [sum(n > k for n in step.passed) for k in range(len(counts))]
    table = rows(of("fig10", RUBBLE).make(context(tmp_path)), "candidates")
    assert [row["stone"] for row in table if row["chosen"]] == [chosen.stone_id]


def test_forces_on_two_stones_are_in_balance(tmp_path):
    found = method.two_stones(context(tmp_path))
    assert found.both.right.alpha == pytest.approx(found.model.mu)
    table = rows(of("fig11").make(context(tmp_path)), "forces")
    ground = [row for row in table if row["on"] == "the ground"]
    weight = int((found.labels > 0).sum())
    assert sum(r["normal force"] for r in ground) == pytest.approx(weight, abs=1e-3)
