"""The items that show the method on a small run: Table 1, Figs. 3, 4, 10, 11 and 17."""

import math

import pytest

from drystone.io.wall_image import read_wall_image
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from drystone.model.site import Site
from drystone.planner.planner import Planner
from drystone.selection.policies.registry import rule_of
from drystone_lab.reproduce import method
from drystone_lab.reproduce.items import ITEMS
from drystone_lab.walls import PR
from tests.lab.reproduce.small_walls import RUBBLE, context, gids, of, rows


def test_table_1_has_the_components_of_our_policies(here):
    table = rows(of("table1").make(here), "table1")
    marks = ITEMS["table1"]["marks"]
    assert [row["component"] for row in table] == list(marks)
    for row, (_, count, *_) in zip(table, marks.values(), strict=True):
        assert sum("ours" in str(row[policy]) for policy in method.MARKS) == count
    assert len({rule_of(name) for name in method.MARKS}) == 7


def test_a_run_is_followed_step_by_step(here):
    output = of("fig3-4", RUBBLE).make(here)
    table = rows(output, "steps")
    assert [row["step"] for row in table] == list(range(1, len(table) + 1))
    wall = here.wall(output.runs[0])
    stones = {placement.stone_id for placement in wall.placements}
    assert {row["stone"] for row in table} == stones
    area = sum(int((wall.labels == stone).sum()) for stone in stones)
    assert table[-1]["filled"] == pytest.approx(area / wall.labels.size, abs=1e-4)


def test_the_step_is_the_planners_own(here):
    step = method.selection_step(here, RUBBLE)
    stones = RUBBLE.source.stones(None)
    site = Site.from_source(*RUBBLE.size(stones), RUBBLE.scale)
    planner = Planner(stones, site, seed=1, settings=RUBBLE.run(1).settings())
    actions = [each.action for each in planner.steps()]
    chosen = step.candidates[step.selected.position]
    expected = actions[len(stones) // 2]
    assert (chosen.stone_id, chosen.indices) == (expected.stone_id, expected.indices)
    counts = [len(survivors) for survivors in step.selected.survivors]
    assert counts == [sum(n > k for n in step.passed) for k in range(len(counts))]
    table = rows(of("fig10", RUBBLE).make(here), "candidates")
    assert [row["stone"] for row in table if row["chosen"]] == [chosen.stone_id]


def test_forces_on_two_stones_are_in_balance(here):
    found = method.two_stones(here)
    assert found.both.right.alpha == pytest.approx(found.model.mu)
    table = rows(of("fig11").make(here), "forces")
    ground = [row for row in table if row["on"] == "the ground"]
    weight = int((found.labels > 0).sum())
    assert sum(r["normal force"] for r in ground) == pytest.approx(weight, abs=1e-3)


def test_factors_are_those_of_the_run_and_of_the_table(here):
    output = of("fig17", RUBBLE).make(here)
    (row,) = rows(output, "figures")
    (outcome,) = here.run((RUBBLE.run(1),))
    assert row["F_AV %"] == pytest.approx(outcome.figures["F_AV"], abs=1e-4)
    assert row["F_AH %"] == pytest.approx(outcome.figures["F_AH"], abs=1e-4)
    for way, name, straight in (
        ("horizontal", "F_AH %", row["straight across px"]),
        ("vertical", "F_AV %", row["straight upright px"]),
    ):
        found = [one for one in rows(output, "paths") if one["way"] == way]
        assert len(found) > 5
        excess = [one["longer than straight %"] for one in found]
        assert math.fsum(excess[:5]) / 5 == pytest.approx(row[name], abs=1e-4)
        lengths = [one["length px"] for one in found]
        assert lengths == sorted(lengths)
        assert lengths == pytest.approx([straight * (1 + e / 100) for e in excess], rel=1e-5)


def test_the_masons_wall_is_measured_beside_it(tmp_path, data_dir):
    output = of("fig17").make(context(tmp_path, data_dir))
    ours, masons = rows(output, "figures")
    assert (ours["wall"], masons["wall"]) == ("planned PR", "the masons' PR")
    labels = reduce_labels(read_wall_image(data_dir / PR.source.name), PR.scale)
    measured = measure_labels(labels)
    assert masons["F_AH %"] == pytest.approx(measured.F_AH, abs=1e-4)
    assert masons["F_AV %"] == pytest.approx(measured.F_AV, abs=1e-4)
    assert {"path-1", "path-7"} <= set(gids(output, "fig17-masons"))
