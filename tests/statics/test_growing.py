from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

from drystone.statics import growing as module
from drystone.statics.appending import Units, units_of
from drystone.statics.contacts.blocks import model_from_labels, model_with
from drystone.statics.contacts.given import model_from_json
from drystone.statics.growing import growing
from drystone.statics.limit import lateral_resistance
from drystone.statics.result import LimitStatus
from drystone.statics.solvers.highs import HighsSession
from drystone.statics.solvers.warm import NAME, WarmSession
from tests.statics.growth import PX, Pivots, empty, upwards, wall_and_candidates, with_block
from tests.statics.walls import coursed, irregular, stacked
from tests.strategies import repeatable, walls


def assert_same(grown, model):
    """As the ordinary analysis says, certified, and found from the bases of the wall."""
    expected = lateral_resistance(model)
    assert not grown.solved_cold
    for direction in ("left", "right"):
        found = getattr(grown.resistance, direction)
        sought = getattr(expected, direction)
        assert found.direction == direction
        assert (found.status, found.message) == (sought.status, sought.message)
        assert found.alpha == pytest.approx(sought.alpha, abs=1e-9)
        assert found.certificate.holds
        assert found.solver == NAME
    assert grown.resistance.mu == model.mu


def bits(grown):
    both = grown.resistance.left, grown.resistance.right
    return [(r.status, r.alpha, r.certificate) for r in both]


@pytest.mark.parametrize(
    "labels", [coursed(1, 5, 110, 2), coursed(2, 4, 80), irregular(3, 24, 110, 80)]
)
def test_walls_grown_stone_by_stone_are_as_strong_as_walls_analysed_whole(labels):
    whole, blocks = upwards(labels)
    analysis = growing(empty(), PX)
    unstable = 0
    for block in blocks:
        model = with_block(analysis.model, block, whole=whole)
        grown = analysis.resistance_with(model)
        assert_same(grown, model)
        if grown.resistance.stable:
            analysis = analysis.extended(model)
            assert bits(analysis.grown) == bits(grown)
            assert analysis.model.interfaces is model.interfaces
            assert analysis.model.added is None
        unstable += not grown.resistance.stable
    assert len(analysis.model.blocks) == len(blocks) - unstable > 10


def test_a_wall_that_fell_can_be_propped():
    """Growing goes on after a stone that falls; the next one holds it."""
    model = model_from_labels(stacked((20, 20, 0), (20, 20, 14))).model
    alone = with_block(empty(), model.blocks[0], whole=model)
    fallen = growing(alone, PX).extended(model)
    assert fallen.grown.resistance.left.status is LimitStatus.UNSTABLE
    labels = np.zeros((40, 40), np.uint32)
    labels[20:, :20], labels[:20, 14:34], labels[20:, 24:40] = 1, 2, 3
    whole = model_from_labels(labels).model
    prop = tuple(i for i in whole.interfaces if 3 in (i.block, i.other))
    propped = fallen.model.with_added(whole.blocks[2:], prop)
    assert fallen.resistance_with(propped).resistance.stable
    assert_same(fallen.resistance_with(propped), propped)


@given(walls(max_stones=6))
@repeatable(25)
def test_walls_of_pixels_with_contacts_at_points(wall):
    """Stones of any shape on each other: points that close, stones that fall or float."""
    analysis = growing(empty(), Units(5.0, 25.0))
    built = type(wall).empty(wall.site)
    for group in wall.groups:
        model = model_with(analysis.model, built.labels, group.placement, group.wedges)
        grown = analysis.resistance_with(model)
        assert_same(grown, model)
        analysis = analysis.extended(model)
        assert bits(analysis.grown) == bits(grown)
        built = built.add(group.placement, group.wedges)


def test_two_blocks_at_once():
    """A stone and its wedge."""
    whole, blocks = upwards(coursed(4, 3, 70))
    analysis = growing(empty(), PX)
    for first, second in zip(blocks[::2], blocks[1::2], strict=False):
        model = with_block(analysis.model, first, second, whole=whole)
        assert_same(analysis.resistance_with(model), model)
        analysis = analysis.extended(model)
    assert len(analysis.model.blocks) >= 6


def test_contacts_that_carry_may_go():
    """The gaps that they leave in the bases are filled."""
    whole, blocks = upwards(coursed(6, 4, 80))
    analysis = growing(empty(), PX)
    for block in blocks:
        analysis = analysis.extended(with_block(analysis.model, block, whole=whole))
    changed = 0
    for gone in range(len(analysis.model.interfaces)):
        model = analysis.model.with_added((), (), (gone,))
        grown = analysis.resistance_with(model)
        assert_same(grown, model)
        assert bits(analysis.extended(model).grown) == bits(grown)
        changed += grown.resistance.value != analysis.grown.resistance.value
    assert changed > 5


@pytest.mark.parametrize("seed", [0, 1])
def test_neither_order_nor_threads_change_a_bit(seed):
    analysis, candidates = wall_and_candidates(irregular(seed, 26, 110, 80), 12)
    expected = [bits(analysis.resistance_with(model)) for model in candidates]
    backwards = [bits(analysis.resistance_with(model)) for model in reversed(candidates)]
    assert backwards[::-1] == expected
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(analysis.resistance_with, candidates * 2))
    assert [bits(grown) for grown in found] == expected * 2
    again, same = wall_and_candidates(irregular(seed, 26, 110, 80), 12)
    assert [bits(again.resistance_with(model)) for model in same] == expected


@pytest.mark.parametrize("units", [Units(1.0, 1.0), Units(300.0, 1e4), Units(15.0, 3e6)])
def test_alpha_does_not_depend_on_units(units):
    whole, blocks = upwards(coursed(8, 4, 80, 2))
    analysis = growing(empty(), units)
    for block in blocks[:10]:
        model = with_block(analysis.model, block, whole=whole)
        grown = analysis.resistance_with(model).resistance
        assert grown.left.alpha == pytest.approx(lateral_resistance(model).left.alpha, abs=1e-9)
        assert grown.right.alpha == pytest.approx(lateral_resistance(model).right.alpha, abs=1e-9)
        analysis = analysis.extended(model)


def test_answers_without_a_certificate_are_found_again_cold(monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(1, 4, 80), 8)
    honest = WarmSession.minimise

    def wrong(session, costs):
        solution = honest(session, costs)
        if costs[0] > 0 and solution.columns is not None:  # the left tilt only
            return replace(solution, columns=solution.columns * (1 + 1e-6))
        return solution

    assert not analysis.resistance_with(candidates[0]).solved_cold
    monkeypatch.setattr(WarmSession, "minimise", wrong)
    grown = analysis.resistance_with(candidates[0])
    expected = lateral_resistance(candidates[0])
    assert grown.solved_cold
    assert grown.resistance.left.alpha == expected.left.alpha
    assert grown.resistance.left.solver == expected.left.solver != NAME
    assert analysis.extended(candidates[0]).grown.solved_cold


def test_any_other_model_is_answered_too():
    analysis, candidates = wall_and_candidates(coursed(2, 4, 80), 8)
    model = candidates[0]
    others = [
        replace(model, mu=0.4),
        replace(model, blocks=model.blocks[::-1]),
        replace(model, blocks=(replace(model.blocks[0], density=9.0), *model.blocks[1:])),
        replace(model, interfaces=model.interfaces[::-1]),
        replace(model, interfaces=model.interfaces[4:] + model.interfaces[:4]),
        model_from_labels(stacked((20, 40, 0))).model,
    ]
    for other in others:
        assert_same(analysis.resistance_with(other), other)
    assert analysis.extended(others[-1]).grown.resistance.right.alpha == pytest.approx(0.5)


def test_nothing_free_carries_anything():
    fixed = {"id": 7, "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "fixed": True}
    base = model_from_json({"blocks": [fixed], "mu": 0.58})
    analysis = growing(empty(), PX)
    for model in (empty(), base):
        assert analysis.resistance_with(model).resistance.right.status is LimitStatus.UNBOUNDED
        assert analysis.extended(model).grown.resistance.left.status is LimitStatus.UNBOUNDED
    upright = {"id": 8, "polygon": [[0, 1], [1, 1], [1, 3], [0, 3]]}
    both = model_from_json({"blocks": [fixed, upright], "mu": 0.58})
    assert both.blocks[:1] == base.blocks
    assert analysis.extended(base).resistance_with(both).resistance.right.alpha == pytest.approx(
        0.5
    )


def test_many_blocks_at_once_begin_with_an_interior_point(monkeypatch):
    analysis, candidates = wall_and_candidates(coursed(3, 5, 90), 14)
    asked = []

    def counted(program, algorithm):
        asked.append(algorithm)
        return HighsSession(program, algorithm)

    pivots = Pivots(monkeypatch)
    monkeypatch.setattr(module, "MANY_BLOCKS_AT_ONCE", 14)
    monkeypatch.setattr(module, "HighsSession", counted)
    at_once = growing(analysis.model, units_of(analysis.model))
    assert asked == ["ipm"]
    assert pivots.count == 0
    assert_same(at_once.grown, analysis.model)
    for model in candidates:
        assert_same(at_once.resistance_with(model), model)
