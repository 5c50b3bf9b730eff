"""How far polygons must go aside to clear one that overlaps them (DESIGN 4.10)."""

from __future__ import annotations

from drystone.kernels.polygons import Points, Polygons

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.gaps import Heap, MovingStone, heap_of, over, select, stone_of
    from drystone.kernels.lists import kept_doubles
    from drystone.kernels.profiles import sweep_all

# Two polygons lie beside each other when they share so much of the height of the lower one.
BESIDE = cython.declare(cython.double, 0.3)

# Along so many lines it is looked how far two polygons overlap.
LINES = cython.declare(cython.Py_ssize_t, 32)


def asides(corners: Points, around: Polygons, gap: float, sign: float) -> list[tuple[int, float]]:
    """List which polygons beside one must go how far to a side, 1 or -1, to keep a gap to it.

    Those are left out that do not overlap it, or need less upwards: then one lies on the other.
    """
    one: MovingStone = stone_of(corners, corners)
    heap: Heap = heap_of(around, 0.0)
    room: list = []
    work: Work = work_for(room, len(corners) + len(around.corners))
    found = []
    for i in range(heap.size):
        select(heap, i)
        way: cython.double = aside(one, heap, sign, work)
        if way >= 0.0:
            found.append((i, way + gap))
    return found


@cython.cclass
class Work:
    """Corners of a polygon, and the ends of two polygons along all lines."""


def work_for(room, count):
    """Return room for polygons of so many corners, as long as a list is there."""
    work: Work = Work()
    work.corners = kept_doubles(room, 2 * count)
    work.bottoms, work.tops = kept_doubles(room, LINES), kept_doubles(room, LINES)
    work.low, work.high = kept_doubles(room, LINES), kept_doubles(room, LINES)
    return work


def aside(one, other, sign, work):
    """Return how far another polygon must go aside; -1 for nothing."""
    if other.left >= one.right or one.left >= other.right:
        return -1.0
    if sign * (other.left + other.right - one.left - one.right) <= 0.0:
        return -1.0
    low: cython.double = max(one.low, other.low)
    high: cython.double = min(one.high, other.high)
    if high - low < BESIDE * min(one.high - one.low, other.high - other.low):
        return -1.0
    if not over(one, other):
        return -1.0
    left: cython.double = max(one.left, other.left)
    right: cython.double = min(one.right, other.right)
    above: cython.double = 1.0 if other.low + other.high - one.low - one.high >= 0.0 else -1.0
    across: cython.double = depth(one, other, 1, low, high, sign, work)
    return across if across < depth(one, other, 0, left, right, above, work) else -1.0


def depth(one, other, axis, start, end, sign, work):
    """Return how far along the other axis, 0 or 1, a polygon must go to clear one on some way."""
    deepest: cython.double = 0.0
    cell: cython.double = (end - start) / LINES
    ends_of(one, axis, start, cell, work, work.bottoms, work.tops)
    ends_of(other, axis, start, cell, work, work.low, work.high)
    for j in range(LINES):
        if sign > 0.0:
            deepest = max(deepest, work.tops[j] - work.low[j])
        else:
            deepest = max(deepest, work.high[j] - work.bottoms[j])
    return deepest


def ends_of(body, axis, start, cell, work, bottoms, tops):
    """Find the ends of a polygon along all lines across an axis."""
    for i in range(body.count):
        k = 2 * (body.first + i)
        work.corners[2 * i] = body.corners[k + axis]
        work.corners[2 * i + 1] = body.corners[k + 1 - axis]
    sweep_all(work.corners, body.count, start, cell, bottoms, tops, LINES)
    return 0
