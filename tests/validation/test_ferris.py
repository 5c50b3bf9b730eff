"""Walls of Ferris and Tin-Loi (2001), associated flow.

M. C. Ferris and F. Tin-Loi, Limit analysis of frictional block assemblies as a mathematical
program with complementarity constraints, International Journal of Mechanical Sciences 43 (2001)
209-224.

The load factors are given to five digits; the tolerance is half a unit of the last one.
"""

import json

import pytest

from drystone.contacts.given import model_from_json
from drystone.statics.limit import lateral_resistance
from drystone_lab.statics_cases import WALLS

PUBLISHED = {
    1: (33, 83, 0.64286),
    2: (55, 141, 0.58000),
    3: (46, 102, 0.40369),
    4: (55, 116, 0.33195),
    5: (61, 120, 0.23964),
    6: (146, 345, 0.34782),
}


def assert_published(model, blocks, contacts, alpha):
    assert (len(model.blocks), len(model.interfaces)) == (blocks, contacts)
    both = lateral_resistance(model)
    assert both.left.alpha == pytest.approx(alpha, abs=5e-6)
    assert both.right.alpha == pytest.approx(alpha, abs=5e-6)


@pytest.mark.parametrize("wall", WALLS, ids=lambda wall: str(wall.number))
def test_from_the_courses(wall):
    assert_published(wall.model, *PUBLISHED[wall.number])
    assert (wall.blocks, wall.contacts, wall.associative) == PUBLISHED[wall.number]


@pytest.mark.parametrize("wall", WALLS, ids=lambda wall: str(wall.number))
def test_from_the_published_files(wall, data_dir):
    data = json.loads((data_dir / "ferris" / f"ferris_ex{wall.number}.json").read_text("utf-8"))
    assert_published(model_from_json(data), *PUBLISHED[wall.number])
    assert sorted(map(tuple, data["blocks_xywh"])) == sorted(wall.rectangles)
