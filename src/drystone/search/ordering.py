"""The order in which the stones of a wall are laid, chosen by rehearsals.

It changes nothing of the finished wall, but where errors add up: a stone that closes a course
takes those of all others, a course that is laid from its middle has none.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from drystone.kernels.profiles import extremes
from drystone.model.wall import Group
from drystone.search.goal import LAST_RUNS, FoundWall, falls_of, merit_of, possible_filling
from drystone.search.yard import Yard

COLUMNS = 8
"""Which of two stones is above the other is seen at so many places of the width they share."""

MOVED = 3
"""So many of the stones with which falls begin most often are moved in the order."""


def reordered(found: FoundWall, yard: Yard, often: Sequence[int]) -> FoundWall | None:
    """Return a wall of outlines in the order of laying in which it falls least in rehearsals.

    `often` are the stones with which falls begin, the most frequent first.  None where no other
    order is better.  What lies under a stone is always laid before it, and each step stands.
    """
    figures, groups = found.figures, found.build.wall.groups
    if figures is None or not groups:
        return None
    heights, best = found.build.course_heights_px(), None
    for order in dict.fromkeys(_orders(groups, 1.0 / yard.workshop.site.scale, often)):
        again = [groups[i] for i in order]
        falls = falls_of(again, yard, LAST_RUNS, figures.fallen)
        if falls is not None and falls.share < figures.fallen:
            build, left_out, solves = yard.replayed(yard.planner().build, again, heights)
            if not left_out:
                figures = replace(figures, fallen=falls.share)
                merit = merit_of(figures, possible_filling(yard.workshop), yard.settings.goal)
                best = FoundWall(build, figures, merit, found.solves + solves, falls=falls)
    return best


def _orders(
    groups: Sequence[Group], sliver_px: float, often: Sequence[int]
) -> Iterator[tuple[int, ...]]:
    """List orders of laying: every course from its middle; some stones sooner, or later."""
    count = len(groups)
    under = _under(groups, sliver_px)
    level = [0] * count
    for _ in range(count):
        level = [max((level[j] + 1 for j in under[i]), default=0) for i in range(count)]
        if max(level) >= count:
            return  # they are hooked into each other: no other order is known
    x_px = [group.placement.exact.x_px for group in groups]
    middle = 0.5 * (min(x_px) + max(x_px))
    yield tuple(sorted(range(count), key=lambda i: (level[i], abs(x_px[i] - middle))))
    for stone in often[:MOVED]:
        at = next(i for i, group in enumerate(groups) if group.placement.stone_id == stone)
        first = max((j + 1 for j in under[at]), default=0)
        last = min((j for j in range(count) if at in under[j]), default=count) - 1
        others = [i for i in range(count) if i != at]
        for place in {first, (first + last) // 2, last} - {at}:
            yield (*others[:place], at, *others[place:])


def _under(groups: Sequence[Group], sliver_px: float) -> list[set[int]]:
    """Return of each stone which others lie under it, however far, where it is wider."""
    corners = [group.placement.exact.corners for group in groups]
    boxes = [(*one.min(axis=0), *one.max(axis=0)) for one in corners]
    under: list[set[int]] = [set() for _ in groups]
    for i, one in enumerate(corners):
        for j in range(i):
            low, high = max(boxes[i][0], boxes[j][0]), min(boxes[i][2], boxes[j][2])
            if high - low <= sliver_px:
                continue
            cell = (high - low) / COLUMNS
            heights = [np.add(*extremes(c, low, cell, COLUMNS)).sum() for c in (one, corners[j])]
            below, above = (i, j) if heights[0] < heights[1] else (j, i)
            under[above].add(below)
    return under
