"""Slow, obvious versions of what the planner computes."""

from collections.abc import Iterable
from itertools import product


def unfillable(lengths: list[tuple[int, ...]], limit: int) -> list[int]:
    """What is left of every length when all combinations of stones have been tried."""
    sums = {sum(choice) for choice in product(*[(0, *choices) for choices in lengths])}
    return [min(length - total for total in sums if total <= length) for length in range(limit + 1)]


def free_area_under(occupied: list[list[bool]], cells: Iterable[tuple[int, int]]) -> int:
    """Pixels below some pixels (row, column) down to the next occupied one or the ground."""
    taken = set(cells)
    count = 0
    for row, col in taken:
        below = row + 1
        while (below, col) not in taken and below < len(occupied) and not occupied[below][col]:
            count += 1
            below += 1
    return count
