"""Polygons of plans: every stone and wedge where the plan puts it."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from drystone.errors import PlanError
from drystone.model.placement import Placement
from drystone.model.stone import Stone
from drystone.poses import PoseBook
from drystone.verify.outlines import common_areas, plan_polygons, real_outline
from tests.verify.exact_examples import exact_example
from tests.verify.examples import L_STONE, SLAB, WEDGE, example
from tests.verify.tampering import changed, step_of


def bounds(corners):
    return (*corners.min(axis=0).tolist(), *corners.max(axis=0).tolist())


@pytest.mark.parametrize(("scale", "px_per_m"), [(1.0, None), (0.5, None), (1.0, 200.0)])
def test_every_block_lies_where_the_plan_puts_it(scale, px_per_m):
    """In source px, at any working resolution and in any unit of the plan."""
    made = example(scale, px_per_m)
    groups = plan_polygons(made.plan, made.stones)
    assert [[block for block, _ in group] for group in groups] == [
        [3], [5], [SLAB, WEDGE], [L_STONE], [300]
    ]  # fmt: skip
    found = {block: corners for group in groups for block, corners in group}
    # Outlines of rectangles have their corners cut by half a px.
    assert bounds(found[3]) == pytest.approx((0, 0, 20, 20), abs=0.3)
    assert bounds(found[SLAB]) == pytest.approx((10, 20, 50, 26), abs=0.3)
    assert bounds(found[WEDGE]) == pytest.approx((42, 16, 50, 20), abs=1e-9)
    assert bounds(found[300]) == pytest.approx((74, 0, 84, 12), abs=0.3)
    for corners in found.values():
        shape = shapely.Polygon(corners)
        assert shape.is_valid
        assert shape.exterior.is_ccw


@pytest.mark.parametrize("px_per_m", [None, 200.0])
def test_a_settled_wall_is_its_own_outlines(px_per_m):
    made = exact_example(px_per_m=px_per_m)
    found = dict(pair for group in plan_polygons(made.plan, made.stones) for pair in group)
    settled = dict(made.wall.exact.blocks)
    assert list(found) == list(settled)
    for block, corners in settled.items():
        # A plan gives the places of stones to some 1e-7 px.
        assert np.abs(found[block] - corners).max() < 1e-6


def test_turning_is_counter_clockwise_about_the_centroid():
    """The L lies with its long side down and is turned by 90 degrees."""
    made = example()
    groups = plan_polygons(made.plan, made.stones)
    corners = next(corners for group in groups for block, corners in group if block == L_STONE)
    step = step_of(made.plan, L_STONE)
    centre = shapely.Polygon(corners).centroid
    assert (centre.x, centre.y) == pytest.approx(step.centroid, abs=0.05)
    outline = made.stones.by_id(L_STONE).outline
    turned = np.column_stack([-outline[:, 1], outline[:, 0]]) + step.centroid
    assert np.abs(corners - turned).max() < 1e-9


def test_what_places_nothing_is_left_out():
    made = example()
    plan = changed(changed(made.plan, 3, stone=77), 5, stone=300)
    plan = changed(plan, WEDGE, polygon=((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)))
    groups = plan_polygons(plan, made.stones)
    # Stone 77 is none, 300 comes twice, and the wedge has no area.
    assert [[block for block, _ in group] for group in groups] == [[300], [SLAB], [L_STONE]]
    with pytest.raises(PlanError, match="E215"):
        plan_polygons(replace(made.plan, width=1e9), made.stones)


@pytest.mark.parametrize(
    "polygon",
    [
        pytest.param(((0, 0), (0, 4), (8, 4), (8, 0)), id="clockwise"),
        pytest.param(((0, 0), (8, 0), (8, 4), (0, 4), (0, 0.1), (-0.1, 0)), id="crosses itself"),
    ],
)
def test_polygons_come_counter_clockwise_and_simple(polygon):
    made = example()
    groups = plan_polygons(changed(made.plan, WEDGE, polygon=polygon), made.stones)
    shape = shapely.Polygon(groups[2][1][1])
    assert shape.is_valid
    assert shape.exterior.is_ccw
    assert shape.area == pytest.approx(32.0, abs=0.1)


SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def at(x, y):
    """The square, its lower left corner somewhere else."""
    return SQUARE + np.array([x, y])


def test_common_areas():
    blocks = {1: SQUARE, 2: at(1, 1), 3: at(2.5, 1.5), 4: at(9, 9)}
    areas = common_areas(blocks, [2])
    assert sorted(shapely.Polygon(area).area for area in areas) == pytest.approx([0.75, 1.0])
    assert common_areas(blocks, [4]) == ()
    assert common_areas(blocks, []) == ()
    # Two that are both asked for come once; those that touch have nothing in common.
    assert len(common_areas({1: SQUARE, 2: at(1, 1)}, [2, 1])) == 1
    assert common_areas({1: SQUARE, 2: at(2, 0)}, [1, 2]) == ()


def test_real_outlines_are_in_source_px():
    book = PoseBook(0.5)
    posed = book.pose(Stone(4, np.ones((8, 16), bool)), 0.0)
    outline = real_outline(Placement(posed, 6, 3), 10)  # row and column of a site of 10 working px
    assert outline.bounds == (6.0, 0.0, 22.0, 8.0)
