"""drystone: plans dry-stone walls from images of found stones.

Examples
--------
>>> import drystone as ds
>>> import numpy as np
>>> bricks = ds.generate.BrickSettings(count=6, height_px=10, aspect=2)
>>> stones = ds.generate.brick_stones(bricks, np.random.default_rng(1))
>>> ds.plan_wall(stones, 60, 20, seed=1, scale=1.0).success
True
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from drystone.shown import show_by

if TYPE_CHECKING:
    from drystone import generate as generate
    from drystone.contacts.blocks import model_from_labels as model_from_labels
    from drystone.contacts.given import model_from_json as model_from_json
    from drystone.drawing.assembly import read_assembly as read_assembly
    from drystone.drawing.report.html import view as view
    from drystone.errors import DrystoneError as DrystoneError
    from drystone.io.plan_folder import write_plan_folder as write_plan_folder
    from drystone.io.plan_json import read_plan as read_plan
    from drystone.io.plan_json import write_plan as write_plan
    from drystone.io.read_stones import ReadSettings as ReadSettings
    from drystone.io.read_stones import read_stones as read_stones
    from drystone.metrics.measure import measure_labels as measure_labels
    from drystone.model.plan import Plan as Plan
    from drystone.model.site import Site as Site
    from drystone.model.stone import Stone as Stone
    from drystone.model.stone import StoneSet as StoneSet
    from drystone.planner.measured import MeasuredPose as MeasuredPose
    from drystone.planner.observe import Observation as Observation
    from drystone.planner.planner import Planner as Planner
    from drystone.planner.settings import PlannerSettings as PlannerSettings
    from drystone.planner.settings import method_settings as method_settings
    from drystone.search.plan_result import PlanResult as PlanResult
    from drystone.search.plan_result import result_of as result_of
    from drystone.search.plan_wall import plan_wall as plan_wall
    from drystone.search.plan_wall import working_scale as working_scale
    from drystone.statics.flow.nonassociative import (
        nonassociative_resistance as nonassociative_resistance,
    )
    from drystone.statics.limit import lateral_resistance as lateral_resistance

# Names are loaded on first use: `drystone --help` must not wait for NumPy and SciPy.
_HOMES = {
    "read_assembly": "drystone.drawing.assembly",
    "DrystoneError": "drystone.errors",
    "read_plan": "drystone.io.plan_json",
    "write_plan": "drystone.io.plan_json",
    "write_plan_folder": "drystone.io.plan_folder",
    "ReadSettings": "drystone.io.read_stones",
    "read_stones": "drystone.io.read_stones",
    "measure_labels": "drystone.metrics.measure",
    "Plan": "drystone.model.plan",
    "Site": "drystone.model.site",
    "Stone": "drystone.model.stone",
    "StoneSet": "drystone.model.stone",
    "view": "drystone.drawing.report.html",
    "PlanResult": "drystone.search.plan_result",
    "result_of": "drystone.search.plan_result",
    "plan_wall": "drystone.search.plan_wall",
    "working_scale": "drystone.search.plan_wall",
    "MeasuredPose": "drystone.planner.measured",
    "Observation": "drystone.planner.observe",
    "Planner": "drystone.planner.planner",
    "PlannerSettings": "drystone.planner.settings",
    "method_settings": "drystone.planner.settings",
    "model_from_labels": "drystone.contacts.blocks",
    "model_from_json": "drystone.contacts.given",
    "lateral_resistance": "drystone.statics.limit",
    "nonassociative_resistance": "drystone.statics.flow.nonassociative",
}

__all__ = ["generate", *_HOMES]  # noqa: PLE0604 - the keys are strings


show_by("plan", lambda one: import_module("drystone.drawing.report.html").view(one)._repr_html_())


def __getattr__(name: str) -> Any:
    if name == "generate":
        return import_module("drystone.generate")
    if name in _HOMES:
        found = getattr(import_module(_HOMES[name]), name)
        if not isinstance(found, type):
            found = import_module("drystone.model.settings").typed(found)
            found.__module__ = __name__  # where pickles look for it
        return globals().setdefault(name, found)
    raise AttributeError(f"module 'drystone' has no attribute {name!r}")
