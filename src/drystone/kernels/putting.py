"""Putting a block down between others (DESIGN 4.10).

It is lifted until it overlaps nothing below.  There it is pressed in between its neighbours: moved
aside where there is room, else these are pushed apart along their beds.  Then it goes down as
friction lets it: it rolls about what carries it, and slides only where it does not come to rest so.
What leans on a face, or hangs, then goes down where a bed is near that bears it.
"""

from __future__ import annotations

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.gaps import Heap, MovingStone, measure, over, select
    from drystone.kernels.lists import kept_doubles, move_doubles
    from drystone.kernels.profiles import sweep_all
    from drystone.kernels.settling import State, Way, let_go

RESTS = cython.declare(cython.int, 0)
FALLS = cython.declare(cython.int, 1)
OVERLAPS = cython.declare(cython.int, 2)

# A block bears on what it touches where the normal of the contact goes up by at least so much.
UPWARD = cython.declare(cython.double, 0.3)

# What leans on a face goes down by no more than so much of how far it may go altogether.
DOWN = cython.declare(cython.double, 0.2)

# Two polygons lie beside each other when they share so much of the height of the lower one.
BESIDE = cython.declare(cython.double, 0.3)

# Along so many lines it is looked how far two polygons overlap.
LINES = cython.declare(cython.Py_ssize_t, 32)


def put_down(press, x, start_y, lifts, last):
    """Let a block come to rest, lifted by the least of some ways with which it does.

    The `last` lifts are for what rests with none of the others; it may turn further then.  It is
    moved, and others are pushed, by no more than `most`, and what overlapped it keeps a gap.
    Returned is whether it rests, falls, or has no room: it overlaps with all lifts.  Only where it
    rests, the others lie as they were pushed.
    """
    way: Way = press.block
    pressed: dict = {}
    now: dict = {}
    room: cython.bint = False
    steps = 1
    for way.sticks, some in ((True, lifts), (False, lifts), (True, last)):
        if not way.sticks and not steps:
            continue  # it overlaps wherever it is let go
        if some is last:  # falls are counted from the plan, and it may have been put down askew
            way.most_turn, way.most_shift = 2.0 * way.most_turn, 2.0 * way.most_shift
        steps, least = 0, 0.0
        for lift in some:
            if lift < least:
                continue
            y: cython.double = start_y + lift
            if lift not in pressed:
                lie(press, now, {})
                pressed[lift] = squeezed_in(press, x, y)
            else:
                lie(press, now, pressed[lift][1])
            shift: cython.double = pressed[lift][0]
            now = pressed[lift][1]
            status: cython.int = let_go(way, press.heap, x + shift, y, 0.0)
            if status == RESTS:
                press.pushed = now
                if leans(way):
                    go_down(way, press.heap)
                return RESTS
            room = room or status != OVERLAPS
            steps += way.made
            if not way.made:
                # A lift takes off no more than itself; that it gives other room aside is rare.
                least = lift - way.here.least - way.overlap
    lie(press, now, {})
    return FALLS if room else OVERLAPS


def leans(way):
    """Say whether what has come to rest hangs, or its weight acts beside all that it bears on."""
    here: State = way.here
    left: cython.bint = False
    right: cython.bint = False
    for k in range(0, 7 * here.found, 7):
        if here.gaps[k + 5] <= way.tolerance and here.gaps[k + 2] >= UPWARD:
            left = left or here.gaps[k + 3] <= here.x
            right = right or here.gaps[k + 3] >= here.x
    return not (left and right)


def go_down(way, heap):
    """Let what leans on a face go down as if upright faces had no friction.

    It stays where that is far, or where it still leans then.  What leans over holds nothing.
    """
    x: cython.double = way.here.x
    y: cython.double = way.here.y
    turn: cython.double = way.here.turn
    steep, most_turn, most_shift = way.steep, way.most_turn, way.most_shift
    way.steep, way.most_turn, way.most_shift = UPWARD, DOWN * most_turn, DOWN * most_shift
    near: cython.bint = let_go(way, heap, x, y, turn) == RESTS and y - way.here.y <= way.most_shift
    way.steep, way.most_turn, way.most_shift = steep, most_turn, most_shift
    if not near or leans(way):
        let_go(way, heap, x, y, turn)
    return 0


@cython.cclass
class Press:
    """A block, what lies around it, and room for corners and for the ends of two polygons."""


def press_of(way, heap, most, gap):
    """Return a block, and what lies around it, which is moved."""
    press: Press = Press()
    press.room, press.block, press.one, press.heap = [], way, MovingStone(), heap
    press.most, press.gap = most, gap
    size: cython.Py_ssize_t = 2 * heap.starts[heap.size]
    press.corners = kept_doubles(press.room, size)
    press.boxes = kept_doubles(press.room, 4 * heap.size)
    move_doubles(press.corners, 0, heap.corners, 0, size)
    move_doubles(press.boxes, 0, heap.boxes, 0, 4 * heap.size)
    size += 2 * way.count
    press.one.corners, press.turned = kept_doubles(press.room, size), kept_doubles(press.room, size)
    press.bottoms, press.tops = kept_doubles(press.room, LINES), kept_doubles(press.room, LINES)
    press.low, press.high = kept_doubles(press.room, LINES), kept_doubles(press.room, LINES)
    press.one.first = 0
    return press


def lie(press, before, now):
    """Let all others lie so far from where they lay."""
    for i in before:
        if i not in now:
            move(press, i, 0.0)
    for i, shift in now.items():
        move(press, i, shift)


def move(press, i, shift):
    """Let one of the others lie so far from where it lay."""
    heap: Heap = press.heap
    for k in range(2 * heap.starts[i], 2 * heap.starts[i + 1], 2):
        heap.corners[k] = press.corners[k] + shift
    heap.boxes[4 * i] = press.boxes[4 * i] + shift
    heap.boxes[4 * i + 2] = press.boxes[4 * i + 2] + shift


def squeezed_in(press, x, y):
    """Move a block aside to where it has room between its neighbours, or push these apart.

    Returned are how far it goes aside, and who was pushed how far.
    """
    stand(press, x, y, 0.0)
    press.bottom, press.top = press.one.low, press.one.high
    left: cython.double = deepest(press, -1.0)
    right: cython.double = deepest(press, 1.0)
    shift: cython.double = 0.5 * (left - right)
    if (left > 0.0) != (right > 0.0):
        # All the way where there is room, else half of what is missing.
        sign: cython.double = 1.0 if shift > 0.0 else -1.0
        stand(press, x, y, 2.0 * shift)
        shift = 2.0 * shift - 0.5 * sign * deepest(press, sign)
    pushed: dict = {}
    if not left + right > 0.0 or abs(shift) > press.most:
        return 0.0, pushed
    for sign in (-1.0, 1.0):
        todo = [-1]
        while todo:
            k: cython.Py_ssize_t = todo.pop()
            if k < 0:
                stand(press, x, y, shift)
            else:
                take(press, k)
            for i, over in neighbours(press, sign):
                if over < press.most:
                    pushed[i] = pushed.get(i, 0.0) + sign * over
                    move(press, i, pushed[i])
                    todo.append(i)
    return shift, pushed


def stand(press, x, y, shift):
    """Let the block stand at a place, moved aside."""
    one: MovingStone = press.one
    block: Way = press.block
    one.count = block.count
    for k in range(block.count):
        one.corners[2 * k] = block.corners[2 * k] + x + shift
        one.corners[2 * k + 1] = block.corners[2 * k + 1] + y
    measure(one)


def take(press, i):
    """Look at one of the others instead of the block."""
    one: MovingStone = press.one
    select(press.heap, i)
    one.count = press.heap.count
    for k in range(2 * one.count):
        one.corners[k] = press.heap.corners[2 * press.heap.first + k]
    measure(one)


def neighbours(press, sign):
    """List who overlaps it on one side, and by how much; the gap is part of it."""
    found = []
    for i in range(press.heap.size):
        way: cython.double = overlap(press, i, sign)
        if way > 0.0:
            found.append((i, way))
    return found


def deepest(press, sign):
    """Return by how much it overlaps others on one side at most."""
    most: cython.double = 0.0
    for i in range(press.heap.size):
        most = max(most, overlap(press, i, sign))
    return most


def overlap(press, i, sign):
    """Return by how much it overlaps another on one side, with a gap; 0 where it does not."""
    heap: Heap = press.heap
    if not (heap.boxes[4 * i + 1] < press.top and heap.boxes[4 * i + 3] > press.bottom):
        return 0.0
    select(heap, i)
    way: cython.double = aside(press, sign)
    return way + press.gap if way >= 0.0 else 0.0


def aside(press, sign):
    """Return how far the one looked at must go aside to a side, 1 or -1; -1 for nothing.

    That is nothing where it does not overlap, or needs less upwards: then one lies on the other.
    """
    one: MovingStone = press.one
    other: Heap = press.heap
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
    across: cython.double = depth(press, 1, low, high, sign)
    return across if across < depth(press, 0, left, right, above) else -1.0


def depth(press, axis, start, end, sign):
    """Return how far along the other axis, 0 or 1, a polygon must go to clear one on some way."""
    deepest: cython.double = 0.0
    cell: cython.double = (end - start) / LINES
    ends_of(press, press.one, axis, start, cell, press.bottoms, press.tops)
    ends_of(press, press.heap, axis, start, cell, press.low, press.high)
    for j in range(LINES):
        if sign > 0.0:
            deepest = max(deepest, press.tops[j] - press.low[j])
        else:
            deepest = max(deepest, press.high[j] - press.bottoms[j])
    return deepest


def ends_of(press, body, axis, start, cell, bottoms, tops):
    """Find the ends of a polygon along all lines across an axis."""
    for i in range(body.count):
        k = 2 * (body.first + i)
        press.turned[2 * i] = body.corners[k + axis]
        press.turned[2 * i + 1] = body.corners[k + 1 - axis]
    sweep_all(press.turned, body.count, start, cell, bottoms, tops, LINES)
    return 0
