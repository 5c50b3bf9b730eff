"""Wedges: what they cannot help carrying, and those that stick out."""

from dataclasses import replace

import numpy as np
import pytest

from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.craft import Masonry, pins
from drystone.statics.limit import lateral_resistance
from drystone.statics.lp.highs import HighsSession
from drystone.statics.lp.program import Solution
from drystone.statics.result import LimitStatus
from tests.craft.walls import box, find, mirrored
from tests.naive import statics as naive
from tests.statics.walls import coursed, irregular


def modelled(loops, wedges):
    blocks = [{"id": i, "polygon": loop.tolist()} for i, loop in loops.items()]
    return Masonry(loops, model_from_json({"blocks": blocks}), wedges, cut=True)


def slab_on(*, wedge_x, piers, slab=(0.0, 4.0)):
    """A slab on piers, and on a flat wedge on a low block; something stands beside them."""
    loops = {i: box(x, 0, 1, 1) for i, x in enumerate(piers, 1)}
    loops[5], loops[6] = box(wedge_x, 0, 0.5, 0.75), box(5, 0, 1, 1)
    loops[8] = box(slab[0], 1, slab[1], 1)
    loops[9] = box(wedge_x, 0.75, 0.5, 0.25)
    return modelled(loops, {9})


def test_a_wedge_that_holds_the_slab_up_is_broken():
    # Between two piers it only fills.
    found = find("pins", slab_on(wedge_x=1.5, piers=[0.0, 3.0]))
    assert (found.number, found.verdict, found.cases) == (0.0, "good", ())
    assert found.figures["wedges"] == 1.0
    # Slab of weight 4 on a pier under [0, 1] and the wedge under [3.5, 4]: moments about x = 1
    # with the wedge's far edge give the least: 4 * (2 - 1) / (4 - 1).
    found = find("pins", slab_on(wedge_x=3.5, piers=[0.0]))
    assert found.number == pytest.approx(1.0 / 3.0, abs=1e-6)
    assert found.verdict == "fair"
    assert found.cases[0].stones == (9, 8)
    far = find("pins", slab_on(wedge_x=1.5, piers=[0.0]))
    assert far.number == pytest.approx(1.0, abs=1e-6)
    assert far.verdict == "broken"
    loops = {**slab_on(wedge_x=1.5, piers=[0.0]).loops, 7: box(0, 2, 4, 1)}
    # Twice the weight on it, over the weight of the slab alone.
    assert find("pins", modelled(loops, {9})).number == pytest.approx(2.0, abs=1e-6)
    # A slope passes on the whole weight.
    rise = 2.0 * np.tan(np.radians(20.0))
    loops = {9: np.array([[0, 0], [2, 0], [2, 1 + rise], [0, 1]]),
             8: np.array([[0, 1], [2, 1 + rise], [2, 3], [0, 3]])}  # fmt: skip
    assert find("pins", modelled(loops, {9})).number == pytest.approx(1.0, abs=1e-6)


def test_a_wedge_that_sticks_out_is_named():
    loops = {1: box(0, 0, 4, 1), 2: box(0.5, 1.2, 3, 1), 9: box(-0.1, 1, 1.1, 0.2),
             8: box(2.0, 1, 0.8, 0.2)}  # fmt: skip
    for wall in (loops, mirrored(loops)):
        found = find("pins", modelled(wall, {8, 9}))
        assert found.verdict == "broken"
        (out,) = [case for case in found.cases if "sticks out" in case.words]
        assert (out.stones, out.value) == ((9, 2), pytest.approx(0.6))
    # Beyond its stone, but between others, it does not.
    loops = {1: box(0, 0, 6, 1), 2: box(1, 1.2, 2, 1), 4: box(3.6, 1, 2, 1),
             9: box(2.5, 1, 1.0, 0.2), 8: box(1.2, 1, 0.5, 0.2)}  # fmt: skip
    assert find("pins", modelled(loops, {8, 9})).figures["wedges that stick out"] == 0.0
    del loops[4]
    assert find("pins", modelled(loops, {8, 9})).figures["wedges that stick out"] == 1.0


def slab_with(wedge, *more):
    """A slab of size 2 over a wedge, between two posts or what is given instead."""
    beside = more or (box(-3, 0, 2, 2), box(5, 0, 2, 2))
    loops = {1: box(0, 0, 4, 1), 8: box(0, 1.3, 4, 1), 9: np.asarray(wedge, float)}
    return Masonry(loops | dict(enumerate(beside, 20)), wedge_ids={9}, cut=True)


def named(masonry):
    found = find("pins", masonry)
    told = [case.words for case in found.cases if "no mason would cut" in case.words]
    assert found.figures["wedges that no mason would cut"] == len(told)
    assert found.verdict == ("broken" if told else "not judged")
    return "; ".join(told).partition(": ")[2]


@pytest.mark.parametrize("factor", [1.0, 250.0])
@pytest.mark.parametrize(("wedge", "words"), [
    (box(1, 1, 0.5, 0.3), ""),
    (box(1, 1, 0.28, 0.06), "0.03 thick, at least 0.032"),
    (box(1, 1, 0.18, 0.17), "0.09 wide, at least 0.096"),
    (box(1, 1, 0.7, 0.62), "0.31 high, at most 0.3"),
    (box(1, 1, 1.2, 0.59), "0.177 in area, at most 0.144"),
    ([[1, 1.1], [1.5, 1], [1.5, 1.4], [1, 1.19]], "34.1° between its faces, at most 30.1°"),
])  # fmt: skip
def test_wedges_that_no_mason_would_cut_are_named_in_stone_sizes(wedge, words, factor):
    masonry = slab_with(wedge)
    loops = {i: loop * factor for i, loop in masonry.loops.items()}
    assert named(Masonry(loops, wedge_ids={9}, cut=True)) == words
    # Small stones are no wedges that were cut.
    assert named(Masonry(loops, wedge_ids={9})) == ""


def test_a_wedge_with_nothing_beside_it_is_named_or_one_too_thin_for_the_scale():
    wedge, post = box(1, 1, 0.5, 0.3), box(5, 0, 2, 2)
    assert named(slab_with(wedge)) == ""
    assert named(slab_with(wedge, post, box(8, 0, 2, 2))) == "nothing beside it to the left"
    mirrored = named(slab_with(wedge, post * [-1, 1], box(-8, 0, 2, 2)))
    assert mirrored == "nothing beside it to the right"
    # Stones that lie lower or higher are not beside it.
    assert "left; nothing" in named(slab_with(wedge, box(-3, 0, 2, 1), box(5, 1.3, 2, 1)))
    # A size of 2 is 200 mm at 10 px a metre: the least is 5 mm less a fifth, not 8 mm less a fifth.
    thin = slab_with(box(1, 1, 0.16, 0.05))
    assert "thick" in named(thin)
    assert named(replace(thin, per_m=10.0)) == ""
    assert "thick" in named(replace(thin, per_m=20.0))


def test_pressure_in_upright_joints_does_not_hold_a_stone_up():
    # Beside the slab stands a heavy block: with friction against it the slab needs no wedge.
    loops = {1: box(0, 0, 1, 1), 8: box(0, 1, 4, 1), 9: box(3.5, 0, 0.5, 1),
             2: box(4, 0, 2, 3), 3: box(-2, 0, 2, 3)}  # fmt: skip
    wall = modelled(loops, {9})
    assert pins.least_wedge_loads(wall.model, frozenset({9}))[9] == pytest.approx(0.0)
    assert find("pins", wall).number == pytest.approx(1.0 / 3.0, abs=1e-6)
    assert find("pins", wall).note == ""
    # A slab that only its neighbours hold.
    loops = {1: box(0.5, 0, 1, 1), 8: box(0.5, 1, 4, 1), 9: box(2.0, 0, 0.3, 1),
             2: box(4.5, 0, 4, 4), 3: box(-3.5, 0, 4, 4)}  # fmt: skip
    found = find("pins", modelled(loops, {9}))
    assert found.note == "The wall stands only by pressure in upright joints, which was counted on."
    assert found.number is not None


@pytest.mark.parametrize("labels", [coursed(1, 4, 80), irregular(3, 14, 80, 60), coursed(2, 6, 60)])
def test_least_loads_are_those_of_programs_from_the_start(labels):
    model = model_from_labels(labels).model
    loads = pins.least_wedge_loads(model, frozenset(block.id for block in model.blocks))
    mean = np.mean([block.weight for block in model.blocks])
    assert sum(load > 0.1 * mean for load in loads.values()) > 1
    assert loads == pytest.approx(naive.least_wedge_loads(model), abs=1e-6 * mean)


def test_a_wedge_that_friction_may_pull_down_carries_nothing():
    """Between leaning faces the force on it has no least value: pressure holds it up or down."""
    lean = 0.06666
    blocks = [
        {"id": 1, "polygon": [[-1, 0], [0, 0], [lean, 1], [-1, 1]], "fixed": True},
        {"id": 9, "polygon": [[0, 0], [1, 0], [1 + lean, 1], [lean, 1]]},
        {"id": 2, "polygon": [[1, 0], [2, 0], [2, 1], [1 + lean, 1]], "fixed": True},
    ]
    model = model_from_json({"blocks": blocks})
    assert lateral_resistance(model).stable
    assert pins.least_wedge_loads(model, frozenset({9})) == {9: 0.0}
    fixed = model_from_json({"blocks": [blocks[0], blocks[2]]})
    assert pins.least_wedge_loads(fixed, frozenset({2})) == {2: 0.0}


def test_without_wedges_contacts_or_an_answer_nothing_is_judged(monkeypatch):
    assert find("pins", Masonry({1: box(0, 0, 1, 1)})).verdict == "not judged"
    loops = {1: box(0, 0, 2, 1), 2: box(0, 1.4, 2, 1), 9: box(1, 1, 0.5, 0.2),
             3: box(-2, 0, 1, 3), 4: box(3, 0, 1, 3)}  # fmt: skip
    floating = modelled(loops, {9})
    found = find("pins", floating)
    assert (found.number, found.verdict) == (None, "not judged")
    assert "does not stand" in found.note
    # A solver that gives up is no wall that falls.
    loops = {1: box(0, 0, 1, 1), 8: box(0, 1, 4, 1), 9: box(3.5, 0, 0.5, 1)}
    gave_up = Solution(LimitStatus.FAILED, None, None, "", "")
    monkeypatch.setattr(HighsSession, "minimise", lambda *_: gave_up)
    found = find("pins", modelled(loops, {9}))
    assert found.number is None
    assert found.note == "What the wedges carry is not known: the solver gave up."
