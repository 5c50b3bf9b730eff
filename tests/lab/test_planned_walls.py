"""Planned walls are looked at on the geometry that they were planned on."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone_lab import planned_walls as agreement
from drystone_lab.planned_walls import PlannedWall, planned_walls
from drystone_lab.table import BenchSettings
from tests.verify.exact_examples import exact_example
from tests.verify.examples import example


@pytest.mark.parametrize("made", [example(), exact_example(0.5)], ids=["pixels", "outlines"])
def test_models_are_those_of_the_plan_after_every_stone(made):
    wall = PlannedWall("by hand", made.plan, made.stones)
    assert len(wall.models) == len(wall.after) == len(made.plan.stone_steps)
    claims = [step for step in made.plan.steps if step.alpha_left is not None]
    for model, step in zip(wall.models, claims, strict=True):
        found = lateral_resistance(model)
        assert found.left.alpha == pytest.approx(step.alpha_left, abs=1e-7)
        assert found.right.alpha == pytest.approx(step.alpha_right, abs=1e-7)
    np.testing.assert_array_equal(wall.after[-1].labels, made.wall.labels)
    assert wall.mu == 0.58


def test_walls_are_planned_of_the_published_sets(data_dir):
    (wall,) = planned_walls(BenchSettings(data=data_dir, quick=True, seed=2))
    assert (wall.name, len(wall.stones), wall.plan.seed) == ("PR, paper, seed 2", 32, 2)


def test_solvers_agree_on_outlines():
    made = exact_example()
    wall = PlannedWall("by hand", made.plan, made.stones)
    row = agreement._row(wall)
    assert row[:4] == ("by hand", 5, 10, 10)
    assert (row[5], row[-1]) == (10, "pass")
    assert row[8] == pytest.approx(made.plan.metrics.F_LR * 0.58)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda end: replace(end, alpha=end.alpha + 3e-8),
        lambda end: replace(end, certificate=None),
        lambda end: replace(end, status=LimitStatus.UNSTABLE, alpha=None),
    ],
)
def test_one_solver_that_says_otherwise_is_a_miss(spoil, monkeypatch):
    def other(model, *, solver):
        found = lateral_resistance(model, solver=solver)
        return replace(found, left=spoil(found.left)) if solver == agreement.SOLVERS[-1] else found

    made = exact_example(count=2)
    monkeypatch.setattr(agreement, "lateral_resistance", other)
    assert agreement._row(PlannedWall("by hand", made.plan, made.stones))[-1] == "miss"
