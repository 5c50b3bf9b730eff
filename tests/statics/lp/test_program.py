"""The linear program as arrays, its twin for the simplex, HiGHS, and certificates.

Of HiGHS: warm starts, answers corrected by their last basis, and programs in standard form.
Certificates find out every single thing that can be wrong with an answer.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog, nnls
from scipy.sparse import csc_array

from drystone.contacts.blocks import model_from_labels
from drystone.kernels.cones import Figures
from drystone.statics.incremental import certified_bound
from drystone.statics.limit import resistance_between
from drystone.statics.loads import growing_with_height
from drystone.statics.local_update import least
from drystone.statics.lp.certificate import certified_fall, certify, optimum_of
from drystone.statics.lp.cone_program import ConeProgram
from drystone.statics.lp.extremes import Extreme, certified_extreme
from drystone.statics.lp.highs import HighsSession, WarmBasis, WarmSession, corrected
from drystone.statics.lp.program import EquilibriumProgram, Solution, Units, assemble, units_of
from drystone.statics.model import Block, RigidBlockModel
from drystone.statics.result import CERTIFIED, Certificate, LimitStatus
from tests.naive import columns as naive
from tests.statics.walls import boxes, coursed, empty, irregular, limit_load, with_block
from tests.strategies import repeatable


def test_units_are_those_of_a_mean_free_block_and_scale_forces_and_moments():
    blocks = (
        Block(1, 4.0, (0.0, 0.0)),
        Block(2, 12.0, (0.0, 0.0), density=3.0),
        Block(3, 99.0, (0.0, 0.0), fixed=True),
    )
    units = units_of(RigidBlockModel(blocks, ()))
    assert (units.length, units.weight) == (pytest.approx(8**0.5), 20.0)
    program = assemble(boxes([0, 0, 20, 20]), units=Units(10.0, 100.0))
    assert program.rhs == pytest.approx([0.0, 4.0, 0.0])
    matrix = program.matrix.toarray()
    assert matrix[:, 0] == pytest.approx([4.0, 0.0, 0.0])
    assert np.abs(matrix[2, 1:]) == pytest.approx([0.42, 1.58, 1.58, 0.42])


@pytest.mark.parametrize("growing", [False, True])
def test_a_saved_program_is_the_program(tmp_path, growing):
    model = model_from_labels(coursed(3, 4, 90)).model
    loads = growing_with_height(model) if growing else None
    expected = assemble(model, loads)
    expected.save(tmp_path / "failed.npz")
    program = EquilibriumProgram.load(tmp_path / "failed.npz")
    assert program.block_ids == expected.block_ids
    for name in ("rows", "start", "index", "value", "rhs", "friction"):
        assert np.array_equal(getattr(program, name), getattr(expected, name)), name
    assert (program.length, program.weight) == (expected.length, expected.weight)
    again = certified_extreme(program, HighsSession(program), 1.0)
    assert again.alpha == limit_load(model, "right", loads).alpha


UNITS = Units(13.0, 170.0)


@pytest.mark.parametrize("labels", [coursed(5, 4, 90, 3), irregular(6, 14, 90, 60)])
def test_it_grows_as_the_other_program_does(labels):
    """Block by block or two at once, an interface lost at times; of many weights and frictions."""
    model = model_from_labels(labels).model
    blocks = [replace(b, density=(1.0, 2.5)[k % 2]) for k, b in enumerate(model.blocks)]
    interfaces = [replace(i, mu=(None, 0.3, 0.0)[k % 3]) for k, i in enumerate(model.interfaces)]
    whole = RigidBlockModel(tuple(blocks), tuple(interfaces), 0.7)
    cones, model = ConeProgram.empty(UNITS), empty(whole.mu)
    rest = list(whole.blocks)
    while rest:
        size = 1 + len(rest) % 2
        blocks, rest = rest[:size], rest[size:]
        step = with_block(model, *blocks, whole=whole).added
        closed = (2, 5) if len(rest) % 7 == 4 and len(model.interfaces) > 5 else ()
        model = model.with_added(step.blocks, step.interfaces, closed)
        cones = cones.appended(model.added, cones.columns_of(model.added))
        program, count = assemble(model, units=UNITS), len(model.blocks)
        matrix = program.matrix.toarray()
        assert np.array_equal(naive.dense(cones.cones, count), matrix[:, 1:])
        assert np.array_equal(np.repeat(cones.weights, 3) * np.tile([1, 0, 0], count), matrix[:, 0])
        assert np.array_equal(cones.weights, program.rhs[1::3])
        places = [place for place, _, _ in cones.bodies.values() if place >= 0]
        assert places == list(range(count))
        assert list(cones.bodies)[1:] == list(program.block_ids)
        assert cones.centroid_x.tolist() == [block.centroid[0] for block in model.blocks]
        repeats = [2 * len(interface.points) for interface in model.interfaces]
        assert cones.interfaces.tolist() == np.repeat(np.arange(len(repeats)), repeats).tolist()


WALL = assemble(model_from_labels(coursed(5, 4, 90)).model)
PILE = assemble(boxes([0, 0, 20, 20], [0, 20, 20, 20], mu=0.0))
"""Without friction alpha is 0, and the rows of the horizontal forces depend on each other: there
are slacks in its basis."""


def ask(program, sign=1.0):
    session = WarmSession(program)
    session.start_from(WarmBasis().appended(program.column_count, len(program.rhs)))
    costs = np.zeros(program.column_count)
    costs[0] = -sign
    solution = session.minimise(costs)
    return solution, costs, session


def errors(program, solution, costs):
    left = program.rhs - program.matrix @ solution.columns
    reduced_costs = costs - program.matrix.T @ solution.duals
    carry = solution.columns > 1e-6
    return np.abs(left).max(), np.abs(reduced_costs[carry]).max(), -reduced_costs[1:].min()


@pytest.mark.parametrize("program", [WALL, PILE], ids=["wall", "pile"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_drifted_is_put_right(program, sign, monkeypatch):
    exact, costs, _ = ask(program, sign)
    honest = HighsSession.minimise

    def drifted(session, costs):
        solution = honest(session, costs)
        rng = np.random.default_rng(0)
        basic = solution.columns > 0
        columns = solution.columns + 1e-6 * rng.normal(size=len(basic)) * basic
        duals = solution.duals + 1e-6 * rng.normal(size=len(solution.duals))
        return replace(solution, columns=columns, duals=duals)

    monkeypatch.setattr(HighsSession, "minimise", drifted)
    refined, costs, _ = ask(program, sign)
    assert max(errors(program, refined, costs)) < 1e-12
    assert refined.columns == pytest.approx(exact.columns, abs=1e-10)
    assert refined.duals == pytest.approx(exact.duals, abs=1e-10)
    monkeypatch.setattr("drystone.statics.lp.highs.RESIDUAL", 1.0)
    assert errors(program, ask(program, sign)[0], costs)[0] > 1e-7


def test_duals_are_not_made_worse(monkeypatch):
    """As factors without their last digits would."""
    exact, costs, session = ask(WALL)
    monkeypatch.setattr("drystone.statics.lp.highs.RESIDUAL", -1.0)
    highs = SimpleNamespace(
        getBasicVariables=session.highs.getBasicVariables,
        getBasisSolve=session.highs.getBasisSolve,
        getBasisTransposeSolve=lambda reduced_costs: (None, np.full(len(reduced_costs), 1e-3)),
    )
    columns, duals = corrected(highs, (costs, WALL.matrix, WALL.rhs), exact.columns, exact.duals)
    assert duals is exact.duals
    assert columns == pytest.approx(exact.columns, abs=1e-12)


@given(st.integers(0, 10**6), st.integers(1, 5), st.integers(1, 9))
@repeatable(60)
def test_small_programs_have_the_optimum_of_another_solver(seed, rows, columns):
    """From any start, also from columns that depend on each other."""
    rng = np.random.default_rng(seed)
    matrix = rng.integers(-2, 3, (rows, columns)).astype(float)
    rhs = matrix @ rng.integers(0, 3, columns) if rng.random() < 0.7 else rng.normal(size=rows)
    basic = np.zeros(columns, bool)
    basic[rng.permutation(columns)[: int(rng.integers(0, rows + 1))]] = True
    costs = rng.integers(-1, 4, columns).astype(float)
    expected = linprog(costs, A_eq=matrix, b_eq=rhs)
    for start in (None, basic):
        found = least(costs, csc_array(matrix), rhs, start)
        assert (found is None) == (expected.status != 0)
        if found is not None:
            assert costs @ found[0] == pytest.approx(expected.fun, abs=1e-9)
            assert found[1] @ rhs == pytest.approx(expected.fun, abs=1e-9)
            assert np.abs(matrix @ found[0] - rhs).max() < 1e-9
            assert found[0].min() > -1e-9
            assert (costs - found[1] @ matrix).min() > -1e-9


def solution(sign, program):
    return certified_extreme(program, HighsSession(program), sign).solution


def test_the_other_end_is_no_proof():
    """A stack in balance carries nothing to the right and .75 to the left."""
    balanced = assemble(boxes([0, 0, 1, 1], [0.5, 1, 1, 1], mu=0.9))
    stale = solution(1.0, balanced)
    assert stale.columns[0] == pytest.approx(0, abs=1e-9)
    assert certify(balanced, stale, 1.0).holds
    assert not certify(balanced, stale, -1.0).holds


def test_everything_that_can_be_wrong_alone_is_found_out():
    flat = assemble(boxes([0, 0, 40, 20]))
    right, matrix = solution(1.0, flat), flat.matrix.toarray()

    def spoilt(**changed):
        found = certify(flat, replace(right, **changed), 1.0)
        assert not found.holds
        return found

    outside, unbalanced, less = (right.columns.copy() for _ in range(3))
    null = np.linalg.svd(matrix[:, 1:])[2][-1]  # a state of self-stress
    outside[1:] -= 1e3 * null * np.sign(null[np.abs(null).argmax()])
    assert spoilt(columns=outside).residual < CERTIFIED < spoilt(columns=outside).violation
    unbalanced[np.argmax(unbalanced)] += 1e-5
    assert spoilt(columns=unbalanced).residual > CERTIFIED
    less[0] -= 0.1  # forces below the best
    less[1:], _ = nnls(matrix[:, 1:], flat.rhs - matrix[:, 0] * less[0])
    assert spoilt(columns=less).residual < CERTIFIED
    assert spoilt(columns=less).gap == pytest.approx(0.1)
    closing = right.duals.copy()
    closing[2] += 1e-4  # it turns into the ground, and no load does work on that
    assert spoilt(duals=closing).gap < CERTIFIED < spoilt(duals=closing).inadmissible
    assert spoilt(duals=closing).slack > CERTIFIED


@pytest.mark.parametrize("part", ["residual", "violation", "inadmissible"])
def test_no_number_is_no_proof_and_no_fall_without_work(part):
    assert Certificate(lower=1.0, upper=1.0).holds
    assert not Certificate(lower=1.0, upper=1.0, **{part: float("nan")}).holds
    assert not Certificate(lower=1.0, upper=float("nan")).holds
    for work, error in ((float("nan"), 0.0), (-0.1, 0.0), (1e-12, 1e-11)):
        assert not Certificate(fall_work=work, inadmissible=error).holds
    assert Certificate(fall_work=0.1).holds


def test_a_wall_is_not_called_unstable_on_a_false_proof():
    """The end asked for comes back with the mechanism of the other end."""
    program = assemble(boxes([0, 0, 20, 40]))
    ends = (certified_extreme(program, HighsSession(program), sign) for sign in (-1.0, 1.0))
    least, greatest = ends
    stale = replace(greatest.solution, columns=-greatest.solution.columns)
    false = Extreme(stale, replace(greatest.certificate, lower=-0.5, upper=-0.5))
    both = resistance_between(program, least, false, 0.58)
    assert both.left.status is both.right.status is LimitStatus.FAILED


def test_no_alpha_needs_a_mechanism_that_no_live_load_holds():
    """A stone in the air falls whatever the push; an overhanging one does not."""
    floating = assemble(boxes([0, 0, 1, 1], [3, 5, 1, 1]))
    found = solution(1.0, floating)
    assert found.status is LimitStatus.UNSTABLE
    assert certify(floating, found, 1.0).holds
    overhanging = assemble(boxes([0, 0, 1, 1], [0.6, 1, 1, 1], mu=0.9))
    end = certified_extreme(overhanging, HighsSession(overhanging), 1.0)
    assert end.alpha < 0
    claimed = replace(end.solution, status=LimitStatus.UNSTABLE)
    assert not certify(overhanging, claimed, 1.0).holds


def test_self_stress_must_balance_press_and_grow_to_the_right_side():
    program = assemble(boxes([0, 0, 1, 2], [1, 0, 1, 1], fixed=(1,)))
    found = solution(-1.0, program)
    assert found.status is LimitStatus.UNBOUNDED
    assert certify(program, found, -1.0).holds
    assert certify(program, found, -1.0).lower == -np.inf
    assert certify(program, found, 1.0) is None
    ray = found.columns.copy()
    ray[1:] += 0.1
    assert not certify(program, replace(found, columns=ray), -1.0).holds
    ray = found.columns.copy()
    ray[1] = -1.0
    assert certify(program, replace(found, columns=ray), -1.0).violation > 0.1


def hanging(mu=0.58):
    """The program of a block that touches a fixed ceiling and a fixed wall to its right.

    With it come the columns of the two edges at each contact point with ceiling and wall.
    """
    model = boxes([0, 2, 3, 1], [2, 0.5, 1, 1.5], [1, 1, 1, 1], fixed=(1, 2), mu=mu)
    pairs = [(i.block, i.other) for i in model.interfaces for _ in i.points for _ in range(2)]
    found = ([k for k, pair in enumerate(pairs, 1) if pair == (3, other)] for other in (1, 2))
    return assemble(model), *found


def claims(growing, held):
    """A solver that says what it is told to say."""
    return SimpleNamespace(minimise=lambda costs: growing if costs[0] else held)


def test_no_load_is_called_without_limit_where_only_tension_carries_the_weight():
    """A block that hangs from the ceiling by tension is in balance, and falls."""
    program, ceiling, wall = hanging(mu=0.0)
    hung, ray = np.zeros((2, program.column_count))
    hung[ceiling] = -0.25
    ray[0], ray[wall] = 1.0, 0.25
    assert np.abs(program.matrix @ hung - program.rhs).max() < 1e-12
    growing = Solution(LimitStatus.UNBOUNDED, ray, None, "", "")
    held = Solution(LimitStatus.OPTIMAL, hung, np.zeros(3), "", "")
    assert certify(program, growing, 1.0).holds
    assert certified_extreme(program, claims(growing, held), 1.0).status is LimitStatus.FAILED
    rough, *_ = hanging()
    honest = HighsSession(rough).minimise(np.zeros(rough.column_count))
    assert certified_extreme(rough, claims(growing, honest), 1.0).status is LimitStatus.UNBOUNDED
    weak = claims(growing, replace(honest, columns=0.9 * honest.columns))
    assert certified_extreme(rough, weak, 1.0).status is LimitStatus.FAILED


def test_figures_in_closed_form():
    found = Figures(3.0, 1.0, 3.0, 4.0, 1.0, 8.0, 2.0)
    assert optimum_of(found, 0.25, 1) == Certificate(3.0, 1.0, 0.25, 0.25, 0.25, 0.375)
    other_end = optimum_of(found, 0.25, -1)
    assert (other_end.upper, other_end.slack, other_end.holds) == (None, None, False)
    falls = certified_fall(found)
    assert (falls.inadmissible, falls.fall_work) == (0.25, -0.5)
    assert certified_fall(found, found.live).inadmissible == 2.0
    assert certified_fall(found._replace(inadmissible=16.0), found.live).inadmissible == 4.0
    still = Figures(*[0.0] * 7)  # nothing that moves is no fall
    assert certified_fall(still).fall_work == 0.0
    assert not certified_fall(still).holds
    assert certified_bound(still, np.nan, 1, "some solver") is None
