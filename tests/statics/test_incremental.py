"""Walls that grow: as strong as walls analysed whole, and believed only where it is proved."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from drystone.contacts.blocks import model_from_labels, model_with
from drystone.kernels.cones import Figures
from drystone.kernels.simplex import Optimum
from drystone.statics import incremental
from drystone.statics.incremental import (
    LOCAL,
    HighsAnalysis,
    LocalAnalysis,
    SimplexAnalysis,
    certified_bound,
    incremental_analysis,
)
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.highs import WARM, WarmSession
from drystone.statics.lp.program import Units
from drystone.statics.result import LimitStatus
from tests.kernels.simplex_walls import needs_kernel
from tests.statics.growth import (
    ANALYSES,
    PX,
    SOLVERS,
    assert_same,
    beginning,
    bits,
    empty,
    upwards,
    wall_and_candidates,
    with_block,
)
from tests.statics.walls import boxes, coursed, irregular, stacked
from tests.strategies import repeatable, walls


@pytest.fixture(params=ANALYSES)
def name(request):
    return request.param


@pytest.fixture
def begin(name, monkeypatch):
    """What begins a wall that is analysed by it."""
    return beginning(name, monkeypatch)


@pytest.mark.parametrize("labels", [coursed(1, 5, 110, 2), irregular(3, 18, 100, 70)])
def test_walls_grown_stone_by_stone_are_as_strong_as_walls_analysed_whole(labels, begin, name):
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    unstable = 0
    solvers = set()
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        found = analysis.resistance_with(model)
        assert_same(found, model, SOLVERS[name])
        solvers |= {found.resistance.left.solver, found.resistance.right.solver}
        if found.resistance.stable:
            analysis = analysis.extended(model)
            assert bits(analysis.result) == bits(found)
            assert bits(analysis.resistance_with(analysis.model)) == bits(found)
            assert analysis.extended(analysis.model).model is analysis.model
            assert analysis.model.interfaces is model.interfaces
            assert analysis.model.added is None
        unstable += not found.resistance.stable
    assert len(analysis.model.blocks) == len(blocks) - unstable > 10
    assert solvers == SOLVERS[name]


def test_a_wall_that_fell_can_be_propped(begin, name):
    """Growing goes on after a stone that falls; the next one holds it."""
    model = model_from_labels(stacked((20, 20, 0), (20, 20, 14))).model
    alone = with_block(empty(), model.blocks[0], whole=model)
    fallen = begin(alone, PX).extended(model)
    assert fallen.result.resistance.left.status is LimitStatus.UNSTABLE
    labels = np.zeros((40, 40), np.uint32)
    labels[20:, :20], labels[:20, 14:34], labels[20:, 24:40] = 1, 2, 3
    whole = model_from_labels(labels).model
    prop = tuple(i for i in whole.interfaces if 3 in (i.block, i.other))
    propped = fallen.model.with_added(whole.blocks[2:], prop)
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
            found = analysis.resistance_with(model)
            assert_same(found, model, {*SOLVERS[name], WARM})
            analysis = analysis.extended(model)
            assert bits(analysis.result) == bits(found)
            built = built.add(group.placement, group.wedges)

    check()


def test_contacts_that_carry_may_go(begin, name):
    """With a stone or without one; the gaps that they leave in the bases are filled."""
    whole, blocks = upwards(coursed(6, 4, 80))
    analysis = begin(empty(), PX)
    for block in blocks[:-1]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    stone = with_block(analysis.model, blocks[-1], whole=whole).added
    changed = 0
    for gone in range(0, len(analysis.model.interfaces), 5):
        for blocks, interfaces in (((), ()), (stone.blocks, stone.interfaces)):
            model = analysis.model.with_added(blocks, interfaces, (gone,))
            found = analysis.resistance_with(model)
            assert_same(found, model, {*SOLVERS[name], WARM})
        changed += found.resistance.value != analysis.result.resistance.value
        if gone % 10 == 0:
            extended = analysis.extended(model)
            assert bits(extended.result) == bits(found)
            # What is left has moved up.
            again = extended.model.with_added((), (), (gone,))
            assert_same(extended.resistance_with(again), again, {*SOLVERS[name], WARM})
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
    for model, told in zip(candidates, expected, strict=True):
        assert bits(analysis.extended(model).result) == told


def test_any_other_model_is_answered_too(begin):
    analysis, candidates = wall_and_candidates(coursed(2, 4, 80), 8, begin)
    model = candidates[0]
    odd = ({"held": ("turn",)}, {"density": 0.0}, {"fixed": True})
    others = [
        replace(model, mu=0.4),
        replace(model, blocks=model.blocks[::-1]),
        replace(model, blocks=(replace(model.blocks[0], density=9.0), *model.blocks[1:])),
        replace(model, interfaces=model.interfaces[::-1]),
        replace(model, interfaces=model.interfaces[4:] + model.interfaces[:4]),
        replace(analysis.model, mu=0.3).with_added(model.added.blocks, model.added.interfaces),
        *(
            analysis.model.with_added((replace(model.blocks[-1], **one),), model.added.interfaces)
            for one in odd
        ),
        model_from_labels(stacked((20, 40, 0))).model,
    ]
    for other in others:
        assert_same(analysis.resistance_with(other), other, {WARM})
        assert bits(analysis.extended(other).result) == bits(analysis.resistance_with(other))
    assert analysis.extended(others[-1]).result.resistance.right.alpha == pytest.approx(0.5)


def test_nothing_free_carries_anything(begin):
    base = boxes([0, 0, 2, 1], fixed=(1,))
    analysis = begin(empty(), PX)
    for model in (empty(), base, empty().with_added((), ()), analysis.model.with_added((), ())):
        assert analysis.resistance_with(model).resistance.right.status is LimitStatus.UNBOUNDED
        assert not analysis.resistance_with(model).solved_cold
        assert analysis.extended(model).result.resistance.left.status is LimitStatus.UNBOUNDED
    both = boxes([0, 0, 2, 1], [0, 1, 1, 2], fixed=(1,))
    grown = analysis.extended(base).resistance_with(both).resistance
    assert grown.right.alpha == pytest.approx(0.5)


def test_no_load_brings_down_what_is_wedged_between_pins(begin):
    """A block on pins of the ground to both sides: alpha has no end, and that is no failure."""
    pinned = boxes([0, 0, 2, 1])
    (floor,) = pinned.interfaces
    sides = [((0.0, 0.5), (1.0, 0.0)), ((2.0, 0.5), (-1.0, 0.0))]
    pins = [replace(floor, points=np.array([at]), normal=normal) for at, normal in sides]
    analysis = begin(empty(), PX)
    model = analysis.model.with_added(pinned.blocks, (floor, *pins))
    for found in (analysis.resistance_with(model), analysis.extended(model).result):
        ends = found.resistance.left.status, found.resistance.right.status
        assert ends == (LimitStatus.UNBOUNDED, LimitStatus.UNBOUNDED)


def test_a_wall_may_be_given_at_once(begin, name):
    """In any order of blocks and interfaces; what closes later is still known."""
    analysis, candidates = wall_and_candidates(coursed(6, 4, 80), 9, begin)
    shuffled = np.random.default_rng(0).permutation(len(analysis.model.interfaces))
    given_at_once = replace(
        analysis.model, interfaces=tuple(analysis.model.interfaces[k] for k in shuffled)
    )
    wall = begin(given_at_once, PX)
    assert_same(wall.result, given_at_once, SOLVERS[name])
    for added in (candidate.added for candidate in candidates):
        model = wall.model.with_added(added.blocks, added.interfaces, (0, 5))
        assert_same(wall.resistance_with(model), model, {*SOLVERS[name], WARM})
    upside_down = replace(analysis.model, blocks=analysis.model.blocks[::-1])
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
    assert found.fall.holds
    closing = honest._replace(inadmissible=max(0.99e-8, -alpha) if alpha > -1e-8 else 1.0)
    assert certified_bound(closing, sign * alpha, sign, "") is None
    assert certified_bound(honest._replace(rhs=0.5), 0.5 * sign, sign, "").fall is None


def test_no_bound_without_a_certificate_and_no_fall_with_help_of_the_live_load():
    for error in ("residual", "violation", "inadmissible"):
        assert certified_bound(PROVED._replace(**{error: 2e-8}), -0.5, 1, "") is None
    assert certified_bound(PROVED._replace(rhs=-0.5 + 1e-7), -0.5, 1, "") is None
    falling, nan = PROVED._replace(live=0.0), float("nan")
    assert certified_bound(falling, nan, 1, "").fall.holds
    for error in ({"live": 0.1}, {"rhs": 0.5}, {"inadmissible": 1e-7}, {"largest": 0.0}):
        assert certified_bound(falling._replace(**error), nan, 1, "") is None


def lie(monkeypatch, spoil, signs=(1, -1)):
    """Let the kernel lie about some ends; nothing near a stone is found."""
    honest = Optimum.solved_with

    def wrong(optimum, added):
        answer = honest(optimum, added)
        return spoil(answer) if optimum.sign in signs else answer

    monkeypatch.setattr(Optimum, "solved_with", wrong)
    monkeypatch.setattr(incremental, "local_update", lambda *_: None)


def lie_of_highs(monkeypatch, spoil, signs=(1, -1)):
    """Let HiGHS lie about some ends."""
    honest = WarmSession.minimise

    def wrong(session, costs):
        solution = honest(session, costs)
        lies = -costs[0] in signs and solution.columns is not None
        return spoil(solution) if lies else solution

    monkeypatch.setattr(incremental, "local_update", lambda *_: None)
    monkeypatch.setattr(WarmSession, "minimise", wrong)


def faster(answer):
    """A block moves on its own."""
    velocity = answer.velocity.copy()
    velocity[-2] -= 1e-3
    return replace(answer, velocity=velocity)


def more_force(solution):
    return replace(solution, columns=solution.columns * (1 + 1e-6))


NOTHING = {"alpha": float("nan"), "forces": np.empty(0)}
LIES = [
    ("simplex", lie, lambda answer: replace(answer, forces=answer.forces * (1 + 1e-6))),
    ("simplex", lie, faster),
    ("simplex", lie, lambda answer: replace(answer, alpha=answer.alpha * 0.999)),
    ("simplex", lie, lambda answer: replace(answer, alpha=-answer.alpha)),
    ("simplex", lie, lambda answer: replace(answer, status=2, velocity=np.empty(0), **NOTHING)),
    ("simplex", lie, lambda answer: replace(answer, status=1, **NOTHING)),
    ("local", lie_of_highs, more_force),
    ("highs", lie_of_highs, more_force),
]


@pytest.mark.parametrize(("name", "lie", "spoil"), LIES, indirect=["name"])
@pytest.mark.parametrize("sign", [1, -1])
def test_answers_without_a_certificate_are_found_again_cold(name, begin, lie, spoil, sign):
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8, begin)
    model = candidates[0]
    assert not analysis.resistance_with(model).solved_cold
    with pytest.MonkeyPatch.context() as patch:
        lie(patch, spoil, (sign,))
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

    lie_of_highs(monkeypatch, drifts)
    assert_same(analysis.resistance_with(candidates[0]), candidates[0], {WARM})


@needs_kernel
def test_a_wall_that_outgrows_the_kernel_goes_on():
    whole, blocks = upwards(coursed(1, 5, 110, 2))
    analysis = incremental_analysis(empty(), PX, most=9)
    kinds = []
    for block in blocks[:14]:
        model = with_block(analysis.model, block, whole=whole)
        found = analysis.resistance_with(model)
        analysis = analysis.extended(model)
        assert bits(analysis.result) == bits(found)
        kinds.append(type(analysis))
    assert kinds == [SimplexAnalysis] * 9 + [LocalAnalysis] * 5
    at_once = incremental_analysis(analysis.model, PX, most=9)
    assert isinstance(at_once, LocalAnalysis)
    assert_same(at_once.result, analysis.model, {WARM})


@pytest.mark.parametrize("closed", [False, True])
def test_the_bases_of_the_wall_save_most_of_the_work(closed, monkeypatch):
    """Also when contacts go, and their columns with them."""
    analysis, candidates = wall_and_candidates(coursed(1, 6, 130), 30, HighsAnalysis.of)
    minimise, pivots = WarmSession.minimise, []

    def counted(session, costs):
        solution = minimise(session, costs)
        pivots.append(session.highs.getInfo().simplex_iteration_count)
        return solution

    def spent(start, models):
        pivots.clear()
        for model in models:
            start.resistance_with(model)
        return list(pivots)

    monkeypatch.setattr(WarmSession, "minimise", counted)
    assert spent(analysis, [analysis.model.with_added((), ())]) == [0, 0]
    if closed:
        candidates = [analysis.model.with_added((), (), (k,)) for k in (3, 9)]
    warm = sum(spent(analysis, candidates))
    assert 0 < warm < sum(spent(HighsAnalysis.of(empty(), PX), candidates)) / 3
