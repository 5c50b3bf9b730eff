"""Walls that grow: as strong as walls analysed whole, and believed only where it is proved."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given

from drystone.contacts.blocks import model_from_labels, model_with
from drystone.kernels import simplex
from drystone.kernels.cones import Figures, figures
from drystone.kernels.simplex import Cones, Optimum
from drystone.statics import incremental
from drystone.statics.incremental import (
    LOCAL,
    NO_WEAKER,
    SIMPLEX,
    certified_bound,
    incremental_analysis,
)
from drystone.statics.limit import lateral_resistance
from drystone.statics.local_update import Near, local_update
from drystone.statics.lp.highs import WARM, WarmSession
from drystone.statics.lp.program import Units
from drystone.statics.model import GROUND, Addition
from drystone.statics.result import CERTIFIED, LimitStatus
from tests.kernels.simplex_walls import needs_kernel
from tests.statics.walls import boxes, coursed, empty, irregular, stacked, with_block
from tests.strategies import repeatable, walls

PX = Units(15.0, 225.0)

SOLVERS = {"simplex": {SIMPLEX}, "local": {SIMPLEX, LOCAL, WARM}, "highs": {WARM}}
"""What the incremental analysis falls through, from the top, the middle, and the bottom, and who
answers there about walls that stand."""


def upwards(labels):
    whole = model_from_labels(labels).model
    return whole, sorted(whole.blocks, key=lambda block: block.centroid[1])


def wall_and_candidates(labels, count, begin=incremental_analysis):
    """The analysis of the lowest blocks, and models with each of the others that stand on them."""
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    for block in blocks[:count]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def assert_same(result, model, solvers):
    """As the ordinary analysis says, certified, and found from what was known of the wall."""
    expected, both = lateral_resistance(model), result.resistance
    assert not result.solved_cold
    assert both.value == pytest.approx(expected.value, abs=1e-9)
    for direction in ("left", "right"):
        found = getattr(both, direction)
        sought = getattr(expected, direction)
        assert found.direction == direction
        assert found.solver in solvers
        if both.one_sided and found.message == NO_WEAKER:
            proof = found.certificate
            assert found.alpha == abs(proof.lower) <= sought.alpha + 1e-9
            assert found.alpha == both.left.alpha == both.right.alpha
            assert max(proof.residual, proof.violation) <= CERTIFIED
            continue
        assert (found.status, found.message) == (sought.status, sought.message)
        assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
        assert found.certificate.holds
    assert result.resistance.mu == model.mu


def grown(analysis, model, solvers):
    """The analysis with one more stone, as strong as the model is, whether asked or grown."""
    found, extended = analysis.resistance_with(model), analysis.extended(model)
    assert_same(found, model, solvers)
    assert_same(extended.result, model, solvers)
    assert not extended.result.resistance.one_sided
    if not isinstance(analysis, incremental.LocalAnalysis):
        assert bits(extended.result) == bits(found)
    return extended


def bits(result):
    both = result.resistance.left, result.resistance.right
    return [(r.status, r.alpha, r.certificate, r.solver) for r in both]


@pytest.fixture(params=list(SOLVERS))
def name(request):
    return request.param


@pytest.fixture
def begin(name, monkeypatch):
    """What begins a wall that is analysed by it."""
    if name == "highs":
        monkeypatch.setattr(simplex, "AVAILABLE", False)
        return incremental_analysis
    if not simplex.AVAILABLE:
        pytest.skip("the simplex kernel is not compiled here")
    return partial(incremental_analysis, most=0) if name == "local" else incremental_analysis


@pytest.mark.parametrize("labels", [coursed(1, 5, 110, 2), irregular(3, 18, 100, 70)])
def test_walls_grown_stone_by_stone_are_as_strong_as_walls_analysed_whole(labels, begin, name):
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    unstable = 0
    solvers = set()
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        after = grown(analysis, model, SOLVERS[name])
        found = after.result.resistance
        solvers.add((found.left.solver, found.right.solver))
        if found.stable:
            analysis = after
            assert bits(analysis.resistance_with(analysis.model)) == bits(analysis.result)
            assert analysis.extended(analysis.model).model is analysis.model
            assert analysis.model.interfaces is model.interfaces
            assert analysis.model.added is None
        unstable += not found.stable
    assert len(analysis.model.blocks) == len(blocks) - unstable > 10
    assert set().union(*solvers) == SOLVERS[name]
    # Each end is looked for near the stone first, whatever the other one needs.
    assert any(one != other for one, other in solvers) == (name == "local")


def test_a_wall_that_fell_can_be_propped(begin, name):
    """Growing goes on after a stone that falls; the next one holds it."""
    whole = boxes([0, 0, 20, 20], [14, 20, 20, 20], [24, 0, 16, 20])
    stone, falling, prop = whole.blocks
    alone = with_block(empty(), stone, whole=whole)
    fallen = begin(alone, PX).extended(with_block(alone, falling, whole=whole))
    assert fallen.result.resistance.left.status is LimitStatus.UNSTABLE
    propped = with_block(fallen.model, prop, whole=whole)
    assert fallen.resistance_with(propped).resistance.stable
    assert_same(fallen.resistance_with(propped), propped, {*SOLVERS[name], WARM})


def test_walls_of_pixels_with_contacts_at_points(begin, name):
    """Stones of any shape on each other: points that close, stones that fall or float."""

    @repeatable(8)
    @given(walls(max_stones=6))
    def check(wall):
        analysis = begin(empty(), Units(5.0, 25.0))
        built = type(wall).empty(wall.site)
        for group in wall.groups:
            model = model_with(analysis.model, built.labels, group.placement, group.wedges)
            analysis = grown(analysis, model, {*SOLVERS[name], WARM})
            built = built.add(group.placement, group.wedges)

    check()


def test_contacts_that_carry_may_go(begin, name):
    """With a stone or without one; the gaps that they leave in the bases are filled."""
    solvers = {*SOLVERS[name], WARM}
    analysis, (model,) = wall_and_candidates(coursed(6, 4, 80), -1, begin)
    stone, changed = model.added, 0
    for gone in range(0, len(analysis.model.interfaces), 5):
        without = analysis.model.with_added((), (), (gone,))
        assert_same(analysis.resistance_with(without), without, solvers)
        model = analysis.model.with_added(stone.blocks, stone.interfaces, (gone,))
        found = analysis.resistance_with(model)
        assert_same(found, model, solvers)
        changed += found.resistance.value != analysis.result.resistance.value
        if gone % 10 == 0:
            extended = grown(analysis, model, solvers)
            # What is left has moved up.
            again = extended.model.with_added((), (), (gone,))
            assert_same(extended.resistance_with(again), again, solvers)
    assert changed > 1


def test_neither_order_nor_threads_change_a_bit(begin):
    analysis, candidates = wall_and_candidates(irregular(0, 18, 90, 70), 12, begin)
    expected = [bits(analysis.resistance_with(model)) for model in candidates]
    backwards = [bits(analysis.resistance_with(model)) for model in reversed(candidates)]
    assert backwards[::-1] == expected
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(analysis.resistance_with, candidates * 2))
    assert [bits(one) for one in found] == expected * 2
    again, same = wall_and_candidates(irregular(0, 18, 90, 70), 12, begin)
    assert [bits(again.resistance_with(model)) for model in same] == expected
    for model in candidates:
        grown(analysis, model, {SIMPLEX, LOCAL, WARM})


def test_any_other_model_is_answered_too(begin):
    analysis, candidates = wall_and_candidates(coursed(2, 4, 80), 8, begin)
    model = candidates[0]
    odd = ({"held": ("turn",)}, {"density": 0.0}, {"fixed": True})
    others = [
        replace(model, mu=0.4),
        replace(model, blocks=model.blocks[::-1]),
        replace(model, blocks=(replace(model.blocks[0], density=9.0), *model.blocks[1:])),
        replace(model, interfaces=model.interfaces[4:] + model.interfaces[:4]),
        replace(analysis.model, mu=0.3).with_added(model.added.blocks, model.added.interfaces),
        *(
            analysis.model.with_added((replace(model.blocks[-1], **one),), model.added.interfaces)
            for one in odd
        ),
        boxes([0, 0, 20, 40]),
    ]
    for other in others:
        grown(analysis, other, {WARM})


def test_nothing_free_carries_anything(begin):
    base = boxes([0, 0, 2, 1], fixed=(1,))
    analysis = begin(empty(), PX)
    for model in (empty(), base, empty().with_added((), ()), analysis.model.with_added((), ())):
        assert analysis.resistance_with(model).resistance.right.status is LimitStatus.UNBOUNDED
        assert not analysis.resistance_with(model).solved_cold
        assert analysis.extended(model).result.resistance.left.status is LimitStatus.UNBOUNDED
    both = boxes([0, 0, 2, 1], [0, 1, 1, 2], fixed=(1,))
    assert analysis.extended(base).resistance_with(both).resistance.right.alpha == pytest.approx(
        0.5
    )


def test_no_load_brings_down_what_is_wedged_between_pins(begin):
    """A block on pins of the ground to both sides: alpha has no end, and that is no failure."""
    pinned = boxes([0, 0, 2, 1])
    (floor,) = pinned.interfaces
    sides = [((0.0, 0.5), (1.0, 0.0)), ((2.0, 0.5), (-1.0, 0.0))]
    pins = [replace(floor, points=np.array([at]), normal=normal) for at, normal in sides]
    analysis = begin(empty(), PX)
    model = analysis.model.with_added(pinned.blocks, (floor, *pins))
    for found in (analysis.resistance_with(model), analysis.extended(model).result):
        both = found.resistance
        assert both.left.status is both.right.status is LimitStatus.UNBOUNDED


def test_a_stone_that_takes_away_one_end_of_the_load_is_no_trouble(begin, name):
    """It stands between the wall and a pin of the ground; the kernel is for walls without pins."""
    whole = boxes([0, 0, 20, 40], [20, 0, 20, 40])
    post, stone = whole.blocks
    at = {"points": np.array([(40.0, 20.0)]), "normal": (-1.0, 0.0)}
    pin = replace(whole.interfaces[0], block=stone.id, other=GROUND, **at)
    analysis = begin(with_block(empty(), post, whole=whole), PX)
    stopped = with_block(analysis.model, stone, whole=whole).added
    model = analysis.model.with_added(stopped.blocks, (*stopped.interfaces, pin))
    for found in (analysis.resistance_with(model), analysis.extended(model).result):
        assert found.solved_cold == (name == "simplex")
        assert found.resistance.right.status is LimitStatus.UNBOUNDED
        assert found.resistance.left.alpha == pytest.approx(lateral_resistance(model).left.alpha)


def test_a_wall_may_be_given_at_once(begin, name):
    """In any order of blocks and interfaces; what closes later is still known."""
    analysis, candidates = wall_and_candidates(coursed(6, 4, 80), 9, begin)
    wall = analysis.model
    shuffled = np.random.default_rng(0).permutation(len(wall.interfaces))
    at_once = replace(wall, interfaces=tuple(wall.interfaces[k] for k in shuffled))
    begun = begin(at_once, PX)
    assert_same(begun.result, at_once, SOLVERS[name])
    for added in (candidate.added for candidate in candidates):
        model = begun.model.with_added(added.blocks, added.interfaces, (0, 5))
        assert_same(begun.resistance_with(model), model, {*SOLVERS[name], WARM})
    upside_down = replace(wall, blocks=wall.blocks[::-1])
    assert_same(begin(upside_down, PX).result, upside_down, {*SOLVERS[name], WARM})


PROVED = Figures(0.0, 0.0, 1.0, 1.0, 0.0, 1.0, -0.5)
"""Of alpha = -.5 to the right: the dead load does work of .5 on a mechanism without error."""


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("alpha", [-2e-9, -9e-9, -0.5])
def test_an_end_beyond_0_needs_a_proof_of_the_fall_too(sign, alpha):
    """That a mechanism lacks which closes contacts faster than the dead load does work on it."""
    honest = PROVED._replace(live=float(sign), rhs=alpha, inadmissible=1e-10)
    found = certified_bound(honest, sign * alpha, sign, "")
    assert found.alpha == sign * alpha
    assert found.falls
    assert found.certificate.holds
    closing = honest._replace(inadmissible=max(0.99e-8, -alpha) if alpha > -1e-8 else 1.0)
    assert certified_bound(closing, sign * alpha, sign, "") is None
    assert not certified_bound(honest._replace(rhs=0.5), 0.5 * sign, sign, "").falls


def test_no_bound_without_a_certificate_and_no_fall_with_help_of_the_live_load():
    carries = PROVED._replace(rhs=0.5)
    assert certified_bound(carries, 0.5, 1, "").certificate.holds
    for error in ("residual", "violation", "inadmissible"):
        assert certified_bound(carries._replace(**{error: 2e-8}), 0.5, 1, "") is None
    assert certified_bound(carries._replace(rhs=0.5 + 1e-7), 0.5, 1, "") is None
    falling, nan = PROVED._replace(live=0.0), float("nan")
    assert certified_bound(falling, nan, 1, "").falls
    for error in ({"live": 0.1}, {"rhs": 0.5}, {"inadmissible": 1e-7}, {"largest": 0.0}):
        assert certified_bound(falling._replace(**error), nan, 1, "") is None


def lie(monkeypatch, spoil, of=WarmSession, signs=(1, -1)):
    """Let HiGHS or the kernel lie about some ends; nothing near a stone is found."""
    method = "minimise" if of is WarmSession else "solved_with"
    honest = getattr(of, method)

    def wrong(solver, asked):
        answer = honest(solver, asked)
        sign = -asked[0] if of is WarmSession else solver.sign
        return spoil(answer) if sign in signs else answer

    monkeypatch.setattr(of, method, wrong)
    for near in ("local_update", "forces_at"):
        monkeypatch.setattr(incremental, near, lambda *_: None)


def faster(answer):
    """A block moves on its own."""
    velocity = answer.velocity.copy()
    velocity[-2] -= 1e-3
    return replace(answer, velocity=velocity)


def more_force(solution):
    held = solution.columns is not None
    return replace(solution, columns=solution.columns * (1 + 1e-6)) if held else solution


NONE = np.empty(0)
NOTHING = {"alpha": float("nan"), "forces": NONE}
LIES = [
    ("simplex", Optimum, lambda answer: replace(answer, forces=answer.forces * (1 + 1e-6))),
    ("simplex", Optimum, faster),
    ("simplex", Optimum, lambda answer: replace(answer, alpha=answer.alpha * 0.999)),
    ("simplex", Optimum, lambda answer: replace(answer, alpha=-answer.alpha)),
    ("simplex", Optimum, lambda answer: replace(answer, status=2, velocity=NONE, **NOTHING)),
    ("simplex", Optimum, lambda answer: replace(answer, status=1, **NOTHING)),
    ("local", WarmSession, more_force),
    ("highs", WarmSession, more_force),
]


@pytest.mark.parametrize(("name", "liar", "spoil"), LIES, indirect=["name"])
@pytest.mark.parametrize("sign", [1, -1])
def test_answers_without_a_certificate_are_found_again_cold(name, begin, liar, spoil, sign):
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8, begin)
    model = candidates[0]
    assert not analysis.resistance_with(model).solved_cold
    with pytest.MonkeyPatch.context() as patch:
        lie(patch, spoil, liar, (sign,))
        found, expected = analysis.resistance_with(model), lateral_resistance(model)
        extended = analysis.extended(model)
    assert found.solved_cold
    assert found.resistance.left.alpha == expected.left.alpha
    assert found.resistance.left.solver == expected.left.solver not in SOLVERS[name]
    assert bits(extended.result) == bits(found)
    assert extended.result.solved_cold
    # The wall goes on, without the kernel.
    further = with_block(extended.model, candidates[1].blocks[-1], whole=candidates[1])
    assert_same(extended.resistance_with(further), further, {WARM, LOCAL})


@pytest.mark.parametrize("name", ["local", "highs"], indirect=True)
def test_an_answer_that_drifted_is_found_again_from_its_basis(begin, monkeypatch):
    """Once: its factors are made anew."""
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8, begin)
    asked = []

    def drifts(solution):
        asked.append(solution)
        return more_force(solution) if len(asked) % 2 else solution

    lie(monkeypatch, drifts)
    assert_same(analysis.resistance_with(candidates[0]), candidates[0], {WARM})


@needs_kernel
def test_a_wall_that_outgrows_the_kernel_goes_on():
    whole, blocks = upwards(coursed(1, 5, 110, 2))
    analysis = incremental_analysis(empty(), PX, most=9)
    kinds = []
    for block in blocks[:14]:
        model = with_block(analysis.model, block, whole=whole)
        analysis = grown(analysis, model, {SIMPLEX, LOCAL, WARM})
        kinds.append(type(analysis))
    assert kinds == [incremental.SimplexAnalysis] * 9 + [incremental.LocalAnalysis] * 5
    at_once = incremental_analysis(analysis.model, PX, most=9)
    assert isinstance(at_once, incremental.LocalAnalysis)
    assert_same(at_once.result, analysis.model, {WARM})


def test_the_bases_of_the_wall_save_most_of_the_work(monkeypatch):
    """Also when contacts go, and their columns with them."""
    analysis, candidates = wall_and_candidates(coursed(1, 6, 130), 30, incremental.HighsAnalysis.of)
    minimise, pivots = WarmSession.minimise, []

    def counted(session, costs):
        solution = minimise(session, costs)
        pivots.append(session.highs.getInfo().simplex_iteration_count)
        return solution

    def spent(start, models):
        pivots.clear()
        for model in models:
            start.resistance_with(model)
        return sum(pivots)

    monkeypatch.setattr(WarmSession, "minimise", counted)
    assert spent(analysis, [analysis.model.with_added((), ())]) == 0 < len(pivots)
    for models in (candidates, [analysis.model.with_added((), (), (k,)) for k in (3, 9)]):
        warm = spent(analysis, models)
        assert 0 < warm < spent(incremental.HighsAnalysis.of(empty(), PX), models) / 3


# Forces and mechanisms of the whole wall from what changes near a stone.

TEN = np.ones((10, 10), np.uint32)


def guesses(analysis, added):
    """What is guessed of each end of the range of alpha, or None, and whether it is proved."""
    program = analysis.program
    ends = analysis.greatest.known, analysis.least.known
    for end, opposite in (ends, ends[::-1]):
        guess, found = local_update(Near(program, added), end, opposite), None
        if guess is not None:
            answer = guess.alpha, guess.forces, guess.velocity
            measured = figures(program.cones, program.weights, added, *answer)
            found = certified_bound(measured, guess.alpha, guess.sign, "")
        yield end, guess, found


def wall_at_once(labels, count):
    """A wall of the lowest blocks that is given at once, and models with one more block."""
    whole, blocks = upwards(labels)
    lowest = with_block(empty(whole.mu), *blocks[:count], whole=whole)
    analysis = incremental.LocalAnalysis.of(lowest, PX)
    return analysis, [with_block(analysis.model, block, whole=whole) for block in blocks[count:]]


def begun_at_the_other_body(added):
    """Ids decide which body of an interface comes first; a stone may have a smaller one."""
    first, second, entries = added.cones.first, added.cones.second, added.cones.entries
    on_ground = second < 0
    turned = np.where(on_ground, entries, np.roll(entries, 3, axis=0))
    bodies = np.where(on_ground, (first, second), (second, first))
    return replace(added, cones=Cones(*bodies, np.ascontiguousarray(turned)))


@needs_kernel
@pytest.mark.parametrize("labels", [coursed(1, 7, 150), irregular(4, 50, 150, 110)])
def test_guesses_are_proved_and_most_stones_have_one(labels):
    analysis, candidates = wall_at_once(labels, 40)
    proved, turned = [], []
    for model in candidates:
        expected = lateral_resistance(model)
        sides = expected.right, expected.left
        added = analysis.program.columns_of(model.added)
        for told, one in ((proved, added), (turned, begun_at_the_other_body(added))):
            for (end, guess, found), sought in zip(guesses(analysis, one), sides, strict=True):
                told.append((guess is not None, found is not None))
                if found is None:
                    continue
                assert guess.sign == end.sign
                if found.falls:
                    assert not expected.stable
                elif expected.stable:
                    assert end.sign * found.alpha == pytest.approx(sought.alpha, abs=1e-9)
    assert proved == turned
    assert proved.count((True, True)) > len(candidates)  # of two for each


@needs_kernel
@pytest.mark.parametrize(
    ("labels", "alphas", "solver"),
    [
        (stacked((10, 30, 0), (10, 10, 0)), (0.25, 0.25), LOCAL),  # the lower one topples earlier
        (stacked((60, 20, 0), (40, 10, 10)), (0.58, 0.58), LOCAL),  # it goes along
        (stacked((60, 20, 0), (6, 30, 27)), (0.2, 0.2), LOCAL),  # it decides alone
        (stacked((30, 15, 0), (30, 15, 29)), (None, None), LOCAL),  # it falls alone
        (np.array([[2], [0], [1]], np.uint32), (None, None), LOCAL),  # in the air
        (stacked((10, 10, 20), (60, 10, 0), (10, 20, 50)), (None, None), LOCAL),  # a slab on a pier
        # A slender block that is propped on one side carries more than its 1 / 4.
        (np.kron([[1, 0, 0, 0]] * 3 + [[1, 2, 2, 2]], TEN), (61 / 156, 26 / 49), WARM),
    ],
)
def test_who_knows_what_a_stone_changes(labels, alphas, solver):
    """The joint of the stone is rougher than the others."""
    model = model_from_labels(labels).model
    *blocks, stone = model.blocks
    wall = incremental.LocalAnalysis.of(with_block(empty(), *blocks, whole=model), PX)
    new = with_block(wall.model, stone, whole=model).added.interfaces
    rough = wall.model.with_added((stone,), tuple(replace(i, mu=0.8) for i in new))
    found = wall.resistance_with(rough).resistance
    assert found.stable == (None not in alphas)
    assert (found.left.alpha, found.right.alpha) == pytest.approx(alphas)
    assert found.left.solver == found.right.solver == solver


@needs_kernel
@pytest.mark.parametrize("rounded", [-1e-15, 0.0, 1e-15])
def test_a_load_that_goes_far_aside_leaves_the_alpha_of_a_slender_block(rounded):
    """A stone on a lintel: its piers are beyond the first strip; alpha of a wall is rounded."""
    labels = np.zeros((40, 106), np.uint32)
    labels[20:, :10], labels[20:, 70:80], labels[:, 100:] = 1, 2, 3
    labels[10:20, :80] = 4
    labels[:10, 35:45] = 5
    whole = model_from_labels(labels).model
    *blocks, stone = whole.blocks
    wall = incremental.LocalAnalysis.of(with_block(empty(), *blocks, whole=whole), PX)
    added = wall.program.columns_of(with_block(wall.model, stone, whole=whole).added)
    ends = wall.greatest.known, wall.least.known
    for end, opposite in (ends, ends[::-1]):
        assert end.alpha == pytest.approx(0.15 * end.sign)
        known = end._replace(alpha=end.alpha + rounded)
        found = local_update(Near(wall.program, added), known, opposite)
        assert found.alpha == known.alpha
        measured = figures(wall.program.cones, wall.program.weights, added, *found[1:])
        assert certified_bound(measured, found.alpha, end.sign, "") is not None


@needs_kernel
def test_contacts_that_closed_carry_nothing():
    """Such as would carry some of the stone, and nothing without it."""
    analysis, candidates = wall_at_once(coursed(1, 7, 150), 40)
    program, told = analysis.program, []
    for model in candidates:
        stone = model.added
        for end, guess, _ in guesses(analysis, program.columns_of(stone)):
            if guess is None or guess.alpha != end.alpha:
                continue
            loaded = (guess.forces[: len(end.forces)] > 0) & (end.forces == 0)
            for gone in np.unique(program.interfaces[loaded]).tolist():
                if end.forces[program.interfaces == gone].any():
                    continue
                closed = Addition(analysis.model, stone.blocks, stone.interfaces, (gone,))
                without = guesses(analysis, program.columns_of(closed))
                told += [bound for one, other, bound in without if one is end and other]
    assert None not in told
    assert len(told) > 5
