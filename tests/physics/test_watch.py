"""How far blocks get: the largest way of any point, at any time."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from drystone.physics.scene import Scene
from drystone.physics.watch import Watch

SQUARE = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], float)
SCENE = Scene({3: SQUARE * 2, 5: SQUARE * 2 + [10, 0]}, ground_y=-1.0)
"""Two squares of 4 x 4; the unit of length of the engine is 4."""


@dataclass
class Table:
    """Blocks where a test puts them: x, y of the centroid above the ground in units of 4, turn."""

    places: dict[int, tuple[float, float, float]] = field(default_factory=dict)

    @property
    def ids(self) -> tuple[int, ...]:
        return tuple(self.places)

    def poses(self) -> np.ndarray:
        return np.array(list(self.places.values()))


PLANNED = (0.5, 0.75, 0.0)


def test_the_largest_way_counts_and_not_the_last() -> None:
    watch = Watch(SCENE)
    table = Table()
    ways = []
    for x in (0.5, 1.5, 0.75):
        table.places[3] = (x, 0.75, 0.0)
        ways.append(watch.look(table))
    assert ways == pytest.approx([0.0, 4.0, 1.0])
    assert watch.largest(3) == pytest.approx((4.0, 0.0))
    # The other one has not come yet.
    assert watch.largest(5) == (0.0, 0.0)


def test_of_a_turning_block_the_furthest_corner_counts() -> None:
    watch = Watch(SCENE)
    assert watch.look(Table({3: (0.5, 0.75, np.pi / 2)})) == pytest.approx(4.0)
    watch.look(Table({3: (0.5, 0.75, -np.pi / 6)}))
    assert watch.largest(3) == pytest.approx((4.0, 90.0))
    watch.look(Table({3: (0.5, 0.75, -2 * np.pi)}))
    assert watch.largest(3)[1] == pytest.approx(360.0)


def test_a_push_and_a_turn_add_up_where_they_point_the_same_way() -> None:
    watch = Watch(SCENE)
    angle = 0.1
    found = watch.look(Table({3: (0.5 + 1.0, 0.75, angle)}))
    ends = [4.0 + (np.exp(1j * angle) - 1) * (x + 1j * y) for x in (-2, 2) for y in (-2, 2)]
    assert found == pytest.approx(max(map(abs, ends)))


def test_outlines_are_where_blocks_are() -> None:
    watch = Watch(SCENE)
    planned = watch.planned()
    assert np.abs(planned[3] - SQUARE * 2).max() < 1e-12
    assert np.abs(planned[5] - (SQUARE * 2 + [10, 0])).max() < 1e-12
    there = watch.outlines(Table({3: PLANNED}))
    assert list(there) == [3]
    assert np.abs(there[3] - planned[3]).max() < 1e-12
    turned = watch.outlines(Table({3: (1.5, 0.75, np.pi / 2)}))[3]
    assert np.abs(turned[0] - (8.0, 0.0)).max() < 1e-12


def test_an_empty_table() -> None:
    assert Watch(SCENE).look(Table()) == 0.0
