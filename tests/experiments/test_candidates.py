from dataclasses import replace

import numpy as np
import pytest

from drystone.experiments import candidates
from drystone.experiments.benchmark_walls import coursed_labels
from drystone.experiments.fresh_linprog import fresh_linprog
from drystone.experiments.growing_walls import Pattern, built_up
from drystone.experiments.table import BenchSettings
from drystone.statics.incremental import IncrementalResult, incremental_analysis
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.program import units_of
from drystone.statics.model import GROUND, RigidBlockModel

PATTERN = Pattern.of(coursed_labels(np.random.default_rng(0), 12))
NOTHING = incremental_analysis(RigidBlockModel((), (), PATTERN.whole.mu), units_of(PATTERN.whole))


def test_every_answer_is_that_of_linprog_and_certified():
    (table,) = candidates.run(BenchSettings(quick=True))
    assert [row["verdict"] for row in table.records()] == ["pass", "pass"]
    for row in table.records():
        assert row["candidates"] == row["same status"] == row["certified"] > 40
        assert row["candidates"] > row["stand"] > 30
        assert row["solved cold"] == 0
        assert row["difference"] <= 1e-9


@pytest.mark.parametrize(
    ("spoil", "lost"),
    [
        (lambda end: replace(end, alpha=end.alpha and end.alpha + 2e-9), None),
        (lambda end: replace(end, certificate=None), "certified"),
        (lambda end: replace(end, status="unstable", alpha=None), "same status"),
    ],
)
def test_what_is_wrong_is_a_miss(spoil, lost, monkeypatch):
    def wrong(analysis, model):
        grown = honest(analysis, model)
        resistance = grown.resistance
        return IncrementalResult(replace(resistance, left=spoil(resistance.left)))

    honest = type(NOTHING).resistance_with
    monkeypatch.setattr(type(NOTHING), "resistance_with", wrong)
    family = replace(candidates.QUICK[0], stones=3)
    row = dict(zip(candidates.COLUMNS, candidates._row(family, 0), strict=True))
    assert row["verdict"] == "miss"
    if lost is not None:
        assert row[lost] < row["candidates"]


def test_walls_are_built_from_below_of_stones_that_stand():
    *_, analysis = built_up(PATTERN, NOTHING)
    model = analysis.model
    assert lateral_resistance(model).stable
    heights = [block.centroid[1] for block in model.blocks]
    assert heights == sorted(heights)
    assert len(model.blocks) > 12
    assert len(model.interfaces) == len(
        {(i.block, i.other, i.points.tobytes()) for i in model.interfaces}
    )


def test_candidates_touch_the_wall_or_the_ground():
    on_ground = PATTERN.next_stones(NOTHING.model)
    assert {stone.centroid[1] for stone in on_ground} == {
        min(s.centroid[1] for s in PATTERN.stones)
    }
    *_, wall = (analysis for analysis, _ in zip(built_up(PATTERN, NOTHING), range(5), strict=False))
    built = {block.id for block in wall.model.blocks}
    for stone in PATTERN.next_stones(wall.model):
        model = PATTERN.with_stones(wall.model, (stone,))
        assert stone.id not in built
        assert model.blocks == (*wall.model.blocks, stone)
        assert model.added.interfaces
        assert all({i.block, i.other} <= {GROUND, stone.id, *built} for i in model.interfaces)


def test_linprog_is_asked_about_both_ends():
    *_, wall = built_up(PATTERN, NOTHING)
    found = lateral_resistance(wall.model)
    expected = (-found.left.alpha, found.right.alpha)
    assert fresh_linprog(wall.model) == pytest.approx(expected, abs=1e-9)
    stone = PATTERN.stones[-1]
    assert fresh_linprog(RigidBlockModel((stone,), (), 0.5)) is None
