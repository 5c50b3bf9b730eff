"""Assemblies of small plans, for exports that are read back."""

import json
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shapely

import drystone as ds
from drystone.drawing.assembly import read_assembly
from drystone.generate import RubbleSettings, rubble_stones
from drystone.io.plan_folder import BLOCKS, blocks_to_json
from drystone.io.wall_image import write_wall_image
from drystone.model.wedge_shape import WedgeSettings
from drystone.settle.settings import SettleSettings

PX_PER_M = 137.0

METRIC = ("exact", "raster-m")
"""Both are in metres: a plan in px that is told its scale afterwards, and one that says it."""

THICKNESS_M = 0.21


def assert_in_place(mesh, part, abs_m=1e-9):
    """A mesh is closed, faces outward, and fills what a part takes up in the wall."""
    assert mesh.is_watertight
    area = shapely.Polygon(part.corners).area
    assert mesh.volume == pytest.approx(area * THICKNESS_M, rel=max(1e-9, 1e2 * abs_m))
    low, high = part.corners.min(axis=0), part.corners.max(axis=0)
    expected = [[low[0], 0.0, low[1]], [high[0], THICKNESS_M, high[1]]]
    assert mesh.bounds == pytest.approx(np.array(expected), abs=abs_m)


@cache
def assembly(name, px_per_m=PX_PER_M):
    """Return one of METRIC; without a scale those of plans in px are in px."""
    told = None if name.endswith("-m") else px_per_m
    metric = name.endswith("-m") or told is not None
    with tempfile.TemporaryDirectory() as folder:
        write_plan_folder(name, Path(folder))
        return read_assembly(
            folder, px_per_m=told, thickness_m=THICKNESS_M if metric else None, density_kg_m3=2450.0
        )


def write_plan_folder(name, folder):
    """Write the files of a plan as `drystone plan` does, without pictures."""
    made = planned(name)
    ds.write_plan(made.plan, folder / "plan.json")
    if made.wall.outlines is not None:
        (folder / BLOCKS).write_text(json.dumps(blocks_to_json(made.wall, made.model)))
    write_wall_image(made.wall.labels, folder)
    return folder


@cache
def source_stones():
    """Return the stones of all plans."""
    rubble = RubbleSettings(count=9, width_px=110.0, height_px=40.0, courses=2, tilt_deg=14.0)
    return rubble_stones(rubble, np.random.default_rng(4))


@cache
def planned(name):
    """Plan one of METRIC: with outlines and a wedge, or on pixels."""
    exact = name.startswith("exact")
    settings = ds.method_settings("best" if exact else "paper")
    # So small that it decides nothing: in px and in metres the wedge is the same.
    small = WedgeSettings(thickness=0.01, thickness_mm=1.5)
    search, careless = replace(settings.search, budget=1), SettleSettings(margin=0.2, trials=0)
    settings = replace(settings, search=search, wedge=small, settle=careless)
    scale = {"scale": 1.0 if exact else 0.5, "px_per_m": PX_PER_M if name.endswith("-m") else None}
    stones, seed = source_stones(), 35 if exact else 3
    return ds.plan_wall(stones, 110.0, 40.0, seed=seed, settings=settings, **scale)
