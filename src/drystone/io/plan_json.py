"""The file form of plans: plan.json, described by plan.schema.json (DESIGN 2)."""

import hashlib
import json
import math
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import fields
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jsonschema

from drystone.errors import PlanError
from drystone.indices import INDEX_NAMES
from drystone.io.files import file_bytes, foreign
from drystone.io.json_text import from_plain, json_of, plain, to_plain
from drystone.model.plan import SCHEMA, Plan, PlanMetrics, StoneStep, WedgeStep
from drystone.whole_files import write_whole

MOST_PLAN_BYTES = 100_000_000
"""Larger plans are refused: of a hundred thousand stones, and their wedges."""

_SOURCE_NAMES = ("path", "sha256", "stones", "width_px", "height_px", "files", "reading")
_LONGEST_MESSAGE = 240


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
    write_whole(Path(path), _bytes_of(plan))


def plan_digest(plan: Plan) -> str:
    """Return what plans are told apart by: the first digits of the SHA-256 of plan.json."""
    return hashlib.sha256(_bytes_of(plan)).hexdigest()[:16]


def _bytes_of(plan: Plan) -> bytes:
    text = json.dumps(plan_to_json(plan), ensure_ascii=False, allow_nan=False, indent=1)
    return f"{text}\n".encode()


def read_plan(path: str | Path) -> Plan:
    """Read and validate a plan.json.

    Parameters
    ----------
    path : str or Path
        File, or a folder with a ``plan.json`` in it.

    Raises
    ------
    PlanError
        E202: it cannot be read; E203: it is not JSON; E204: it is not a plan of this version; E205:
        it is not as the schema says.
    """
    path = Path(path)
    if path.is_dir():
        path /= "plan.json"
    try:
        data = file_bytes(path, MOST_PLAN_BYTES)
    except OSError as error:
        what = f"the plan cannot be read ({error.strerror})."
        cure = "Give the plan.json that `drystone plan -o` wrote, or its folder."
        raise PlanError("E202", what, where=str(path), cure=cure) from error
    return plan_from_json(_parsed(data, str(path)), str(path))


def plan_to_json(plan: Plan) -> dict[str, Any]:
    """Return the contents of plan.json, keys in the order of the contract (DESIGN 2)."""
    source = {name: plan.source[name] for name in _SOURCE_NAMES if name in plan.source}
    data = {
        "schema": SCHEMA,
        "version": plan.version,
        "method": plan.method,
        "seed": to_plain(int, plan.seed),
        "settings": plain(plan.settings, ordered=True),
        "units": {
            "length": plan.length_unit,
            "px_per_m": to_plain(float, plan.px_per_m),
            "working_scale": to_plain(float, plan.working_scale),
        },
        "source": plain(source) | plain(
            {name: value for name, value in plan.source.items() if name not in source},
            ordered=True,
        ),
        "wall": {"width": to_plain(float, plan.width), "height": to_plain(float, plan.height)},
        "steps": [_step_to_json(step) for step in plan.steps],
        "unused": to_plain(tuple[int, ...], plan.unused),
        "stopped": plan.stopped,
        "metrics": to_plain(PlanMetrics, plan.metrics),
    }  # fmt: skip
    _validate(data, "plan")
    return data


def _step_to_json(step: StoneStep | WedgeStep) -> dict[str, Any]:
    """Return the fields of a step in their order, the kind as the second, indices in theirs."""
    values = to_plain(type(step), step)
    if indices := values.get("indices"):
        others = sorted(indices.keys() - set(INDEX_NAMES))
        names = [name for name in (*INDEX_NAMES, *others) if name in indices]
        values["indices"] = {name: indices[name] for name in names}
    return {"step": values.pop("step"), "kind": values.pop("kind"), **values}


def _step_from_json(data: Mapping[str, Any]) -> StoneStep | WedgeStep:
    step: type[StoneStep | WedgeStep] = StoneStep if data["kind"] == "stone" else WedgeStep
    # A plan of other hands may leave out what the contract does not ask for, and write 1.0 for 1.
    values = {field.name: data.get(field.name) for field in fields(step)}
    values |= {field.name: int(data[field.name]) for field in fields(step) if field.type is int}
    if step is StoneStep:
        values["indices"] = {name: data["indices"][name] for name in INDEX_NAMES}
    found: StoneStep | WedgeStep = from_plain(step, values)
    return found


def plan_from_json(data: Any, where: str = "plan") -> Plan:
    """Return the plan of the contents of a plan.json."""
    _validate(data, where)
    units, wall = data["units"], data["wall"]
    # A plan of other hands may leave out the two metrics that the contract does not ask for.
    metrics = {field.name: data["metrics"].get(field.name) for field in fields(PlanMetrics)}
    return Plan(
        version=data["version"],
        method=data["method"],
        seed=int(data["seed"]),
        settings=data["settings"],
        length_unit=units["length"],
        px_per_m=to_plain(float, units["px_per_m"]),
        working_scale=float(units["working_scale"]),
        source=data["source"],
        width=float(wall["width"]),
        height=float(wall["height"]),
        steps=tuple(map(_step_from_json, data["steps"])),
        unused=tuple(int(stone_id) for stone_id in data["unused"]),
        stopped=data["stopped"],
        metrics=from_plain(PlanMetrics, metrics),
    )


@cache
def plan_schema() -> dict[str, Any]:
    """Return the JSON Schema (Draft 2020-12) of plan.json."""
    text = resources.files("drystone.io").joinpath("plan.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def _parsed(data: bytes, where: str) -> Any:
    """Return the JSON in the bytes of a plan file; raise PlanError (E203) when there is none.

    Stricter than Python's reader: NaN, infinities and repeated keys are refused.
    """

    def no_json(why: str) -> PlanError:
        cure = "Give the plan.json that `drystone plan -o` wrote; it may be cut short."
        return PlanError("E203", f"the file is not valid JSON ({why}).", where=where, cure=cure)

    def no_number(name: str) -> Any:
        raise ValueError(f"{name} is not a JSON number")

    def without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) < len(pairs):
            twice, _ = Counter(name for name, _ in pairs).most_common(1)[0]
            raise ValueError(f"{_short(twice)} is given twice in one object")
        return found

    with foreign(no_json):
        text = data.decode("utf-8-sig")
        return json_of(text, parse_constant=no_number, object_pairs_hook=without_repeats)


def _validate(data: Any, where: str) -> None:
    """Refuse what is no plan of this version (E204) or not as the schema says (E205)."""
    if not isinstance(data, Mapping) or "schema" not in data:
        what = f'this is not a drystone plan: it is not a JSON object with "schema": "{SCHEMA}".'
        cure = "Give the plan.json that `drystone plan -o` wrote."
        raise PlanError("E204", what, where=where, cure=cure)
    if data["schema"] != SCHEMA:
        what = f"the plan is of version {_short(data['schema'])}; this drystone reads {SCHEMA}."
        cure = "Read it with the drystone that wrote it, or plan again with this one."
        raise PlanError("E204", what, where=f"{where}: $.schema", cure=cure)
    bad = _not_finite(data, "$")
    if bad is not None:
        what = "the number is not finite; JSON has no NaN and no infinity."
        cure = "Write null where nothing could be computed, if the schema allows it."
        raise PlanError("E205", what, where=f"{where}: {_short(bad, quote=False)}", cure=cure)
    errors = list(jsonschema.Draft202012Validator(plan_schema()).iter_errors(data))
    if errors:
        first = errors[0]
        more = f" ({len(errors) - 1} more like this)" if len(errors) > 1 else ""
        what = f"{_short(first.message, quote=False)}{more}."
        where = f"{where}: {_short(first.json_path, quote=False)}"
        raise PlanError("E205", what, where=where, cure=_cure(first))


def _cure(error: jsonschema.ValidationError) -> str:
    """Say what belongs there; of an object, only what is missing or which names it may have."""
    schema = error.schema if isinstance(error.schema, Mapping) else {}
    properties = schema.get("properties", {})
    if error.validator == "required":
        # There is one error for each missing name, which is found in its message alone.
        missing = [name for name in error.validator_value if error.message.startswith(repr(name))]
        schema = properties.get(missing[0], {}) if missing else {}
    elif error.validator == "additionalProperties":
        return f"Known there: {', '.join(properties)}."
    if "$ref" in schema:
        # What is said beside a reference comes before what is said behind it.
        schema = plan_schema()["$defs"][schema["$ref"].removeprefix("#/$defs/")] | schema
    meaning = schema.get("description", "")
    return f"What belongs there: {meaning}" if meaning else "See plan.schema.json."


def _not_finite(value: Any, path: str) -> str | None:
    """Return the JSON path of the first number that is NaN, infinite or beyond a float."""
    if isinstance(value, Mapping):
        items: Iterable[tuple[str, Any]] = ((f".{key}", item) for key, item in value.items())
    elif isinstance(value, list):
        items = ((f"[{index}]", item) for index, item in enumerate(value))
    else:
        large = isinstance(value, int) and abs(value) > sys.float_info.max
        return path if large or (isinstance(value, float) and not math.isfinite(value)) else None
    found = (_not_finite(item, path + name) for name, item in items)
    return next((bad for bad in found if bad is not None), None)


def _short(value: Any, *, quote: bool = True) -> str:
    text = repr(value) if quote else str(value)
    return text if len(text) <= _LONGEST_MESSAGE else f"{text[:_LONGEST_MESSAGE]}..."
