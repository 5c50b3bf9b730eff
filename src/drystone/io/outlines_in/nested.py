"""The one rule for what is not a stone: frames, the ground, repeats, groups and parts."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from drystone.errors import Notice
from drystone.io.files import MANY, listed, short, too_large
from drystone.io.labels import components
from drystone.io.outlines_in.model import covered, room_around
from drystone.io.patches import PlacedMask, enclosed

INSIDE = 0.8
"""Share of a mask that lies in another one for it to count as its part."""

_BESIDE = 0.25
"""How large what lies beside a frame may be, compared with what lies in it."""
_TOUCHING = 0.1
"""Share of a mask from which it lies over another one."""
_IN_EACH = 4
"""How many lie, on average, in each of several frames."""
_WHOLE_PICTURE = 0.9
"""Share of its picture that a frame has which a program saw."""

_MOST_IN_PIECES = 16
"""Pieces of a group that are looked at one by one."""

_AT_ONCE = 256
_MOST_PAIRS = 100_000
_MOST_SHARED_PX = 300_000_000


def meeting(
    shapes: NDArray[Any], predicate: str | None = None
) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Yield which shapes meet which, by their positions, those of a few shapes at a time.

    They may be too many to be held at once.  Without a predicate boxes count.
    """
    tree = shapely.STRtree(shapes)
    for begin in range(0, len(shapes), _AT_ONCE):
        i, j = tree.query(shapes[begin : begin + _AT_ONCE], predicate=predicate)
        yield i + begin, j


def meeting_boxes(masks: Sequence[PlacedMask]) -> list[tuple[int, int]]:
    """Return the pairs (i, j), i < j, of masks whose boxes overlap.

    More of them, or larger ones, than can be compared are refused (E110).
    """
    sides = np.array([mask.sides for mask in masks], dtype=np.int64).reshape(-1, 4)
    pairs: list[tuple[int, int]] = []
    shared_px = 0
    for one, other in meeting(shapely.box(*sides.T)):
        i, j = one[one < other], other[one < other]
        shared = np.minimum(sides[i, 2:], sides[j, 2:]) - np.maximum(sides[i, :2], sides[j, :2])
        meet = (shared > 0).all(axis=1)
        pairs += zip(i[meet].tolist(), j[meet].tolist(), strict=True)
        shared_px += int(shared[meet].prod(axis=1).sum())
        if len(pairs) > _MOST_PAIRS or shared_px > _MOST_SHARED_PX:
            what = "its stones lie over each other more often than can be compared."
            raise too_large(what, "Export every stone once.")
    return sorted(pairs)


def not_stones(
    masks: Mapping[int, PlacedMask],
    size_px: tuple[int, int],
    keep: Collection[int],
    *,
    by_program: bool,
) -> dict[int, str]:
    """Say of each mask that is not a stone of its own what it is instead.

    They are those of one picture, of that width and height, by the number of their stone; a program
    masks whatever it sees: heaps, stones, and spots on stones.  This is the one rule of all readers
    of outlines and masks, in this order:

    1. a mask in whose holes `INSIDE` of others lies is the ground;
    2. of two masks that share `INSIDE` of their union, the smaller one is the same thing again;
    3. a mask in which nearly all others lie is a frame;
    4. a mask of which `INSIDE` is covered by two or more smaller ones and the ground, or which has
       some of them in each of its pieces, is a group of those;
    5. a mask of which `INSIDE` lies in a larger one that is kept is a part of it.
    """
    shares = _Shares(masks, keep)
    areas = shares.areas
    # One stone drawn by hand may show in another; a program finds the ground like that.
    ground = shares.ground(1 if by_program else max(1, min(2, len(masks) - 1)))
    shares.leave(dict.fromkeys(ground, "the ground: others lie in its holes"))
    again = shares.within(lambda i, j, common: areas[i] + areas[j] - common)
    shares.leave({i: f"{whole} again" for i, whole in again.items()})
    framed = shares.frames(_WHOLE_PICTURE * math.prod(size_px) if by_program else 0.0)
    shares.leave({i: f"a frame around {listed(held, most=3)}" for i, held in framed.items()})
    groups = shares.groups([masks[i] for i in ground])
    shares.leave({i: f"a group of {listed(parts)}" for i, parts in groups.items()})
    wholes = shares.within(lambda i, _j, _common: areas[i])
    return shares.left | {i: f"a part of {whole}" for i, whole in wholes.items()}


def said_of(left: Mapping[int, str], count: int, names: Mapping[int, str]) -> Notice:
    """List what is not a stone, and how to keep it."""
    shown = (f"{f'{i} {short(names[i])}'.rstrip()} ({left[i]})" for i in sorted(left))
    why = listed(shown, most=MANY)
    text = f"{len(left)} of {count} outlines or masks are not stones of their own, left out: {why}."
    return Notice("W119", text, "Use --keep ID (keep in Python) for each that is one.")


def of_one_picture(masks: Sequence[PlacedMask]) -> bool:
    """Tell masks of one picture from stones that each had a picture of its own.

    Those lie all over each other, where masks of one picture lie beside or in each other.
    """
    depth = room_around(masks, np.uint16)
    for mask in masks:
        here, there = depth.shared(mask)
        here += there
    if 2 * int(depth.mask.max(initial=0)) > len(masks):
        return False
    nested = partial = 0
    for i, j in meeting_boxes(masks):
        smaller = min(int(masks[i].mask.sum()), int(masks[j].mask.sum()))
        share = masks[i].common_px(masks[j]) / max(1, smaller)
        nested += share >= INSIDE
        partial += _TOUCHING <= share < INSIDE
    return partial <= nested


def frames(
    areas: Mapping[int, float],
    inside: Mapping[int, AbstractSet[int]],
    plain: AbstractSet[int] = frozenset(),
) -> dict[int, list[int]]:
    """Return the shapes that are drawn around the stones, and what lies in each.

    A frame holds two others or more, and beside it there is little, compared with them; one that
    is a `plain` rectangle may hold a single one.  Several frames share all others.
    """
    left, found, around = set(areas), {}, True
    holders = sorted((i for i in areas if inside[i]), key=lambda i: -areas[i])
    while around:
        around, total = False, sum(areas[i] for i in left)
        for i in (i for i in holders if i in left):
            held = inside[i] & left
            within = sum(areas[j] for j in held)
            alone = i in plain and len(held) == len(left) - 1
            few = len(held) < (1 if alone else 2)
            if not few and total - areas[i] - within <= _BESIDE * within:
                found[i], around = sorted(held), True
                left.remove(i)
                break
    holding = {i: inside[i] & left for i in left}
    outer = left.difference(*holding.values())
    several = len(outer) > 1 and all(len(holding[i]) > 1 for i in outer)
    if several and len(left) - len(outer) >= _IN_EACH * len(outer):
        found |= {i: sorted(holding[i]) for i in outer}
    return found


class _Shares:
    """Masks that may be stones, how much of which lies in which, and what is none."""

    def __init__(self, masks: Mapping[int, PlacedMask], keep: Collection[int]) -> None:
        self._masks, self._keep = dict(masks), frozenset(keep)
        self.areas = {i: int(mask.mask.sum()) for i, mask in masks.items()}
        self._holes = {
            i: PlacedMask(inside, mask.row, mask.col)
            for i, mask in masks.items()
            if i not in self._keep and (inside := enclosed(mask.mask)).any()
        }
        # Also 0, of those that may lie in holes.
        self._common: dict[int, dict[int, int]] = {i: {} for i in self._masks}
        keys = list(self._masks)
        for one, other in meeting_boxes(list(masks.values())):
            i, j = keys[one], keys[other]
            self._common[i][j] = self._common[j][i] = masks[i].common_px(masks[j])
        self.left: dict[int, str] = {}

    def leave(self, out: Mapping[int, str]) -> None:
        self.left |= out
        for i in out:
            del self._masks[i]
            for j in self._common.pop(i):
                del self._common[j][i]

    def _order(self, i: int) -> tuple[int, int]:
        """Larger first; of equal ones the earlier."""
        return -self.areas[i], i

    def ground(self, least: int) -> list[int]:
        """Return the masks in whose holes so many others lie."""
        found = []
        for i, hole in self._holes.items():
            room, held = int(hole.mask.sum()), 0
            for j in self._common[i]:
                wanted = INSIDE * self.areas[j]
                # Few holes have room for another.
                held += room >= wanted and hole.common_px(self._masks[j]) >= wanted
            if held >= least:
                found.append(i)
        return found

    def within(self, of: Callable[[int, int, int], int]) -> dict[int, int]:
        """Return which masks share `INSIDE` of something with a larger one that is kept."""
        kept: set[int] = set()
        found: dict[int, int] = {}
        for i in sorted(self._masks, key=self._order):
            common = self._common[i]
            around = [j for j in common if j in kept and common[j] >= INSIDE * of(i, j, common[j])]
            if around and i not in self._keep:
                found[i] = min(around, key=self._order)
            else:
                kept.add(i)
        return found

    def _inside(self, i: int, holes: PlacedMask | None = None) -> list[int]:
        """Return the smaller masks that lie in one, or in it and its holes."""
        found = []
        for j, common in self._common[i].items():
            if common and self._order(i) < self._order(j):
                in_holes = holes.common_px(self._masks[j]) if holes else 0
                if common + in_holes >= INSIDE * self.areas[j]:
                    found.append(j)
        return found

    def frames(self, least: float) -> dict[int, list[int]]:
        """Return for each mask of so many px that is drawn around the others which those are."""
        large = (i for i in self._masks.keys() - self._keep if self.areas[i] >= least)
        inside = {i: set[int]() for i in self._masks}
        inside |= {i: set(self._inside(i, self._holes.get(i))) for i in large}
        plain = {i for i, mask in self._masks.items() if mask.mask.all()}
        return frames({i: self.areas[i] for i in self._masks}, inside, plain)

    def groups(self, ground: Sequence[PlacedMask]) -> dict[int, list[int]]:
        """Return for each mask that smaller ones cover, but for the ground, which those are."""
        found = {}
        for i in self._masks.keys() - self._keep:
            mask, parts = self._masks[i], list[int]()
            for j in sorted(self._inside(i), key=self._order):
                # In no other that lies in it.
                if all(self._common[j].get(k, 0) < INSIDE * self.areas[j] for k in parts):
                    parts.append(j)
            if len(parts) < 2:
                continue
            others = covered(mask, [*ground, *(self._masks[j] for j in parts)])
            if mask.common_px(others) >= INSIDE * self.areas[i] or self._in_each_piece(i, parts):
                found[i] = sorted(parts)
        return found

    def _in_each_piece(self, i: int, parts: Sequence[int]) -> bool:
        """Tell a mask in several pieces, which no stone is, with smaller masks in each of them."""
        mask = self._masks[i]
        labels, count = components(mask.mask)
        if not 1 < count <= _MOST_IN_PIECES:
            return False
        pieces = [PlacedMask(labels == n, mask.row, mask.col) for n in range(1, count + 1)]
        return all(any(one.common_px(self._masks[j]) for j in parts) for one in pieces)
