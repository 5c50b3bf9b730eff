"""The block model that is written beside a plan on outlines."""

import json

import numpy as np
import pytest
import shapely

from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.contacts.settled import model_of_outlines
from drystone.io.plan_folder import blocks_to_json
from drystone.model.site import Site
from drystone.model.wall import Wall
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND
from tests.verify.exact_examples import SETTINGS, exact_example
from tests.verify.examples import WEDGE, example

SCALES = [(1.0, None), (0.5, None), (1.0, 200.0), (0.5, 137.0)]


def built(scale=1.0, px_per_m=None):
    """Return a wall with a wedge, and its model at another friction than that of its plan."""
    wall = exact_example(scale, px_per_m).wall
    return wall, model_of_outlines(wall.outlines, 0.7, SETTINGS.settle.contact_px)


@pytest.mark.parametrize(("scale", "px_per_m"), SCALES)
def test_what_is_written_is_the_model_in_the_units_of_the_plan(scale, px_per_m):
    wall, model = built(scale, px_per_m)
    units = px_per_m or 1.0
    read = model_from_json(json.loads(json.dumps(blocks_to_json(wall, model))))
    assert read.mu == model.mu == 0.7
    assert [block.id for block in read.blocks] == [block.id for block in model.blocks]
    for one, other in zip(read.blocks, model.blocks, strict=True):
        assert one.area * units**2 == pytest.approx(other.area, rel=1e-9)
        assert np.array(one.centroid) * units == pytest.approx(np.array(other.centroid))
        assert not one.fixed
    assert len(read.interfaces) == len(model.interfaces) > 6
    for one, other in zip(read.interfaces, model.interfaces, strict=True):
        assert (one.block, one.other, one.normal) == (other.block, other.other, other.normal)
        assert one.points * units == pytest.approx(other.points)
    assert any(interface.other == GROUND for interface in read.interfaces)
    there, here = lateral_resistance(read), lateral_resistance(model)
    assert there.left.alpha == pytest.approx(here.left.alpha, abs=1e-9)
    assert there.right.alpha == pytest.approx(here.right.alpha, abs=1e-9)
    assert here.left.success
    assert here.right.success


@pytest.mark.parametrize("px_per_m", [None, 200.0])
def test_polygons_are_those_of_the_plan_wedges_too(px_per_m):
    example_ = exact_example(1.0, px_per_m)
    wall, model = built(1.0, px_per_m)
    polygons = polygons_from_json(blocks_to_json(wall, model))
    assert set(polygons) == {s.stone for s in example_.plan.stone_steps} | {WEDGE}
    for step in example_.plan.stone_steps:
        middle = shapely.Polygon(polygons[step.stone]).centroid
        assert (middle.x, middle.y) == pytest.approx(step.centroid, abs=1e-9)
    (wedge,) = example_.plan.wedge_steps
    planned, found = shapely.Polygon(wedge.polygon), shapely.Polygon(polygons[WEDGE])
    assert planned.symmetric_difference(found).area == pytest.approx(0.0, abs=1e-9)


def test_a_wall_of_pixels_needs_none():
    _, model = built()
    with pytest.raises(ValueError, match="are their pixels"):
        blocks_to_json(example().wall, model)


def test_an_empty_wall_has_no_blocks():
    wall = Wall.empty(Site.from_source(40.0, 20.0, 0.5), exact=True)
    read = blocks_to_json(wall, model_of_outlines(wall.outlines, 0.58, 0.1))
    assert read == {"mu": 0.58, "blocks": [], "interfaces": []}
    assert model_from_json(read).blocks == ()
