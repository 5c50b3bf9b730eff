"""Stabilisation remembered by surroundings gives what stabilising afresh gives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import drystone.stabilise.memory as memory_module
from drystone.poses import PoseBook
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import WedgeStock, make_stable, stabilise
from tests.naive.overlap import lowered, overlaps
from tests.stabilise.scenes import BAR, BLOCK, BOOK, bar_on_the_ledge, high_walls, ledge
from tests.strategies import posed_on_walls, repeatable

SETTINGS = StabiliseSettings()


def told(outcome):
    """Everything that an outcome says, comparable."""
    if outcome is None:
        return None
    at = outcome.placement
    wedges = [(w.id, w.under, w.mask.tobytes(), w.row, w.col) for w in outcome.wedges]
    return at.posed.mask.tobytes(), at.row, at.col, at.side, at.rotation_moves, wedges


def afresh(occupied, trial, settings, mean_height_px=12.0):
    """Stabilise from the left in the window that reaches down to the ground, wedges from 50 on."""
    posed, row, col = trial
    reach = memory_module._reach_px(posed)
    top, left = max(0, row - reach), max(0, col - reach)
    window = occupied[top:, left : col + posed.width_px + reach]
    local = posed, row - top, col - left
    found = stabilise(window, local, "left", BOOK, WedgeStock(50, mean_height_px), settings)
    return memory_module._moved(found, top, left, "left", 50)


@repeatable(80)
@given(posed_on_walls())
def test_on_a_site_within_the_window_it_is_stabilise_itself(scene):
    wall, posed, row, col = scene
    book = PoseBook()
    memory = StabiliseMemory(book, 12.0, SETTINGS)
    trial = (posed, row, col)
    expected = stabilise(wall.occupied, trial, "right", book, WedgeStock(50, 12.0), SETTINGS)
    for _ in range(2):
        assert told(memory.stabilise(wall.occupied, trial, "right", 50)) == told(expected)


@pytest.mark.parametrize(
    ("method", "max_turn_deg", "mean_height_px"),
    [("rotation", 15.0, 1.0), ("rotation", 70.0, 1.0), ("wedge", 0.0, 12.0), ("both", 30.0, 70.0)],
)
def test_walls_that_differ_far_below_are_told_apart_where_it_matters(
    method, max_turn_deg, mean_height_px
):
    """One memory for all: what it remembers from one wall must hold in the next."""
    settings = StabiliseSettings(method=method, margin=0.1, max_turn_deg=max_turn_deg)
    memory = StabiliseMemory(BOOK, mean_height_px, settings)

    @repeatable(40)
    @given(walls=high_walls(), posed=st.sampled_from([BAR, BLOCK]), col=st.integers(0, 30))
    def check(walls, posed, col):
        row = lowered(walls[0], posed.mask, col)
        for wall in walls:
            if row is None or overlaps(wall, posed.mask, row, col):
                continue
            trial = (posed, row, col)
            expected = afresh(wall, trial, settings, mean_height_px)
            assert told(memory.stabilise(wall, trial, "left", 50)) == told(expected)

    check()
    assert memory._outcomes.held_bytes > 0  # it did remember


def worked_out(monkeypatch):
    """How deep was looked in each outcome that is worked out from now on."""
    depths = []

    def counted(*arguments):
        outcome = make_stable(*arguments)
        depths.append(outcome.depth)
        return outcome

    monkeypatch.setattr(memory_module, "make_stable", counted)
    return depths


def far_apart(offset):
    """A ledge with much free ground to its left."""
    occupied = np.zeros((24, 200), bool)
    occupied[20:, offset : offset + 14] = True
    return occupied


def test_the_same_surroundings_elsewhere_are_not_worked_out_again(monkeypatch):
    depths = worked_out(monkeypatch)
    book = PoseBook()
    memory = StabiliseMemory(book, 12.0, StabiliseSettings(method="wedge"))
    posed, row, _ = bar_on_the_ledge(ledge(), book)
    here = memory.stabilise(far_apart(60), (posed, row, 62), "left", 90)
    there = memory.stabilise(far_apart(100), (posed, row, 102), "right", 95)
    assert len(depths) == 1
    assert there.placement.col - here.placement.col == 40
    assert (here.placement.side, there.placement.side) == ("left", "right")
    assert there.wedges[0].col - here.wedges[0].col == 40
    assert (here.wedges[0].id, there.wedges[0].id) == (90, 95)
    memory.stabilise(far_apart(101), (posed, row, 102), "right", 95)
    assert len(depths) == 2, "another ledge is another scene"


def test_the_place_in_a_window_that_is_cut_off_at_the_ends_matters():
    site = ledge(site=(24, 40))
    memory = StabiliseMemory(BOOK, 12.0, StabiliseSettings(method="wedge"))
    for col in (2, 4, 2, 6):
        trial = (BAR, 14, col)
        expected = afresh(site, trial, StabiliseSettings(method="wedge"))
        assert told(memory.stabilise(site, trial, "left", 50)) == told(expected)


def test_two_wedges_have_ids_one_after_the_other():
    pillar = np.zeros((24, 50), bool)
    pillar[20:, 16:18] = True
    settings = StabiliseSettings(method="wedge", margin=0.1)
    found = StabiliseMemory(BOOK, 12.0, settings).stabilise(pillar, (BAR, 14, 2), "left", 70)
    assert [wedge.id for wedge in found.wedges] == [70, 71]
