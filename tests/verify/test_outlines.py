"""Polygons of plans: every stone and wedge where the plan puts it."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from drystone.errors import PlanError
from drystone.kernels.polygons import turn
from drystone.verify.outlines import common_areas, plan_polygons
from tests.polygons import box_of
from tests.verify.exact_examples import exact_example
from tests.verify.examples import L_STONE, SLAB, WEDGE, example
from tests.verify.tampering import changed


@pytest.mark.parametrize("make", [example, exact_example])
@pytest.mark.parametrize(("scale", "px_per_m"), [(1.0, None), (0.5, None), (1.0, 200.0)])
def test_every_block_lies_where_the_plan_puts_it(make, scale, px_per_m):
    """Turned counter-clockwise about its centroid, at any working resolution and in any unit."""
    made = make(scale, px_per_m)
    groups = plan_polygons(made.plan, made.stones)
    assert [[block for block, _ in group] for group in groups] == [
        [3], [5], [SLAB, WEDGE], [L_STONE], [300]
    ]  # fmt: skip
    found, unit = dict(pair for group in groups for pair in group), px_per_m or 1.0
    for step in made.plan.stone_steps:
        turned = turn(made.stones.by_id(step.stone).outline, step.angle_deg)
        assert np.abs(found[step.stone] - turned - np.array(step.centroid) * unit).max() < 1e-9
    assert shapely.Polygon(found[L_STONE]).bounds == pytest.approx((64, 0, 72, 12), abs=0.3)
    assert shapely.Polygon(found[WEDGE]).bounds == pytest.approx((42, 16, 50, 20), abs=0.03)
    # A plan gives the places of stones to some 1e-7 px.
    for block, corners in made.wall.exact.blocks if make is exact_example else ():
        assert np.abs(found[block] - corners).max() < 1e-6


def test_what_places_nothing_is_left_out_and_polygons_come_counter_clockwise_and_simple():
    made = example()

    def found(polygon, plan=made.plan):
        return plan_polygons(changed(plan, WEDGE, polygon=polygon), made.stones)

    # Stone 77 is none, 300 comes twice, and the wedge has no area.
    plan = changed(changed(made.plan, 3, stone=77), 5, stone=300)
    groups = found(((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)), plan)
    assert [[block for block, _ in group] for group in groups] == [[300], [SLAB], [L_STONE]]
    with pytest.raises(PlanError, match="E215"):
        plan_polygons(replace(made.plan, width=1e9), made.stones)
    clockwise = (0, 0), (0, 4), (8, 4), (8, 0)
    crossing = (0, 0), (8, 0), (8, 4), (0, 4), (0, 0.1), (-0.1, 0)
    for polygon in (clockwise, crossing):
        shape = shapely.Polygon(found(polygon)[2][1][1])
        assert (shape.is_valid, shape.exterior.is_ccw) == (True, True)
        assert shape.area == pytest.approx(32.0, abs=0.1)


def test_common_areas():
    corners = (0, 0), (1, 1), (2.5, 1.5), (9, 9)
    blocks = {number: box_of(*corner, 2, 2) for number, corner in enumerate(corners, 1)}
    areas = common_areas(blocks, [2])
    assert sorted(shapely.Polygon(area).area for area in areas) == pytest.approx([0.75, 1.0])
    assert common_areas(blocks, [4]) == common_areas(blocks, []) == ()
    # Two that are both asked for come once; those that touch have nothing in common.
    assert len(common_areas({1: blocks[1], 2: blocks[2]}, [2, 1])) == 1
    assert common_areas({1: blocks[1], 2: box_of(2, 0, 2, 2)}, [1, 2]) == ()
