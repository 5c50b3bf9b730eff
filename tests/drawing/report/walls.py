"""Small walls that were planned, for the tests of the viewer."""

from functools import cache

import numpy as np

import drystone as ds
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json
from drystone.drawing import view_of_wall
from drystone.statics.limit import lateral_resistance

WALL_PX = (130.0, 50.0)


def analysed(wall, blocks_xywh=None, **more):
    """Show a wall that was not planned: a label image, or outlines and their blocks."""
    given = {"blocks_xywh": blocks_xywh}
    model = model_from_labels(wall).model if blocks_xywh is None else model_from_json(given)
    return view_of_wall(wall, model, lateral_resistance(model, mechanism=True), **more)


def result(method="best", px_per_m=None):
    """Plan nine of ten stones: "best" has outlines, "paper" pixels and a wedge."""
    return _planned(method, px_per_m)


@cache
def _planned(method, px_per_m):
    rubble = ds.generate.RubbleSettings(
        count=10, width_px=130, height_px=50, courses=3, area_ratio=0.86
    )
    stones = ds.generate.rubble_stones(rubble, np.random.default_rng(4))
    careless = {"search": {"budget": 1}, "settle": {"margin": 0.2, "trials": 0}}
    settings = ds.method_settings(method).updated(careless)
    return ds.plan_wall(
        stones, *WALL_PX, seed=1, method=method, settings=settings, px_per_m=px_per_m
    )


def written(folder, method="best", px_per_m=None):
    """Write the files of a plan as `drystone plan` does, without pictures."""
    ds.write_plan_folder(result(method, px_per_m), folder)
    return folder
