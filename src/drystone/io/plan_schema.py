"""Is it a plan: the JSON Schema of plan.json, and what else makes a file unusable (DESIGN 2)."""

import json
import math
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import resources
from typing import Any

import jsonschema

from drystone.errors import PlanError
from drystone.io.foreign import foreign
from drystone.io.json_text import json_of
from drystone.model.plan import SCHEMA

_LONGEST_MESSAGE = 240


@cache
def plan_schema() -> dict[str, Any]:
    """Return the JSON Schema (Draft 2020-12) of plan.json."""
    text = resources.files("drystone.io").joinpath("plan.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def parse_plan(data: bytes, where: str) -> Any:
    """Return the JSON in the bytes of a plan file; raise PlanError (E203) when there is none.

    Stricter than Python's reader: NaN, infinities and repeated keys are refused.
    """

    def no_json(why: str) -> PlanError:
        return PlanError(
            "E203", f"the file is no JSON ({why}).", where=where,
            cure="Give the plan.json that `drystone plan -o` wrote; it may be cut short.",
        )  # fmt: skip

    with foreign(no_json):
        return json_of(
            data.decode("utf-8-sig"),
            parse_constant=_refuse_constant,
            object_pairs_hook=_without_repeats,
        )


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"{name} is no JSON number")


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice, _ = Counter(name for name, _ in pairs).most_common(1)[0]
        raise ValueError(f"{_short(twice)} is given twice in one object")
    return found


def validate_plan(data: Any, where: str) -> None:
    """Refuse what is no plan of this version (E204) or not as the schema says (E205)."""
    if not isinstance(data, Mapping) or "schema" not in data:
        raise PlanError(
            "E204",
            f'this is no plan: it is no JSON object with "schema": "{SCHEMA}".',
            where=where,
            cure="Give the plan.json that `drystone plan -o` wrote.",
        )
    if data["schema"] != SCHEMA:
        raise PlanError(
            "E204",
            f"the plan is of version {_short(data['schema'])}; this drystone reads {SCHEMA}.",
            where=f"{where}: $.schema",
            cure="Read it with the drystone that wrote it, or plan again with this one.",
        )
    bad = _not_finite(data, "$")
    if bad is not None:
        raise PlanError(
            "E205",
            "the number is not finite; JSON has no NaN and no infinity.",
            where=f"{where}: {_short(bad, quote=False)}",
            cure="Write null where nothing could be computed, if the schema allows it.",
        )
    errors = list(jsonschema.Draft202012Validator(plan_schema()).iter_errors(data))
    if errors:
        first = errors[0]
        more = f" ({len(errors) - 1} more like this)" if len(errors) > 1 else ""
        raise PlanError(
            "E205",
            f"{_short(first.message, quote=False)}{more}.",
            where=f"{where}: {_short(first.json_path, quote=False)}",
            cure=_cure(first),
        )


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
        return path if isinstance(value, int | float) and not _is_finite(value) else None
    found = (_not_finite(item, path + name) for name, item in items)
    return next((bad for bad in found if bad is not None), None)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _short(value: Any, *, quote: bool = True) -> str:
    text = repr(value) if quote else str(value)
    return text if len(text) <= _LONGEST_MESSAGE else f"{text[:_LONGEST_MESSAGE]}..."
