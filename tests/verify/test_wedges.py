from dataclasses import replace

import numpy as np

from drystone.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.kernels.polygons import Points, no_polygons
from drystone.model.plan import WedgeStep
from drystone.settle.wedge import WedgeLimits
from drystone.statics.model import RigidBlockModel
from drystone.verify.pieces import check_settled_wedge

STEP = WedgeStep(3, 9, 7, (), None, None)
LIMITS = WedgeLimits(least_thickness=1.0, greatest_height=6.0, greatest_area=30.0)
SLAB = np.array([[0, 8.01], [15, 8.01], [15, 10], [0, 10]])
WIDTH = 20.0


def box(left: float, bottom: float, right: float, top: float) -> Points:
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def model(wedge: Points, *more: tuple[int, Points]) -> RigidBlockModel:
    """A pillar, a lower one, a slab on the first, and a wedge that may hold it."""
    blocks = [(1, box(0, 0.01, 5, 8)), (2, box(10, 0.01, 15, 5)), (7, SLAB)]
    return model_of_outlines(PlacedPolygons.of([*blocks, (9, wedge), *more]), 0.58, 0.1)


def found(wedge: Points, *more: tuple[int, Points], **limits: float) -> list[str]:
    blocks = model(wedge, *more)
    wall = no_polygons().added([box(0, 0.01, 5, 8), box(10, 0.01, 15, 5), SLAB, wedge])
    problems = check_settled_wedge(
        STEP, wedge, blocks, SLAB, wall, WIDTH, replace(LIMITS, **limits)
    )
    assert all(problem.step == 3 for problem in problems)
    return [f"{problem.code} {problem.message}" for problem in problems]


def test_wedge_must_touch_its_stone_from_below() -> None:
    assert found(box(11, 5.01, 14, 8.0)) == []
    assert found(box(11, 5.01, 14, 7.85)) == ["E223 wedge 9 does not touch stone 7 from below."]
    # It stands on the stone that it should hold, and at its side.
    (holds, stands) = found(box(5, 10.01, 8, 12.5))
    assert "does not touch" in holds
    assert "stands on nothing" in stands
    assert "does not touch" in found(box(15.05, 0, 18, 9))[0]


def test_wedge_must_stand_on_something() -> None:
    assert found(box(11, 5.2, 14, 8.0)) == ["E223 wedge 9 stands on nothing."]
    on_ground = found(box(5.5, 0.01, 9.5, 8.0), greatest_height=9, greatest_area=99)
    assert [line[:4] for line in on_ground] == ["E224"]
    # It may stand on another that comes after it.
    upper, lower = box(11, 6.52, 14, 8.0), (10, box(11, 5.01, 14, 6.51))
    assert found(upper, lower) == []
    assert found(upper) == ["E223 wedge 9 stands on nothing."]


def test_wedge_is_one_that_a_mason_would_cut() -> None:
    """The limits themselves are tested beside the rule."""
    (line,) = found(box(11, 5.01, 13.9, 8.0), greatest_height=2.98)
    assert line == (
        "E224 no mason would cut wedge 9 (source px): 2.9 wide, at least 3; "
        "2.99 high, at most 2.98; 1.031 times as high as wide, at most 1."
    )
    # Rounding to the grid is no fault.
    assert found(box(11, 5.01, 13.999995, 7.999995)) == []


def test_wedge_at_the_end_of_the_wall_has_something_beside_it() -> None:
    wedge = box(11, 5.01, 14, 8.0)
    assert found(wedge, room_px=5.0) == []
    (line,) = found(wedge, room_px=5.1)
    assert line.endswith("(source px): nothing beside it at the end of the wall.")
