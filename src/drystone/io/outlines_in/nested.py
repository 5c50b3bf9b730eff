"""Which of many masks that lie in each other are stones."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from drystone.errors import Notice
from drystone.io.file_errors import MANY, listed, too_large
from drystone.io.outlines_in.fill import pixels_of, united
from drystone.io.outlines_in.model import OutlinedStone
from drystone.io.patches import PlacedMask, enclosed

INSIDE = 0.8
"""Share of a mask that lies in another one for it to count as its part."""

_MOST_PAIRS = 200_000
_MOST_SHARED_PX = 300_000_000


def meeting_boxes(masks: Sequence[PlacedMask]) -> list[tuple[int, int]]:
    """Return the pairs (i, j), i < j, of masks whose boxes overlap.

    More of them, or larger ones, than can be compared are refused (E110).
    """
    sides = np.array([mask.sides for mask in masks], dtype=np.int64).reshape(-1, 4)
    pairs: list[tuple[int, int]] = []
    shared_px = 0
    for i, own in enumerate(sides):
        rest = sides[i + 1 :]
        shared = np.minimum(rest[:, 2:], own[2:]) - np.maximum(rest[:, :2], own[:2])
        meet = (shared > 0).all(axis=1)
        pairs += [(i, i + 1 + int(j)) for j in np.flatnonzero(meet)]
        shared_px += int(shared[meet].prod(axis=1).sum())
        if len(pairs) > _MOST_PAIRS or shared_px > _MOST_SHARED_PX:
            what = "its stones lie over each other more often than can be compared."
            raise too_large(what, "Export every stone once.")
    return pairs


def without_nested(
    stones: list[OutlinedStone], skip: tuple[int, ...] = ()
) -> tuple[list[OutlinedStone], list[Notice]]:
    """Leave out the ground, groups of stones, and parts of stones.

    A program that masks whatever it sees finds the ground, heaps, stones, and spots on stones.
    In this order:

    1. a mask in whose holes `INSIDE` of another mask lies is the ground;
    2. of two masks that share `INSIDE` of their union, the smaller one is the same thing again;
    3. a mask of which `INSIDE` is covered by two or more smaller ones is a group of those;
    4. a mask of which `INSIDE` lies in a larger one that is kept is a part of it.

    Ids in `skip` do not count, and their stones are kept as they are; naming parts there makes
    their group a stone.
    """
    placed = {i: pixels_of(stone) for i, stone in enumerate(stones) if stone.id not in skip}
    masks = {i: mask for i, mask in placed.items() if mask is not None}
    keys = list(masks)
    meeting = [(keys[i], keys[j]) for i, j in meeting_boxes(list(masks.values()))]
    ground = _with_stones_in_holes(masks, meeting)
    shares = _Shares({i: mask for i, mask in masks.items() if i not in ground}, meeting)
    again = shares.same()
    shares.leave(again)
    groups = shares.groups()
    shares.leave(groups)
    parts_of = shares.wholes()
    left = {*ground, *again, *groups, *parts_of}
    name = [stone.id for stone in stones]
    said = [f"{name[i]} (the ground: others lie in its holes)" for i in sorted(ground)]
    said += [f"{name[i]} ({name[whole]} again)" for i, whole in sorted(again.items())]
    for i, parts in sorted(groups.items()):
        said.append(f"{name[i]} (a group of {listed(name[part] for part in parts)})")
    said += [f"{name[i]} (a part of {name[whole]})" for i, whole in sorted(parts_of.items())]
    kept = [
        stone if (mask := placed.get(i)) is None else replace(stone, areas=(), masks=(mask,))
        for i, stone in enumerate(stones)
        if i not in left
    ]
    if not said:
        return kept, []
    found = f"{len(said)} of {len(stones)} masks are no stones of their own"
    text = f"{found}: {listed(said, most=MANY)}."
    return kept, [Notice("W119", text, "Skip ids to decide otherwise.")]


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
        if i in holes and holes[i].common_px(masks[j]) >= INSIDE * masks[j].mask.sum()
    }


class _Shares:
    """How much of which mask lies in which."""

    def __init__(self, masks: dict[int, PlacedMask], meeting: Iterable[tuple[int, int]]) -> None:
        self._masks = masks
        self._areas = {i: int(mask.mask.sum()) for i, mask in masks.items()}
        self._common: dict[int, dict[int, int]] = {i: {} for i in masks}
        for i, j in meeting:
            common = masks[i].common_px(masks[j]) if i in masks and j in masks else 0
            if common:
                self._common[i][j] = self._common[j][i] = common

    def leave(self, out: Iterable[int]) -> None:
        """Forget masks that are no stones."""
        for i in out:
            del self._masks[i]
            for j in self._common.pop(i):
                del self._common[j][i]

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
            if union is not None and mask.common_px(union) >= INSIDE * self._areas[i]:
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
