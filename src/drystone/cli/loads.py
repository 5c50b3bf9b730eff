"""Options of the load case of `drystone analyse`."""

import argparse
import re
from dataclasses import replace
from math import isfinite

from drystone.errors import UsageError
from drystone.statics.loads import (
    Loads,
    gravity_factor,
    growing_with_height,
    point_load,
    support_settlement,
    tilting_table,
    weight,
)
from drystone.statics.model import RigidBlockModel

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
_POINT_LOAD = re.compile(rf"(\d+)@{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER}")


def load_case(
    arguments: argparse.Namespace, model: RigidBlockModel
) -> tuple[RigidBlockModel, Loads]:
    """Return the loads that the options describe, and the model for them."""
    _check(arguments)
    if arguments.settle is not None:
        model, loads = support_settlement(model, arguments.settle)
    elif arguments.load == "height":
        loads = growing_with_height(model)
    elif arguments.load == "gravity":
        nothing = weight(model) * 0.0
        loads = gravity_factor(model, nothing)
    elif arguments.load == "points":
        loads = _points(model, arguments)
    else:
        loads = tilting_table(model)
    if arguments.tilt:
        turned = weight(model, arguments.tilt) - weight(model)
        loads = replace(
            loads, dead=loads.dead + turned, name=f"{loads.name}, tilted by {arguments.tilt:g}°"
        )
    for text in arguments.dead:
        loads = replace(loads, dead=loads.dead + point_load(model, *_parsed(text, "--dead")))
    if arguments.dead:
        loads = replace(loads, name=f"{loads.name}, dead forces ({' '.join(arguments.dead)})")
    return model, loads


def is_plain(arguments: argparse.Namespace) -> bool:
    """Whether the case is the tilting table, and nothing else acts."""
    extra = arguments.tilt or arguments.dead or arguments.settle is not None
    return arguments.load == "tilting" and not extra


def _check(arguments: argparse.Namespace) -> None:
    """Refuse options that would be left unheard."""
    unheard = ""
    if is_range(arguments) and arguments.tilt:
        unheard = "--tilt goes with loads on a standing wall only."
    elif arguments.settle is not None and arguments.load != "tilting":
        unheard = "--settle is a load case of its own; leave --load out."
    elif arguments.live and arguments.load != "points":
        unheard = "--live goes with --load points only."
    if unheard:
        raise UsageError("E138", unheard, where="loads")


def is_range(arguments: argparse.Namespace) -> bool:
    """Whether alpha = 0 means nothing in this case, so that a range is the answer."""
    return arguments.settle is not None or arguments.load == "gravity"


def _points(model: RigidBlockModel, arguments: argparse.Namespace) -> Loads:
    if not arguments.live:
        raise UsageError(
            "E138", "--load points needs forces.", cure="Add --live ID@X,Y:FX,FY once or more."
        )
    live = weight(model) * 0.0
    for text in arguments.live:
        live = live + point_load(model, *_parsed(text, "--live"))
    return Loads(weight(model), live, f"point loads ({' '.join(arguments.live)})")


def _parsed(text: str, option: str) -> tuple[int, tuple[float, float], tuple[float, float]]:
    found = _POINT_LOAD.fullmatch(text)
    if found is None:
        raise UsageError(
            "E138",
            f"{text!r} is no force at a point.",
            where=option,
            cure="Write ID@X,Y:FX,FY, as in 7@120,85:0,-200.",
        )
    x, y, fx, fy = (float(part) for part in found.groups()[1:])
    if not all(isfinite(number) for number in (x, y, fx, fy)):
        raise UsageError("E138", f"{text!r} is not finite.", where=option)
    return int(found.group(1)), (x, y), (fx, fy)
