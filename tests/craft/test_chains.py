"""Joints that go on above each other."""

import tracemalloc

from drystone.craft import Masonry
from tests.craft.walls import courses


def test_the_memory_does_not_grow_with_the_square_of_the_joints():
    wall = Masonry(courses([[1.0] * 1000] * 2))
    assert len(wall.heads) == 2 * 999
    assert wall.shapes
    tracemalloc.start()
    assert {chain.courses for chain in wall.chains} == {2}
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 8e6
