"""Masks as run lengths, the way COCO writes them: column by column, background first."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.io.outlines_in.fill import Room
from drystone.io.outlines_in.model import PlacedMask
from drystone.io.pictures import check_size

_MOST_PX = 2**31
_AT_ONCE = 64


def is_runs(value: object) -> bool:
    """Tell whether something is meant to be run lengths."""
    return isinstance(value, Mapping) and "counts" in value


def size_of(value: Mapping[str, Any]) -> tuple[int, int]:
    """Return width and height of run lengths."""
    height, width = (int(side) for side in value["size"])
    if min(height, width) < 1 or height * width > _MOST_PX:
        raise ValueError(f"a picture of {width} x {height} px")
    return width, height


def mask_of(value: Mapping[str, Any], room: Room) -> PlacedMask | None:
    """Return the mask of run lengths, cut to its bounding box; None when no pixel is set."""
    width, height = size_of(value)
    check_size(width, height, room.where, room.max_px)
    counts = value["counts"]
    runs = unpacked(counts) if isinstance(counts, str | bytes) else _numbers(counts)
    if int(runs.sum()) != width * height:
        raise ValueError(f"counts add up to {int(runs.sum())}, not to {width} x {height} px")
    ends = np.cumsum(runs)
    starts, stops = ends[0::2][: len(ends) // 2], ends[1::2]
    starts, stops = starts[stops > starts], stops[stops > starts]
    if not len(starts):
        return None
    first, last = int(starts[0]) // height, (int(stops[-1]) - 1) // height
    ends = np.clip(ends, first * height, (last + 1) * height)
    runs = ends - np.concatenate(([first * height], ends[:-1]))
    columns = np.repeat(np.arange(len(runs)) % 2 == 1, runs).reshape(-1, height)
    rows = np.flatnonzero(columns.any(axis=0))
    top, bottom = int(rows[0]), int(rows[-1]) + 1
    room.take((bottom - top) * len(columns))
    mask = np.empty((bottom - top, len(columns)), bool)
    for begin in range(0, len(columns), _AT_ONCE):  # what a cache holds
        some = slice(begin, begin + _AT_ONCE)
        mask[:, some] = columns[some, top:bottom].T
    return PlacedMask(mask, top, first)


def unpacked(text: str | bytes) -> NDArray[np.int64]:
    """Return the counts of compressed run lengths.

    Five bits a character, least first, 32 for one more to come; from the fourth count on it is
    the difference to the one before the last.
    """
    data = text.encode() if isinstance(text, str) else text
    counts: list[int] = []
    number, shift = 0, 0
    for byte in data:
        bits = byte - 48
        if not 0 <= bits < 64 or shift > 30:
            raise ValueError(f"{chr(byte)!r} does not belong into packed counts")
        number |= (bits & 31) << shift
        shift += 5
        if bits & 32:
            continue
        if bits & 16:
            number -= 1 << shift
        counts.append(number + counts[-2] if len(counts) > 2 else number)
        number, shift = 0, 0
    if shift:
        raise ValueError("packed counts are cut short")
    return _numbers(counts)


def _numbers(counts: Any) -> NDArray[np.int64]:
    runs = np.asarray(counts)
    if runs.ndim != 1 or (runs.size and runs.dtype.kind not in "iu"):
        raise ValueError("counts are whole numbers")
    if runs.size and (int(runs.min()) < 0 or int(runs.max()) > _MOST_PX):
        raise ValueError("a count is below 0 or too large")
    return runs.astype(np.int64)
