"""Stabilisation remembered by surroundings gives what stabilising afresh gives."""

import numpy as np
import pytest
from hypothesis import given

import drystone.stabilise.memory as memory_module
from drystone.kernels.raster import Mask
from drystone.model.pose import PosedStone
from drystone.model.wall import Wall
from drystone.poses import PoseBook
from drystone.stabilise.memory import StabiliseMemory
from drystone.stabilise.settings import StabiliseSettings
from drystone.stabilise.stabilise import Stabilised, WedgeStock, stabilise
from tests.stabilise.scenes import bar_on_the_ledge, ledge
from tests.strategies import posed_on_walls, repeatable

SETTINGS = StabiliseSettings()


def told(outcome: Stabilised | None) -> object:
    """Everything that an outcome says, comparable."""
    if outcome is None:
        return None
    at = outcome.placement
    wedges = [(w.id, w.under, w.mask.tobytes(), w.row, w.col) for w in outcome.wedges]
    return at.posed.mask.tobytes(), at.row, at.col, at.side, at.rotation_moves, wedges


@repeatable(80)
@given(posed_on_walls())
def test_on_a_site_within_the_window_it_is_stabilise_itself(
    scene: tuple[Wall, PosedStone, int, int],
) -> None:
    wall, posed, row, col = scene
    book = PoseBook()
    memory = StabiliseMemory(book, 12.0, SETTINGS)
    trial = (posed, row, col)
    expected = stabilise(wall.occupied, trial, "right", book, WedgeStock(50, 12.0), SETTINGS)
    for _ in range(2):
        assert told(memory.stabilise(wall.occupied, trial, "right", 50)) == told(expected)


def far_apart(offset: int) -> Mask:
    """A ledge with much free ground to its left."""
    occupied = np.zeros((24, 200), bool)
    occupied[20:, offset : offset + 14] = True
    return occupied


def test_the_same_surroundings_elsewhere_are_not_worked_out_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls = []

    def counted(*arguments: object) -> Stabilised | None:
        calls.append(arguments)
        return stabilise(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(memory_module, "stabilise", counted)
    book = PoseBook()
    memory = StabiliseMemory(book, 12.0, StabiliseSettings(method="wedge"))
    posed, row, _ = bar_on_the_ledge(ledge(), book)
    here = memory.stabilise(far_apart(60), (posed, row, 62), "left", 90)
    there = memory.stabilise(far_apart(100), (posed, row, 102), "right", 95)
    assert len(calls) == 1
    assert here is not None
    assert there is not None
    assert there.placement.col - here.placement.col == 40
    assert (here.placement.side, there.placement.side) == ("left", "right")
    assert there.wedges[0].col - here.wedges[0].col == 40
    assert (here.wedges[0].id, there.wedges[0].id) == (90, 95)
    memory.stabilise(far_apart(101), (posed, row, 102), "right", 95)
    assert len(calls) == 2, "another ledge is another scene"


def test_forgetting_changes_nothing() -> None:
    book = PoseBook()
    keeps = StabiliseMemory(book, 12.0, SETTINGS)
    forgets = StabiliseMemory(book, 12.0, SETTINGS, capacity=1)
    posed, row, _ = bar_on_the_ledge(ledge(), book)
    for offset in (60, 70, 60, 80, 60):
        trial = (posed, row, offset + 2)
        found = [m.stabilise(far_apart(offset), trial, "left", 9) for m in (keeps, forgets)]
        assert told(found[0]) == told(found[1])
