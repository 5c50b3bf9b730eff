"""Instances of nesting programs (sparrow, jagua-rs): items, each as often as it is demanded."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from drystone.errors import Notice
from drystone.io.file_errors import entry, short, too_large
from drystone.io.outlines_in.gathered import Gathered
from drystone.io.outlines_in.model import METRES, OutlinedStone, OutlineFile, number_in, rectangle
from drystone.io.read_settings import ReadSettings

_MOST_COPIES = 10_000
_GAP = 0.05
"""Between pieces that are laid in a row, as a share of the largest."""


def is_nesting(content: Any) -> bool:
    """Tell an instance of sparrow or jagua-rs."""
    items = _lower(content).get("items") if isinstance(content, Mapping) else None
    return isinstance(items, list) and all(
        isinstance(item, Mapping) and "shape" in _lower(item) for item in items
    )


def _lower(table: Mapping[str, Any]) -> dict[str, Any]:
    return {str(key).lower(): value for key, value in table.items()}


def read_nesting(content: Mapping[str, Any], settings: ReadSettings) -> OutlineFile:
    """Read the items of an instance, each as often as it is demanded.

    Where items lie over each other, as each has an origin of its own, they are laid in a row.
    """
    gathered, copies = Gathered(), 0
    stones = gathered.stones
    for number, item in enumerate(map(_lower, _lower(content)["items"])):
        where, before = f"item {number} (from 0)", len(stones)
        with entry(where):
            demand = int(item.get("demand", 1))
            if demand < 0:
                raise ValueError(f"{demand} of it are demanded")
            own = number_in(item.get("id")) if demand == 1 else None
            gathered.add(where, _of_nesting(_lower(item["shape"])), own)
        copies += demand
        if copies > _MOST_COPIES:
            cure = "Ask for fewer of each."
            raise too_large(f"more than {_MOST_COPIES} items are demanded.", cure)
        stones[before:] = stones[before:] * demand
    unit_m = METRES.get(settings.unit)
    notices = gathered.notices()
    if not settings.unit:
        text = "an instance says no unit: its numbers are taken as px, with y down."
        notices.append(Notice("W119", text, "Name the unit with --unit (unit in Python)."))
    if _overlap(stones):
        stones = list(_in_a_row(stones, whole=unit_m is None))
        notices.append(Notice("W119", "items lie over each other: they are laid in a row."))
    return OutlineFile(stones, unit_m, unit_m is not None, notices=notices, seen_by="none")


def _of_nesting(shape: Mapping[str, Any]) -> Iterator[list[Any]]:
    kind, data = str(shape.get("type", "")).lower().replace("_", ""), shape.get("data", shape)
    if kind == "simplepolygon":
        yield [data]
    elif kind in {"polygon", "multipolygon"}:
        for part in map(_lower, data if kind == "multipolygon" else [data]):
            yield [part["outer"], *(part.get("inner") or ())]
    elif kind == "rectangle":
        data = _lower(data)
        x, y = float(data.get("x_min", 0.0)), float(data.get("y_min", 0.0))
        yield [rectangle((x, y), (x + float(data["width"]), y + float(data["height"])))]
    else:
        raise ValueError(f"a shape of the type {short(repr(shape.get('type')))}")


def _overlap(stones: list[OutlinedStone]) -> bool:
    """Tell whether the boxes of two stones share more than half of the smaller one."""
    low, high = _boxes(stones)
    areas = (high - low).prod(axis=1)
    for i in range(1, len(stones)):
        sides = np.minimum(high[:i], high[i]) - np.maximum(low[:i], low[i])
        shared = sides.clip(0.0).prod(axis=1)
        if (shared > 0.5 * np.minimum(areas[:i], areas[i])).any():
            return True
    return False


def _boxes(stones: list[OutlinedStone]) -> tuple[Any, Any]:
    corners = [np.concatenate(stone.rings) for stone in stones]
    low = np.array([points.min(axis=0) for points in corners]).reshape(-1, 2)
    return low, np.array([points.max(axis=0) for points in corners]).reshape(-1, 2)


def _in_a_row(stones: list[OutlinedStone], *, whole: bool) -> Iterator[OutlinedStone]:
    """Move each behind the last one; by `whole` px, which changes no pixel of it."""
    low, high = _boxes(stones)
    gap, x = _GAP * float((high - low).max()), 0.0
    for stone, start, end in zip(stones, low, high, strict=True):
        shift = np.array([x, 0.0]) - start
        yield stone.moved(partial(np.add, np.ceil(shift) if whole else shift))
        x += float(end[0] - start[0]) + gap + whole
