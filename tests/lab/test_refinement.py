import numpy as np
import pytest
import shapely

from drystone_lab.pixels import SHORTEST, exact_model, refinement_errors, tilted_wall
from drystone_lab.timed_walls import exponents


@pytest.mark.parametrize("courses", [3, 4, 5])
def test_walls_have_no_gaps_and_no_joint_along_the_grid(courses):
    wall = tilted_wall(np.random.default_rng(courses), courses)
    shapes = [shapely.Polygon(polygon) for polygon in wall]
    whole = shapely.union_all([shape.buffer(1e-9) for shape in shapes])
    assert whole.geom_type == "Polygon"
    assert not whole.interiors
    assert whole.area == pytest.approx(sum(shape.area for shape in shapes), abs=1e-7)
    joints = [i for i in exact_model(wall).interfaces if i.other != 0]
    assert min(min(np.abs(joint.normal)) for joint in joints) > 0.05
    assert min(joint.length for joint in joints) > 0.9 * SHORTEST


def test_load_multipliers_converge_as_the_resolution_grows():
    heights = (40, 80, 160)
    errors = refinement_errors(heights, walls=3, offsets=1)
    assert errors.shape == (3, 2, 6)
    means = errors.mean(axis=2)  # nan without an answer
    assert all(power <= -0.9 for power in exponents(heights, means.tolist()))
    assert (means[-1] < 0.02).all()
