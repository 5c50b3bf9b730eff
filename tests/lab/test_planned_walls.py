from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone_lab import planned_walls as suites
from drystone_lab.planned_walls import EngineWall, PlannedWall, planned_walls
from drystone_lab.table import BenchSettings
from drystone_lab.walls import BRICKS
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


def test_solvers_agree_on_outlines_and_one_that_says_otherwise_is_a_miss(monkeypatch):
    made = exact_example(count=2)
    wall = PlannedWall("by hand", made.plan, made.stones)
    row = suites._row(wall)
    assert (row[:4], row[5], row[-1]) == (("by hand", 2, 4, 4), 4, "pass")
    assert row[8] == pytest.approx(made.plan.metrics.F_LR * 0.58)
    for spoil in (
        lambda end: {"alpha": end.alpha + 3e-8},
        lambda _: {"certificate": None},
        lambda _: {"status": LimitStatus.UNSTABLE, "alpha": None},
    ):

        def other(model, *, solver, spoil=spoil):
            found = lateral_resistance(model, solver=solver)
            left = replace(found.left, **spoil(found.left))
            return replace(found, left=left) if solver == suites.SOLVERS[-1] else found

        monkeypatch.setattr(suites, "lateral_resistance", other)
        assert suites._row(wall)[-1] == "miss"


def test_bricks_stand_and_slide_at_their_friction():
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    walls, summary = suites.run_engine(BenchSettings(quick=True))
    (row,) = walls.records()
    assert (row["wall"], row["stones"], row["fallen"]) == ("bricks, seed 0", 9, "none")
    for name, most in (("moved most px", 0.1), ("turn deg", 0.1), ("overlap px", 0.01)):
        assert row[name] < most
    for side in ("left", "right"):
        assert row[f"alpha {side}"] == pytest.approx(0.58)
        assert row[f"tilt {side}"] == pytest.approx(0.58, abs=0.02)
    (record,) = summary.records()
    assert (record["walls"], record["nothing falls"], record["both sides"]) == (1, "1 of 1", 2)
    assert record["rank correlation"] is record["weaker side"] is None
    assert record["tilt / alpha"] == pytest.approx(1.0, abs=0.03)


def test_what_fell_or_never_falls_is_in_no_pair():
    judged = [
        EngineWall("wall", 9, SimpleNamespace(stands=tilts != (None, None)), alphas, tilts)
        for alphas, tilts in (
            ((0.1, 0.2), (0.2, 0.3)),
            ((0.3, 0.5), (0.35, 0.6)),
            ((0.4, 0.6), (0.3, None)),
            ((0.5, None), (None, None)),
            ((0.6, 0.55), (0.9, 0.7)),
        )
    ]
    (record,) = suites._summary(judged).records()
    assert (record["walls"], record["nothing falls"], record["both sides"]) == (5, "4 of 5", 7)
    # Alphas .1 .2 .3 .4 .5 .55 .6 and tilts .2 .3 .35 .3 .6 .7 .9: ranks 1 2.5 4 2.5 5 6 7.
    assert record["rank correlation"] == pytest.approx(0.93697, abs=1e-5)
    assert record["weaker side"] == pytest.approx(1.0)  # (.1, .2), (.3, .35), (.55, .7)
    # Ratios .75 1.17 1.2 1.27 1.5 1.5 2.
    assert record["tilt / alpha"] == pytest.approx(0.7 / 0.55)


def test_a_wall_that_does_not_rest_is_not_tilted(monkeypatch):
    monkeypatch.setattr(suites, "build_up", lambda *_: None)
    monkeypatch.setattr(suites, "tilt_of", lambda _: None)
    assert suites._judged(BRICKS, BRICKS.stones(None), 0).tilts == (None, None)


STONE = SimpleNamespace(labels=np.ones((40, 20), np.uint32))
WALL = SimpleNamespace(name="stone", after=(STONE,), mu=0.58)
"""A stone of 20 x 40 px topples at .5, whatever the flow rule."""


@pytest.mark.parametrize(
    ("factors", "motion", "fell", "agreement"),
    [
        ((0.5, 0.4), (0.39, 0.41), False, "yes"),
        ((0.5, 0.4), (0.41, 0.42), False, "no"),
        ((0.5, 0.4), None, False, "no"),
        ((None, None), None, True, "both fall"),
        ((0.5, 0.4), (0.0, 0.5), True, "no"),
        ((None, None), (0.1, 0.2), False, "no"),
    ],
)
def test_what_counts_as_agreement(factors, motion, fell, agreement, monkeypatch):
    simulated = SimpleNamespace(
        direction="left", fell_at_rest=fell, settled_shift=0.1, interval=lambda _: motion
    )
    both = dict(zip(("associative", "nonassociative"), factors, strict=True))
    one = SimpleNamespace(simulated=simulated, **both)
    monkeypatch.setattr(suites, "compare_with_tilt", lambda *_, **__: [one])
    assert [row[5] for row in suites._tilted_rows(WALL, BenchSettings())] == [agreement]


def test_a_picture_is_tilted_and_predicted():
    pytest.importorskip("pymunk", reason="pymunk is not installed (extra `physics`)")
    for row in suites._tilted_rows(WALL, BenchSettings(quick=True)):
        assert row[2:4] == pytest.approx((0.5, 0.5))
        low, high = (float(end) for end in row[4].split(" to "))
        assert low == pytest.approx(0.5, abs=0.01)
        assert low < high < low + 0.01
