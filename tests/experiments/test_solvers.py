import numpy as np
import pytest

from drystone.experiments import solvers
from drystone.experiments.benchmark_walls import coursed_labels
from drystone.experiments.table import BenchSettings

ANSWERED = solvers.Timing(1.0, 0.0, 0)


@pytest.fixture(scope="module")
def tables():
    return solvers.run(BenchSettings(quick=True))


def test_every_method_has_its_time(tables):
    times, _ = tables
    *rows, exponents = times.records()
    assert [(row["wall"], row["stones"]) for row in rows] == [("coursed", "10"), ("coursed", "30")]
    for row in rows:
        assert all(0 < row[name] < 1e4 for name in solvers.METHODS)
        assert row["linprog / growing"] == pytest.approx(row["linprog"] / row["growing"])
    assert exponents["stones"] == "exponent"
    assert [exponents[name] for name in solvers.METHODS] == [None] * 5


def test_all_methods_agree(tables):
    _, differences = tables
    for row in differences.records():
        assert row["HiGHS simplex"] == 0
        assert all(row[name] < 1e-9 for name in solvers.METHODS)
        assert any(row[name] > 0 for name in solvers.METHODS)


def test_candidates_are_stones_on_a_wall_that_stands():
    wall = solvers._standing(coursed_labels(np.random.default_rng(0), 12), 12)
    assert len(wall.analysis.model.blocks) == 12
    assert wall.analysis.grown.resistance.stable
    assert len({model.blocks[-1].id for model in wall.candidates}) == len(wall.candidates) > 1
    for model in wall.candidates:
        assert model.blocks[:-1] == wall.analysis.model.blocks
        assert wall.analysis.resistance_with(model).resistance.stable


def test_what_does_not_stand_has_no_alpha_in_linprog_either():
    wall = solvers._standing(coursed_labels(np.random.default_rng(0), 12), 12)
    model = wall.candidates[0]
    floats = type(model)(model.blocks, wall.analysis.model.interfaces, model.mu)
    for method in solvers._methods(wall.analysis).values():
        assert method(floats) is None


def test_missing_answers_are_counted_and_said():
    found = [(4.0, (0.5, 0.6)), (2.0, None), (9.0, (0.5, 0.5))]
    timing = solvers._timing(found, [(0.5, 0.5), (0.1, 0.1)])
    assert (timing.milliseconds, timing.unanswered) == (4.0, 1)
    assert timing.difference == pytest.approx(0.1)
    assert solvers._timing([(2.0, None)], [(0.1, 0.1)]).difference is None
    said = solvers._unanswered({("coursed", 30): {solvers.IPM: timing, solvers.GROWING: ANSWERED}})
    assert said == [
        "HiGHS ipm had no certified answer for 1 candidates of the coursed wall of 30 stones."
    ]


def test_growth_is_fitted_to_walls_of_thirty_stones_and_more():
    times = {n: 0.5 * n**1.5 for n in (30, 60, 300)}
    assert solvers._exponent({10: 99.0, **times}) == pytest.approx(1.5)
    assert solvers._exponent({10: 1.0, 30: 2.0}) is None
