"""Small plans and walls, for exports that are read back and for the viewer."""

import tempfile
from dataclasses import replace
from functools import cache

import numpy as np

import drystone as ds
from drystone.contacts.blocks import model_from_labels
from drystone.contacts.given import model_from_json, polygons_from_json
from drystone.drawing import view_of_wall
from drystone.drawing.assembly import read_assembly
from drystone.generate import RubbleSettings, rubble_stones
from drystone.model.wedge_shape import WedgeSettings
from drystone.settle.settings import SettleSettings
from drystone.statics.limit import lateral_resistance

PX_PER_M = 137.0

METRIC = {"exact": ("best", None), "raster-m": ("paper", PX_PER_M)}
"""Both are in metres: a plan in px that is told its scale afterwards, and one that says it."""

THICKNESS_M = 0.21


@cache
def assembly(name, px_per_m=PX_PER_M):
    """Read one of METRIC; without a scale that of outlines is in px."""
    with tempfile.TemporaryDirectory() as folder:
        ds.write_plan_folder(planned(*METRIC[name]), folder)
        thickness_m = None if px_per_m is None else THICKNESS_M
        return read_assembly(
            folder, px_per_m=px_per_m, thickness_m=thickness_m, density_kg_m3=2450.0
        )


@cache
def source_stones():
    rubble = RubbleSettings(count=9, width_px=110.0, height_px=40.0, courses=2, tilt_deg=14.0)
    return rubble_stones(rubble, np.random.default_rng(4))


def planned(method="best", px_per_m=None):
    """Plan eight stones with a wedge: on outlines, or by the method of the paper on pixels."""
    return _planned(method, px_per_m)


@cache
def _planned(method, px_per_m):
    exact, settings = method == "best", ds.method_settings(method)
    # So small that it decides nothing: in px and in metres the wedge is the same.
    small = WedgeSettings(thickness=0.01, thickness_mm=1.5)
    search, careless = replace(settings.search, budget=1), SettleSettings(margin=0.2, trials=0)
    settings = replace(settings, search=search, wedge=small, settle=careless)
    scale = {"scale": 1.0 if exact else 0.5, "px_per_m": px_per_m}
    stones, seed = source_stones(), 41 if exact else 20
    return ds.plan_wall(stones, 110.0, 40.0, seed=seed, settings=settings, **scale)


def analysed(wall, **more):
    """Show a wall that was not planned: a label image, or blocks as a model says of them."""
    given = {"blocks_xywh": wall}
    labels = isinstance(wall, np.ndarray)
    model = model_from_labels(wall).model if labels else model_from_json(given)
    shown = wall if labels else polygons_from_json(given)
    return view_of_wall(shown, model, lateral_resistance(model, mechanism=True), **more)
