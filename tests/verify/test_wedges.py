from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given

from drystone.kernels.polygons import Points
from drystone.model.plan import WedgeStep
from drystone.stabilise.settings import StabiliseSettings
from drystone.statics.contacts.settled import PlacedPolygons, model_of_outlines
from drystone.statics.model import RigidBlockModel
from drystone.verify.wedges import check_settled_wedge, thinnest
from tests.polygons import simple_polygons
from tests.strategies import repeatable

STEP = WedgeStep(3, 9, 7, (), None, None)
SETTINGS = StabiliseSettings(min_wedge_px=2, max_wedge_height=0.5)


def box(left: float, bottom: float, right: float, top: float) -> Points:
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def model(wedge: Points, *more: tuple[int, Points]) -> RigidBlockModel:
    """A pillar, a lower one, a slab on the first, and a wedge that may hold it."""
    blocks = [(1, box(0, 0.01, 5, 8)), (2, box(10, 0.01, 15, 5)), (7, box(0, 8.01, 15, 10))]
    return model_of_outlines(PlacedPolygons.of([*blocks, (9, wedge), *more]), 0.58, 0.1)


def found(wedge: Points, *more: tuple[int, Points], **settings: float) -> list[str]:
    limits = replace(SETTINGS, **settings)
    problems = check_settled_wedge(STEP, wedge, model(wedge, *more), limits, 12.0, 1.0)
    assert all(problem.step == 3 for problem in problems)
    return [f"{problem.code} {problem.message}" for problem in problems]


def test_wedge_between_a_stone_and_what_is_below_is_none_of_a_problem() -> None:
    assert found(box(11, 5.01, 14, 8.0)) == []


def test_wedge_must_touch_its_stone_from_below() -> None:
    assert found(box(11, 5.01, 14, 7.85)) == ["E223 wedge 9 does not touch stone 7 from below."]
    # It stands on the stone that it should hold, and at its side.
    (holds, stands) = found(box(5, 10.01, 8, 12.5))
    assert "does not touch" in holds
    assert "stands on nothing" in stands
    assert "does not touch" in found(box(15.05, 0, 18, 9), max_wedge_height=2)[0]


def test_wedge_must_stand_on_something() -> None:
    assert found(box(11, 5.2, 14, 8.0)) == ["E223 wedge 9 stands on nothing."]
    on_ground = found(box(6, 0.01, 9, 8.0), max_wedge_height=1)
    assert on_ground == []


def test_wedge_may_stand_on_another_that_comes_after_it() -> None:
    upper, lower = box(11, 6.52, 14, 8.0), (10, box(11, 5.01, 14, 6.51))
    assert found(upper, lower, min_wedge_px=1) == []
    assert found(upper, min_wedge_px=1) == ["E223 wedge 9 stands on nothing."]


@pytest.mark.parametrize(
    ("wedge", "wrong"),
    [
        (box(11, 5.01, 13.0, 8.0), False),
        (box(11, 5.01, 12.9, 8.0), True),  # too narrow
        (np.array([[11, 5.01], [14, 5.01], [14, 8.0], [11, 7.02]]), False),
        (np.array([[11, 5.01], [14, 5.01], [14, 8.0], [11, 7.0]]), True),  # too thin at its end
    ],
)
def test_wedge_has_the_size_of_one(wedge: Points, wrong: bool) -> None:
    assert [line[:4] for line in found(wedge)] == (["E224"] if wrong else [])


def test_largest_height_is_a_share_of_the_mean_height_of_stones() -> None:
    wedge = box(11, 5.01, 14, 8.0)
    assert found(wedge, max_wedge_height=2.99 / 12) == []
    (line,) = found(wedge, max_wedge_height=2.98 / 12)
    assert "3 source px wide and 2.99 to 2.99 high" in line
    # Never less than the smallest one may be.
    assert found(wedge, max_wedge_height=0.01, min_wedge_px=3)[0].startswith("E224")


def test_sizes_are_said_in_source_px_and_set_in_working_px() -> None:
    wedge = box(11, 5.01, 14, 8.0)
    at_half = check_settled_wedge(STEP, wedge, model(wedge), SETTINGS, 6.0, 0.5)
    assert ["E224"] == [problem.code for problem in at_half]
    assert "allow 4 to a height of 6." in at_half[0].message


@repeatable(30)
@given(simple_polygons())
def test_thinnest_is_the_shortest_of_many_upright_chords(corners: Points) -> None:
    """The slow twin: chords at columns just inside all corners and between them."""
    polygon = shapely.Polygon(corners)
    _, low, _, high = polygon.bounds
    x = np.unique(corners[:, 0])
    columns = np.concatenate([x[:-1] + 1e-9, x[1:] - 1e-9, (x[1:] + x[:-1]) / 2])
    chords = []
    for column in columns.tolist():
        line = shapely.LineString([(column, low - 1), (column, high + 1)])
        parts = shapely.get_parts(shapely.intersection(line, polygon))
        chords += [part.length for part in parts if part.length > 0]
    assert thinnest(corners) <= min(chords) + 1e-6
    assert thinnest(corners) == pytest.approx(min(chords), abs=1e-5 * (1 + high - low))


def test_thinnest_of_a_fork_is_its_thinner_prong() -> None:
    fork = np.array([[0, 0], [9, 0], [9, 2], [3, 2], [3, 4], [9, 4], [9, 5], [0, 5]], float)
    assert thinnest(fork) == 1.0
    assert thinnest(np.array([[0.0, 0.0], [9.0, 0.0], [0.0, 4.0]])) == 0.0
