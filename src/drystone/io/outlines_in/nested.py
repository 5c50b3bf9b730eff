"""Which of many masks that lie in each other are stones."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from drystone.errors import InputError, Notice
from drystone.io.listed import MANY, listed
from drystone.io.outlines_in.fill import filled_area, united
from drystone.io.outlines_in.model import OutlinedStone, PlacedMask
from drystone.io.patches import enclosed

INSIDE = 0.8
"""Share of a mask that lies in another one for it to count as its part."""

_MOST_PAIRS = 200_000
_MOST_SHARED_PX = 1_000_000_000


def pixels_of(stone: OutlinedStone) -> PlacedMask | None:
    """Return the pixels of a stone whose outlines are in px, y down; None when it has none."""
    filled = (filled_area(area) for area in stone.areas)
    return united([*(mask for mask in filled if mask is not None), *stone.masks])


def common_px(one: PlacedMask, other: PlacedMask) -> int:
    """Return the number of pixels that two masks share."""
    both = overlap(one, other)
    return 0 if both is None else int(both.sum())


def overlap(one: PlacedMask, other: PlacedMask) -> NDArray[np.bool_] | None:
    """Return the shared pixels within the box that two masks share; None for no such box."""
    top, left = max(one.row, other.row), max(one.col, other.col)
    bottom = min(m.row + m.mask.shape[0] for m in (one, other))
    right = min(m.col + m.mask.shape[1] for m in (one, other))
    if bottom <= top or right <= left:
        return None
    first, second = (
        m.mask[top - m.row : bottom - m.row, left - m.col : right - m.col] for m in (one, other)
    )
    return np.asarray(first & second)


def meeting_boxes(masks: Sequence[PlacedMask], where: str) -> list[tuple[int, int]]:
    """Return the pairs (i, j), i < j, of masks whose boxes overlap."""
    sides = [(m.row, m.col, m.row + m.mask.shape[0], m.col + m.mask.shape[1]) for m in masks]
    top, left, bottom, right = np.array(sides, dtype=np.int64).reshape(-1, 4).T
    pairs: list[tuple[int, int]] = []
    shared_px = 0
    for i in range(len(masks)):
        rest = slice(i + 1, None)
        height = np.minimum(bottom[rest], bottom[i]) - np.maximum(top[rest], top[i])
        width = np.minimum(right[rest], right[i]) - np.maximum(left[rest], left[i])
        meet = (height > 0) & (width > 0)
        pairs += [(i, i + 1 + int(j)) for j in np.flatnonzero(meet)]
        shared_px += int((height * width)[meet].sum())
        if len(pairs) > _MOST_PAIRS or shared_px > _MOST_SHARED_PX:
            raise InputError(
                "E110", "its stones lie over each other more often than can be compared.",
                where=where, cure="Export every stone once.",
            )  # fmt: skip
    return pairs


def without_nested(
    stones: list[OutlinedStone], where: str, skip: tuple[int, ...] = ()
) -> tuple[list[OutlinedStone], list[Notice]]:
    """Leave out the ground, groups of stones, and parts of stones.

    A program that masks whatever it sees finds the ground, heaps, stones, and spots on stones.
    In this order:

    1. a mask in whose holes `INSIDE` of another mask lies is the ground;
    2. of two masks that share `INSIDE` of their union, the smaller one is the same thing again;
    3. a mask of which `INSIDE` is covered by two or more smaller ones is a group of those;
    4. a mask of which `INSIDE` lies in a larger one that is kept is a part of it.
    """
    placed = {i: pixels_of(stone) for i, stone in enumerate(stones) if stone.id not in skip}
    masks = {i: mask for i, mask in placed.items() if mask is not None}
    keys = list(masks)
    meeting = [(keys[i], keys[j]) for i, j in meeting_boxes(list(masks.values()), where)]
    ground = _with_stones_in_holes(masks, meeting)
    masks = {i: mask for i, mask in masks.items() if i not in ground}
    again = _Shares(masks, meeting).same()
    shares = _Shares({i: mask for i, mask in masks.items() if i not in again}, meeting)
    groups = shares.groups()
    rest = {i: m for i, m in masks.items() if i not in again and i not in groups}
    shares = _Shares(rest, meeting)
    parts_of = shares.wholes()
    left = {*ground, *again, *groups, *parts_of}
    name = [stone.id for stone in stones]
    said = [f"{name[i]} (the ground: others lie in its holes)" for i in sorted(ground)]
    said += [f"{name[i]} ({name[whole]} again)" for i, whole in sorted(again.items())]
    for i, parts in sorted(groups.items()):
        said.append(f"{name[i]} (a group of {listed(name[part] for part in parts)})")
    said += [f"{name[i]} (a part of {name[whole]})" for i, whole in sorted(parts_of.items())]
    kept = [_with_pixels(s, placed.get(i)) for i, s in enumerate(stones) if i not in left]
    if not said:
        return kept, []
    text = (
        f"{len(said)} of {len(stones)} masks are no stones of their own: {listed(said, most=MANY)}."
    )
    return kept, [Notice("W119", text, "Skip ids to decide otherwise.")]


def _with_pixels(stone: OutlinedStone, mask: PlacedMask | None) -> OutlinedStone:
    return stone if mask is None else replace(stone, areas=(), masks=(mask,))


def _with_stones_in_holes(
    masks: dict[int, PlacedMask], meeting: Iterable[tuple[int, int]]
) -> set[int]:
    holes = {
        i: PlacedMask(inside, mask.row, mask.col)
        for i, mask in masks.items()
        if (inside := enclosed(mask.mask)).any()
    }
    return {
        i
        for pair in meeting
        for i, j in (pair, pair[::-1])
        if i in holes and common_px(holes[i], masks[j]) >= INSIDE * masks[j].mask.sum()
    }


class _Shares:
    """How much of which mask lies in which."""

    def __init__(self, masks: dict[int, PlacedMask], meeting: Iterable[tuple[int, int]]) -> None:
        self._masks = masks
        self._areas = {i: int(mask.mask.sum()) for i, mask in masks.items()}
        self._common: dict[int, dict[int, int]] = {i: {} for i in masks}
        for i, j in meeting:
            common = common_px(masks[i], masks[j]) if i in masks and j in masks else 0
            if common:
                self._common[i][j] = self._common[j][i] = common

    def _order(self, i: int) -> tuple[int, int]:
        """Larger first; of equal ones the earlier."""
        return -self._areas[i], i

    def same(self) -> dict[int, int]:
        """Return for each mask that repeats a larger one which that is."""
        return self._within(lambda i, j, common: self._areas[i] + self._areas[j] - common)

    def wholes(self) -> dict[int, int]:
        """Return for each mask that lies in a larger one which that is."""
        return self._within(lambda i, _j, _common: self._areas[i])

    def groups(self) -> dict[int, list[int]]:
        """Return for each mask that smaller ones cover which those are."""
        found = {}
        for i, mask in self._masks.items():
            parts = self._parts(i)
            union = united([self._masks[j] for j in parts])
            if union is not None and common_px(mask, union) >= INSIDE * self._areas[i]:
                found[i] = parts
        return found

    def _parts(self, i: int) -> list[int]:
        """Return the smaller masks that lie in one, and in no other that lies in it."""
        inside = [
            j for j, common in self._common[i].items()
            if self._order(i) < self._order(j) and common >= INSIDE * self._areas[j]
        ]  # fmt: skip
        parts: list[int] = []
        for j in sorted(inside, key=self._order):
            if all(self._common[j].get(k, 0) < INSIDE * self._areas[j] for k in parts):
                parts.append(j)
        return sorted(parts) if len(parts) > 1 else []

    def _within(self, of: Callable[[int, int, int], int]) -> dict[int, int]:
        """Return which masks share `INSIDE` of something with a larger one that is kept."""
        kept: list[int] = []
        found: dict[int, int] = {}
        for i in sorted(self._masks, key=self._order):
            common = self._common[i]
            around = [j for j in kept if j in common and common[j] >= INSIDE * of(i, j, common[j])]
            if around:
                found[i] = around[0]
            else:
                kept.append(i)
        return found
