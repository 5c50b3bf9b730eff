"""The file form of plans: plan.json, described by plan.schema.json (DESIGN 2)."""

import json
import operator
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from drystone.errors import PlanError
from drystone.io.file_bytes import file_bytes
from drystone.io.plan_schema import parse_plan, validate_plan
from drystone.model.plan import SCHEMA, Plan, PlanMetrics, Point, StoneStep, WedgeStep
from drystone.whole_files import write_whole

MOST_PLAN_BYTES = 100_000_000
"""Larger plans are refused: of a hundred thousand stones, and their wedges."""

_INDEX_NAMES = ("SF", "LFR", "GDS", "NHR", "IWR", "IS", "LLC")
_METRIC_NAMES = tuple(PlanMetrics.__dataclass_fields__)
_SOURCE_NAMES = ("path", "sha256", "stones", "width_px", "height_px", "files", "reading")


def write_plan(plan: Plan, path: str | Path) -> None:
    """Write a plan as plan.json; equal plans give equal bytes.

    Parameters
    ----------
    plan : Plan
        To be written.
    path : str or Path
        File; it is whole or not there at any time, an existing one is replaced.

    Raises
    ------
    PlanError
        E205: a value that the schema does not allow (NaN among them); E206: the file cannot be
        written.
    """
    text = json.dumps(plan_to_json(plan), ensure_ascii=False, allow_nan=False, indent=1)
    write_whole(Path(path), f"{text}\n".encode())


def read_plan(path: str | Path) -> Plan:
    """Read and validate a plan.json.

    Parameters
    ----------
    path : str or Path
        File, or a folder with a ``plan.json`` in it.

    Raises
    ------
    PlanError
        E202: it cannot be read; E203: it is no JSON; E204: it is no plan of this version; E205: it
        is not as the schema says.
    """
    path = Path(path)
    if path.is_dir():
        path /= "plan.json"
    try:
        data = file_bytes(path, MOST_PLAN_BYTES)
    except OSError as error:
        raise PlanError(
            "E202",
            f"the plan cannot be read ({error.strerror}).",
            where=str(path),
            cure="Give the plan.json that `drystone plan -o` wrote, or its folder.",
        ) from error
    return _from_json(parse_plan(data, str(path)), str(path))


def plan_to_json(plan: Plan) -> dict[str, Any]:
    """Return the contents of plan.json, keys in the order of the contract (DESIGN 2)."""
    source = {name: plan.source[name] for name in _SOURCE_NAMES if name in plan.source}
    data = {
        "schema": SCHEMA,
        "version": plan.version,
        "method": plan.method,
        "seed": _whole(plan.seed),
        "settings": _plain(plan.settings),
        "units": {
            "length": plan.length_unit,
            "px_per_m": _number(plan.px_per_m),
            "working_scale": _number(plan.working_scale),
        },
        "source": _plain(source, ordered=False) | _plain(
            {name: value for name, value in plan.source.items() if name not in source}
        ),
        "wall": {"width": _number(plan.width), "height": _number(plan.height)},
        "steps": [
            _stone_to_json(step) if isinstance(step, StoneStep) else _wedge_to_json(step)
            for step in plan.steps
        ],
        "unused": [_whole(stone_id) for stone_id in plan.unused],
        "stopped": plan.stopped,
        "metrics": {name: _number(getattr(plan.metrics, name)) for name in _METRIC_NAMES},
    }  # fmt: skip
    validate_plan(data, "plan")
    return data


def plan_from_json(data: Mapping[str, Any]) -> Plan:
    """Return the plan of the contents of a plan.json."""
    return _from_json(data, "plan")


def _stone_to_json(step: StoneStep) -> dict[str, Any]:
    others = sorted(set(step.indices) - set(_INDEX_NAMES))
    return {
        "step": _whole(step.step),
        "kind": "stone",
        "stone": _whole(step.stone),
        "angle_deg": _number(step.angle_deg),
        "source_centroid": _numbers(step.source_centroid),
        "centroid": _numbers(step.centroid),
        "side": step.side,
        "cluster": _whole(step.cluster),
        "rotation_moves": _whole(step.rotation_moves),
        "indices": {
            name: _number(step.indices[name])
            for name in (*_INDEX_NAMES, *others)
            if name in step.indices
        },
        "course_height": _number(step.course_height),
        "alpha_left": _number(step.alpha_left),
        "alpha_right": _number(step.alpha_right),
    }


def _wedge_to_json(step: WedgeStep) -> dict[str, Any]:
    return {
        "step": _whole(step.step),
        "kind": "wedge",
        "id": _whole(step.id),
        "under": _whole(step.under),
        "polygon": [_numbers(point) for point in step.polygon],
        "alpha_left": _number(step.alpha_left),
        "alpha_right": _number(step.alpha_right),
    }


def _number(value: float | None) -> float | None:
    # Adding zero turns -0.0 into 0.0: the two are equal, and equal plans give equal bytes.
    return None if value is None else float(value) + 0.0


def _numbers(values: Iterable[float]) -> list[float]:
    return [float(value) + 0.0 for value in values]


def _whole(value: int) -> int:
    return operator.index(value)


def _plain(value: Any, *, ordered: bool = True) -> Any:
    """Return a value of JSON's own types, mappings in alphabetical order if `ordered`."""
    if isinstance(value, Mapping):
        keys = sorted(value) if ordered else value
        return {str(key): _plain(value[key]) for key in keys}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    return value + 0.0 if isinstance(value, float) else value


def _from_json(data: Any, where: str) -> Plan:
    validate_plan(data, where)
    units, wall = data["units"], data["wall"]
    # A plan of other hands may leave out the two metrics that the contract does not ask for.
    metrics: dict[str, Any] = {n: _number(data["metrics"].get(n)) for n in _METRIC_NAMES}
    return Plan(
        version=data["version"],
        method=data["method"],
        seed=int(data["seed"]),
        settings=data["settings"],
        length_unit=units["length"],
        px_per_m=_number(units["px_per_m"]),
        working_scale=float(units["working_scale"]),
        source=data["source"],
        width=float(wall["width"]),
        height=float(wall["height"]),
        steps=tuple(
            _stone_from_json(step) if step["kind"] == "stone" else _wedge_from_json(step)
            for step in data["steps"]
        ),
        unused=tuple(int(stone_id) for stone_id in data["unused"]),
        stopped=data["stopped"],
        metrics=PlanMetrics(**metrics),
    )


def _stone_from_json(data: Mapping[str, Any]) -> StoneStep:
    return StoneStep(
        step=int(data["step"]),
        stone=int(data["stone"]),
        angle_deg=float(data["angle_deg"]),
        source_centroid=_point(data["source_centroid"]),
        centroid=_point(data["centroid"]),
        side=data["side"],
        cluster=int(data["cluster"]),
        rotation_moves=int(data["rotation_moves"]),
        indices={name: _number(data["indices"][name]) for name in _INDEX_NAMES},
        course_height=_number(data.get("course_height")),
        alpha_left=_number(data["alpha_left"]),
        alpha_right=_number(data["alpha_right"]),
    )


def _wedge_from_json(data: Mapping[str, Any]) -> WedgeStep:
    return WedgeStep(
        step=int(data["step"]),
        id=int(data["id"]),
        under=int(data["under"]),
        polygon=tuple(_point(point) for point in data["polygon"]),
        alpha_left=_number(data.get("alpha_left")),
        alpha_right=_number(data.get("alpha_right")),
    )


def _point(pair: Sequence[float]) -> Point:
    return float(pair[0]), float(pair[1])
