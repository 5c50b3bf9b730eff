import numpy as np
import pytest

from drystone.experiments import solvers
from drystone.experiments.benchmark_walls import coursed_labels
from drystone.experiments.table import BenchSettings
from drystone.statics.incremental import HighsAnalysis, SimplexAnalysis
from drystone.statics.model import RigidBlockModel

ALWAYS = tuple(set(solvers.METHODS) - {solvers.KERNEL})


@pytest.fixture(scope="module")
def tables():
    return solvers.run(BenchSettings(quick=True))


@pytest.fixture(scope="module")
def wall():
    return solvers._standing(coursed_labels(np.random.default_rng(0), 12), 12)


def test_every_method_has_its_time(tables):
    times, _ = tables
    *rows, exponents = times.records()
    assert [(row["wall"], row["stones"]) for row in rows] == [("coursed", "10"), ("coursed", "30")]
    for row in rows:
        assert all(0 < row[name] < 1e4 for name in solvers.METHODS)
        assert row["linprog / growing"] == pytest.approx(row["linprog"] / row["growing"])
    assert exponents["stones"] == "exponent"
    assert [exponents[name] for name in solvers.METHODS] == [None] * 7


def test_all_methods_agree_and_are_certified(tables):
    _, answers = tables
    rows = answers.records()
    assert [row["method"] for row in rows] == [*solvers.METHODS] * 2
    for row in rows:
        assert row["difference"] < 1e-9
        assert row["uncertified"] == row["solved cold"] == 0
        assert row["candidates"] > 3
    assert [row["difference"] == 0 for row in rows] == ([True] + 6 * [False]) * 2


def test_candidates_are_stones_on_a_wall_that_stands(wall):
    analysis = wall.analyses[solvers.GROWING]
    assert len(analysis.model.blocks) == 12
    assert analysis.result.resistance.stable
    assert len({stone.id for stone in wall.candidates}) == len(wall.candidates) > 1
    for stone in wall.candidates:
        model = wall.pattern.with_stones(analysis.model, (stone,))
        assert analysis.resistance_with(model).resistance.stable


def test_all_analyses_are_of_one_wall(wall):
    blocks = {name: analysis.model.blocks for name, analysis in wall.analyses.items()}
    assert set(blocks) == {solvers.GROWING, solvers.WARM, solvers.KERNEL}
    assert len(set(blocks.values())) == 1
    assert isinstance(wall.analyses[solvers.WARM], HighsAnalysis)
    assert isinstance(wall.analyses[solvers.KERNEL], SimplexAnalysis)
    assert wall.analyses[solvers.KERNEL].most == solvers.KERNEL_UP_TO


def test_what_does_not_stand_has_no_alpha_by_any_method(wall):
    for name, (method, analysis) in solvers._methods(wall).items():
        floating = analysis.model.with_added((wall.candidates[0],), ())
        assert method(floating) == (None, False), name


def test_the_kernel_is_left_out_where_its_inverses_are_too_large(wall):
    small = {name: wall.analyses[name] for name in (solvers.GROWING, solvers.WARM)}
    large = solvers.Standing(wall.pattern, small, wall.candidates[:2])
    timed = solvers._timed(large)
    assert set(timed) == set(ALWAYS)
    times, _ = solvers._times({("coursed", 1000): timed}).records()
    assert times["kernel"] is None
    answers = solvers._answers({("coursed", 1000): timed}).records()
    assert {row["method"] for row in answers} == set(ALWAYS)


def test_missing_answers_are_counted():
    found = [(4.0, ((0.5, 0.6), False)), (2.0, (None, True)), (9.0, ((0.5, 0.5), True))]
    timing = solvers._timing(found, [(0.5, 0.5), (0.1, 0.1)])
    assert (timing.milliseconds, timing.candidates) == (4.0, 3)
    assert (timing.unanswered, timing.cold) == (1, 2)
    assert timing.difference == pytest.approx(0.1)
    assert solvers._timing([(2.0, (None, False))], [(0.1, 0.1)]).difference is None


def test_growth_is_fitted_to_walls_of_thirty_stones_and_more():
    times = {n: 0.5 * n**1.5 for n in (30, 60, 300)}
    assert solvers._exponent({10: 99.0, **times}) == pytest.approx(1.5)
    assert solvers._exponent({10: 1.0, 30: 2.0}) is None


def test_quick_methods_are_timed_again_and_again():
    asked = []

    def method(model):
        asked.append(model)
        return (0.1, 0.1), False

    models = [RigidBlockModel((), ()), RigidBlockModel((), ())]
    found = list(solvers._measured(method, models))
    assert len(found) == 2
    assert len(asked) == 2 * solvers.REPEATS
