"""Walls of Ferris and Tin-Loi (2001), associated flow.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, International Journal of Mechanical Sciences 43 (2001)
209-224.

The load factors are given to five digits; the tolerance is half a unit of the last one.
"""

import json

import pytest

from drystone.statics.limit import lateral_resistance
from drystone_lab.statics_cases import WALLS

each_wall = pytest.mark.parametrize("wall", WALLS, ids=lambda wall: str(wall.number))


@each_wall
def test_load_factors(wall):
    assert (len(wall.model.blocks), len(wall.model.interfaces)) == (wall.blocks, wall.contacts)
    both = lateral_resistance(wall.model)
    expected = (wall.associative,) * 2
    assert (both.left.alpha, both.right.alpha) == pytest.approx(expected, abs=5e-6)


def test_the_numbers_are_those_of_the_paper():
    assert [(wall.blocks, wall.contacts, wall.associative) for wall in WALLS] == [
        (33, 83, 0.64286),
        (55, 141, 0.58000),
        (46, 102, 0.40369),
        (55, 116, 0.33195),
        (61, 120, 0.23964),
        (146, 345, 0.34782),
    ]


@each_wall
def test_the_published_files_hold_these_walls(wall, data_dir):
    data = json.loads((data_dir / "ferris" / f"ferris_ex{wall.number}.json").read_text("utf-8"))
    assert sorted(map(tuple, data["blocks_xywh"])) == sorted(wall.rectangles)
    assert data["mu"] == wall.model.mu
