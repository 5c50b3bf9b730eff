from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from drystone.statics.appending import Units
from drystone.statics.contacts.blocks import model_from_labels, model_with
from drystone.statics.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.warm import NAME as WARM
from tests.statics.growth import (
    IMPLEMENTATIONS,
    PX,
    SOLVERS,
    assert_same,
    bits,
    empty,
    implementation,
    upwards,
    wall_and_candidates,
    with_block,
)
from tests.statics.walls import coursed, irregular, stacked
from tests.strategies import repeatable, walls


@pytest.fixture(params=IMPLEMENTATIONS)
def name(request):
    """Of an implementation."""
    return request.param


@pytest.fixture
def begin(name, monkeypatch):
    """What begins a wall that is analysed by it."""
    return implementation(name, monkeypatch)


@pytest.mark.parametrize(
    "labels", [coursed(1, 5, 110, 2), coursed(2, 4, 80), irregular(3, 24, 110, 80)]
)
def test_walls_grown_stone_by_stone_are_as_strong_as_walls_analysed_whole(labels, begin, name):
    whole, blocks = upwards(labels)
    analysis = begin(empty(), PX)
    unstable = 0
    solvers = set()
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        grown = analysis.resistance_with(model)
        assert_same(grown, model, SOLVERS[name])
        solvers |= {grown.resistance.left.solver, grown.resistance.right.solver}
        if grown.resistance.stable:
            analysis = analysis.extended(model)
            assert bits(analysis.grown) == bits(grown)
            assert bits(analysis.resistance_with(analysis.model)) == bits(grown)
            assert analysis.extended(analysis.model).model is analysis.model
            assert analysis.model.interfaces is model.interfaces
            assert analysis.model.added is None
        unstable += not grown.resistance.stable
    assert len(analysis.model.blocks) == len(blocks) - unstable > 10
    assert solvers == SOLVERS[name]


def test_a_wall_that_fell_can_be_propped(begin, name):
    """Growing goes on after a stone that falls; the next one holds it."""
    model = model_from_labels(stacked((20, 20, 0), (20, 20, 14))).model
    alone = with_block(empty(), model.blocks[0], whole=model)
    fallen = begin(alone, PX).extended(model)
    assert fallen.grown.resistance.left.status is LimitStatus.UNSTABLE
    labels = np.zeros((40, 40), np.uint32)
    labels[20:, :20], labels[:20, 14:34], labels[20:, 24:40] = 1, 2, 3
    whole = model_from_labels(labels).model
    prop = tuple(i for i in whole.interfaces if 3 in (i.block, i.other))
    propped = fallen.model.with_added(whole.blocks[2:], prop)
    assert fallen.resistance_with(propped).resistance.stable
    assert_same(fallen.resistance_with(propped), propped, {*SOLVERS[name], WARM})


def test_walls_of_pixels_with_contacts_at_points(begin, name):
    """Stones of any shape on each other: points that close, stones that fall or float."""

    @repeatable(15)
    @given(walls(max_stones=6))
    def check(wall):
        analysis = begin(empty(), Units(5.0, 25.0))
        built = type(wall).empty(wall.site)
        for group in wall.groups:
            model = model_with(analysis.model, built.labels, group.placement, group.wedges)
            grown = analysis.resistance_with(model)
            assert_same(grown, model, {*SOLVERS[name], WARM})
            analysis = analysis.extended(model)
            assert bits(analysis.grown) == bits(grown)
            built = built.add(group.placement, group.wedges)

    check()


def test_two_blocks_at_once(begin, name):
    """A stone and its wedge."""
    whole, blocks = upwards(coursed(4, 3, 70))
    analysis = begin(empty(), PX)
    for first, second in zip(blocks[::2], blocks[1::2], strict=False):
        model = with_block(analysis.model, first, second, whole=whole)
        assert_same(analysis.resistance_with(model), model, SOLVERS[name])
        analysis = analysis.extended(model)
    assert len(analysis.model.blocks) >= 6


def test_contacts_that_carry_may_go(begin, name):
    """With a stone or without one; the gaps that they leave in the bases are filled."""
    whole, blocks = upwards(coursed(6, 4, 80))
    analysis = begin(empty(), PX)
    for block in blocks[:-1]:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    stone = with_block(analysis.model, blocks[-1], whole=whole).added
    changed = 0
    for gone in range(0, len(analysis.model.interfaces), 2):
        for blocks, interfaces in (((), ()), (stone.blocks, stone.interfaces)):
            model = analysis.model.with_added(blocks, interfaces, (gone,))
            grown = analysis.resistance_with(model)
            assert_same(grown, model, {*SOLVERS[name], WARM})
        changed += grown.resistance.value != analysis.grown.resistance.value
        if gone % 10 == 0:
            extended = analysis.extended(model)
            assert bits(extended.grown) == bits(grown)
            # What is left has moved up.
            again = extended.model.with_added((), (), (gone,))
            assert_same(extended.resistance_with(again), again, {*SOLVERS[name], WARM})
    assert changed > 5


@pytest.mark.parametrize("seed", [0, 1])
def test_neither_order_nor_threads_change_a_bit(seed, begin):
    analysis, candidates = wall_and_candidates(irregular(seed, 26, 110, 80), 12, begin)
    expected = [bits(analysis.resistance_with(model)) for model in candidates]
    backwards = [bits(analysis.resistance_with(model)) for model in reversed(candidates)]
    assert backwards[::-1] == expected
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(analysis.resistance_with, candidates * 2))
    assert [bits(grown) for grown in found] == expected * 2
    again, same = wall_and_candidates(irregular(seed, 26, 110, 80), 12, begin)
    assert [bits(again.resistance_with(model)) for model in same] == expected
    for model, told in zip(candidates, expected, strict=True):
        assert bits(analysis.extended(model).grown) == told


@pytest.mark.parametrize("units", [Units(1.0, 1.0), Units(300.0, 1e4), Units(15.0, 3e6)])
def test_alpha_does_not_depend_on_units(units, begin):
    whole, blocks = upwards(coursed(8, 4, 80, 2))
    analysis = begin(empty(), units)
    for block in blocks[:10]:
        model = with_block(analysis.model, block, whole=whole)
        grown = analysis.resistance_with(model).resistance
        assert grown.left.alpha == pytest.approx(lateral_resistance(model).left.alpha, abs=1e-9)
        assert grown.right.alpha == pytest.approx(lateral_resistance(model).right.alpha, abs=1e-9)
        analysis = analysis.extended(model)


def test_any_other_model_is_answered_too(begin):
    analysis, candidates = wall_and_candidates(coursed(2, 4, 80), 8, begin)
    model = candidates[0]
    held = replace(model.blocks[-1], held=("turn",))
    weightless = replace(model.blocks[-1], density=0.0)
    others = [
        replace(model, mu=0.4),
        replace(model, blocks=model.blocks[::-1]),
        replace(model, blocks=(replace(model.blocks[0], density=9.0), *model.blocks[1:])),
        replace(model, interfaces=model.interfaces[::-1]),
        replace(model, interfaces=model.interfaces[4:] + model.interfaces[:4]),
        replace(analysis.model, mu=0.3).with_added(model.added.blocks, model.added.interfaces),
        analysis.model.with_added((held,), model.added.interfaces),
        analysis.model.with_added((weightless,), model.added.interfaces),
        model_from_labels(stacked((20, 40, 0))).model,
    ]
    for other in others:
        assert_same(analysis.resistance_with(other), other, {WARM})
        assert bits(analysis.extended(other).grown) == bits(analysis.resistance_with(other))
    assert analysis.extended(others[-1]).grown.resistance.right.alpha == pytest.approx(0.5)


def test_nothing_free_carries_anything(begin):
    fixed = {"id": 7, "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "fixed": True}
    base = model_from_json({"blocks": [fixed], "mu": 0.58})
    analysis = begin(empty(), PX)
    assert analysis.grown.resistance.right.status is LimitStatus.UNBOUNDED
    for model in (empty(), base, empty().with_added((), ()), analysis.model.with_added((), ())):
        assert analysis.resistance_with(model).resistance.right.status is LimitStatus.UNBOUNDED
        assert not analysis.resistance_with(model).solved_cold
        assert analysis.extended(model).grown.resistance.left.status is LimitStatus.UNBOUNDED
    upright = {"id": 8, "polygon": [[0, 1], [1, 1], [1, 3], [0, 3]]}
    both = model_from_json({"blocks": [fixed, upright], "mu": 0.58})
    assert both.blocks[:1] == base.blocks
    assert analysis.extended(base).resistance_with(both).resistance.right.alpha == pytest.approx(
        0.5
    )


def test_no_load_brings_down_what_is_wedged_between_pins(begin):
    """A block on pins of the ground to both sides: alpha has no end, and that is no failure."""
    pinned = model_from_json({"blocks_xywh": [[0, 0, 2, 1]], "mu": 0.58})
    block, (floor,) = pinned.blocks, pinned.interfaces
    sides = [((0.0, 0.5), (1.0, 0.0)), ((2.0, 0.5), (-1.0, 0.0))]
    pins = [replace(floor, points=np.array([at]), normal=normal) for at, normal in sides]
    analysis = begin(empty(), PX)
    model = analysis.model.with_added(block, (floor, *pins))
    for grown in (analysis.resistance_with(model), analysis.extended(model).grown):
        assert grown.resistance.left.status is LimitStatus.UNBOUNDED
        assert grown.resistance.right.status is LimitStatus.UNBOUNDED


def test_a_wall_may_be_given_at_once(begin, name):
    """In any order of blocks and interfaces; what closes later is still known."""
    analysis, candidates = wall_and_candidates(coursed(6, 4, 80), 9, begin)
    shuffled = np.random.default_rng(0).permutation(len(analysis.model.interfaces))
    given_at_once = replace(
        analysis.model, interfaces=tuple(analysis.model.interfaces[k] for k in shuffled)
    )
    wall = begin(given_at_once, PX)
    assert_same(wall.grown, given_at_once, SOLVERS[name])
    for candidate in candidates:
        for closed in ((), (3,), (0, 5)):
            added = candidate.added
            model = wall.model.with_added(added.blocks, added.interfaces, closed)
            assert_same(wall.resistance_with(model), model, {*SOLVERS[name], WARM})
    upside_down = replace(analysis.model, blocks=analysis.model.blocks[::-1])
    assert_same(begin(upside_down, PX).grown, upside_down, {*SOLVERS[name], WARM})
