"""Load cases by the words that ask for them, as `drystone analyse` has them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
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


@dataclass(frozen=True)
class LoadCase:
    """A load case as it is asked for."""

    load: str  # what grows
    tilt: float  # turns gravity towards the right, degrees
    dead: Sequence[str]  # forces at points, as they are written
    live: Sequence[str]
    settle: int | None

    def __post_init__(self) -> None:
        unheard = ""
        if self.is_range and self.tilt:
            unheard = "--tilt goes with loads on a standing wall only."
        elif self.settle is not None and self.load != "tilting":
            unheard = "--settle is a load case of its own; leave --load out."
        elif self.live and self.load != "points":
            unheard = "--live goes with --load points only."
        if unheard:
            raise UsageError("E138", unheard, where="loads")

    @property
    def is_plain(self) -> bool:
        """Whether the case is the tilting table, and nothing else acts."""
        return self.load == "tilting" and not (self.tilt or self.dead or self.settle is not None)

    @property
    def is_range(self) -> bool:
        """Whether alpha = 0 means nothing in this case, so that a range is the answer."""
        return self.settle is not None or self.load == "gravity"


def load_case(case: LoadCase, model: RigidBlockModel) -> tuple[RigidBlockModel, Loads]:
    """Return the loads of a case, and the model for them."""
    if case.settle is not None:
        model, loads = support_settlement(model, case.settle)
    elif case.load == "height":
        loads = growing_with_height(model)
    elif case.load == "gravity":
        nothing = weight(model) * 0.0
        loads = gravity_factor(model, nothing)
    elif case.load == "points":
        loads = _points(model, case)
    else:
        loads = tilting_table(model)
    if case.tilt:
        turned = weight(model, case.tilt) - weight(model)
        loads = replace(
            loads, dead=loads.dead + turned, name=f"{loads.name}, tilted by {case.tilt:g}°"
        )
    for text in case.dead:
        loads = replace(loads, dead=loads.dead + point_load(model, *_parsed(text, "--dead")))
    if case.dead:
        loads = replace(loads, name=f"{loads.name}, dead forces ({' '.join(case.dead)})")
    return model, loads


def _points(model: RigidBlockModel, case: LoadCase) -> Loads:
    if not case.live:
        raise UsageError(
            "E138", "--load points needs forces.", cure="Add --live ID@X,Y:FX,FY once or more."
        )
    live = weight(model) * 0.0
    for text in case.live:
        live = live + point_load(model, *_parsed(text, "--live"))
    return Loads(weight(model), live, f"point loads ({' '.join(case.live)})")


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
