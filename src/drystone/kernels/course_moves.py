"""Small changes of an arrangement of stones in courses."""

from __future__ import annotations

import numpy as np

from drystone.kernels.course_types import Arrangement

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from drystone.kernels.lists import ints, kept_ints, move_ints

# A change that could not be made.
NOTHING = cython.declare(cython.int, -1)

# Of 64 changes, so many are of this kind or one before it; what is left joins two courses.
SWAP = cython.declare(cython.int, 20)
MOVE = cython.declare(cython.int, 36)
TURN = cython.declare(cython.int, 48)
SWAP_TURN = cython.declare(cython.int, 54)
GAP = cython.declare(cython.int, 58)
REVERSE = cython.declare(cython.int, 61)
EXCHANGE = cython.declare(cython.int, 62)
SPLIT = cython.declare(cython.int, 63)

WORD = cython.declare(cython.ulonglong, 0xFFFFFFFFFFFFFFFF)
GOLDEN = cython.declare(cython.ulonglong, 0x9E3779B97F4A7C15)
FIRST = cython.declare(cython.ulonglong, 0xBF58476D1CE4E5B9)
SECOND = cython.declare(cython.ulonglong, 0x94D049BB133111EB)


@cython.cclass
class Dice:
    """Random whole numbers, the same everywhere: splitmix64."""

    def __init__(self, seed: int) -> None:
        self.state = seed % 2**64

    def below(self, count: int) -> int:
        """Return a number from 0 to below `count`, which is at most 2^32."""
        return drawn(self, count)


@cython.cclass
class Draft:
    """An arrangement that is being changed; its fields are those of `Arrangement`."""


def changed(plan: Arrangement, dice: Dice, courses: int) -> tuple[Arrangement, int]:
    """Change an arrangement once, at random; it gets no more than so many courses.

    Returns it, and the lowest course in which something changed, -1 when nothing did.
    """
    draft: Draft = Draft()
    start(draft, plan, courses)
    lowest: cython.int = change(draft, dice, courses)
    return Arrangement(*parts_of(draft)), lowest


def start(draft, plan, most):
    """Start from an arrangement, with room for more courses."""
    draft.room = []
    draft.stones, draft.courses = len(plan.order), len(plan.sizes)
    draft.order = kept_ints(draft.room, draft.stones)
    draft.turns = kept_ints(draft.room, draft.stones)
    draft.spare = kept_ints(draft.room, draft.stones)
    draft.sizes = kept_ints(draft.room, most)
    draft.gaps = kept_ints(draft.room, most)
    move_ints(draft.order, 0, ints(plan.order), 0, draft.stones)
    move_ints(draft.turns, 0, ints(plan.turns), 0, draft.stones)
    move_ints(draft.sizes, 0, ints(plan.sizes), 0, draft.courses)
    move_ints(draft.gaps, 0, ints(plan.gaps), 0, draft.courses)
    return 0


def parts_of(draft):
    """Return the fields of an arrangement."""
    return (
        np.array([draft.order[i] for i in range(draft.stones)], np.int32),
        np.array([draft.turns[i] for i in range(draft.stones)], np.int32),
        np.array([draft.sizes[i] for i in range(draft.courses)], np.int32),
        np.array([draft.gaps[i] for i in range(draft.courses)], np.int32),
    )


def copy(source, to):
    """Make one draft like another."""
    move_ints(to.order, 0, source.order, 0, source.stones)
    move_ints(to.turns, 0, source.turns, 0, source.stones)
    move_ints(to.sizes, 0, source.sizes, 0, source.courses)
    move_ints(to.gaps, 0, source.gaps, 0, source.courses)
    to.courses = source.courses


def drawn(dice, count):
    """Return a random number from 0 to below a count."""
    dice.state = (dice.state + GOLDEN) & WORD
    mixed = dice.state
    mixed = ((mixed ^ (mixed >> 30)) * FIRST) & WORD
    mixed = ((mixed ^ (mixed >> 27)) * SECOND) & WORD
    mixed ^= mixed >> 31
    return ((mixed >> 32) * count) >> 32


def start_of(draft, course):
    """Return the place of the first stone of a course, or of what is left out."""
    place: cython.int = 0
    for i in range(course):
        place += draft.sizes[i]
    return place


def course_of(draft, place):
    """Return the course of a place; the number of courses for what is left out."""
    course: cython.int = 0
    while course < draft.courses and place >= draft.sizes[course]:
        place -= draft.sizes[course]
        course += 1
    return course


def left_of(gap: cython.int) -> cython.int:
    """Return how many stones of a course are laid from the left end."""
    return gap if gap >= 0 else -1 - gap


def move_gap(draft, course, by):
    """Let so many more stones of a course be laid from the left end, as many as there are."""
    gap = draft.gaps[course]
    from_left = min(left_of(gap) + by, draft.sizes[course])
    draft.gaps[course] = from_left if gap >= 0 else -1 - from_left


def change(draft, dice, most):
    """Change a draft at random; return the lowest course in which something changed, or -1."""
    kind = drawn(dice, 64)
    if kind < SWAP:
        return swap(draft, dice, False)
    if kind < MOVE:
        return move(draft, dice)
    if kind < TURN:
        return turn(draft, dice)
    if kind < SWAP_TURN:
        return swap(draft, dice, True)
    if kind < GAP:
        return shift_gap(draft, dice)
    if kind < REVERSE:
        return reverse(draft, dice)
    if kind < EXCHANGE:
        return exchange(draft, dice)
    return split(draft, dice, most) if kind < SPLIT else join(draft, dice)


def turn_stone(draft, dice, stone):
    """Turn a stone by one, two or three quarters."""
    draft.turns[stone] = (draft.turns[stone] + 1 + drawn(dice, 3)) % 4


def swap(draft, dice, turned):
    """Swap a stone of a course with any other; where it was, the other may be turned."""
    one = drawn(dice, start_of(draft, draft.courses))
    two = drawn(dice, draft.stones)
    if one == two:
        return NOTHING
    draft.order[one], draft.order[two] = draft.order[two], draft.order[one]
    if turned:
        turn_stone(draft, dice, draft.order[one])
    return min(course_of(draft, one), course_of(draft, two))


def turn(draft, dice):
    """Turn a stone of a course."""
    place = drawn(dice, start_of(draft, draft.courses))
    turn_stone(draft, dice, draft.order[place])
    return course_of(draft, place)


def move(draft, dice):
    """Move a stone to a place in the same or another course, or leave it out, or take it back."""
    place: cython.int = drawn(dice, draft.stones)
    to: cython.int = drawn(dice, draft.courses + 1)
    course = course_of(draft, place)
    stone = draft.order[place]
    outside: cython.bint = course == draft.courses
    alone: cython.bint = not outside and draft.sizes[course] == 1
    if (outside and to == course) or (alone and (to == course or draft.courses == 1)):
        return NOTHING
    inside = place - start_of(draft, course)
    move_ints(draft.order, place, draft.order, place + 1, draft.stones - place - 1)
    if alone:
        drop_course(draft, course)
        if to > course:
            to -= 1
    elif not outside:
        draft.sizes[course] -= 1
        move_gap(draft, course, -1 if inside < left_of(draft.gaps[course]) else 0)
    insert(draft, dice, stone, to)
    return min(course, to, draft.courses - 1)


def insert(draft, dice, stone, course):
    """Insert a stone anywhere in a course, or in what is left out; the last place is free."""
    place: cython.int = start_of(draft, course)
    outside: cython.bint = course == draft.courses
    room = draft.stones - place if outside else draft.sizes[course] + 1
    inside = drawn(dice, room)
    place += inside
    move_ints(draft.order, place + 1, draft.order, place, draft.stones - place - 1)
    draft.order[place] = stone
    if not outside:
        draft.sizes[course] += 1
        move_gap(draft, course, 1 if inside < left_of(draft.gaps[course]) else 0)


def drop_course(draft, course):
    """Take a course out of the list of courses."""
    draft.courses -= 1
    for i in range(course, draft.courses):
        draft.sizes[i], draft.gaps[i] = draft.sizes[i + 1], draft.gaps[i + 1]


def shift_gap(draft, dice):
    """Put the gap of a course somewhere else; of one in four it keeps away from the ends."""
    course = drawn(dice, draft.courses)
    gap = drawn(dice, draft.sizes[course] + 1)
    if drawn(dice, 4) == 0:
        gap = -1 - gap
    if gap == draft.gaps[course]:
        return NOTHING
    draft.gaps[course] = gap
    return course


def reverse(draft, dice):
    """Reverse some neighbours of a course."""
    course = drawn(dice, draft.courses)
    size = draft.sizes[course]
    one, two = drawn(dice, size), drawn(dice, size)
    if one == two:
        return NOTHING
    first = start_of(draft, course) + min(one, two)
    last = first + max(one, two) - min(one, two)
    while first < last:
        draft.order[first], draft.order[last] = draft.order[last], draft.order[first]
        first += 1
        last -= 1
    return course


def exchange(draft, dice):
    """Exchange two courses."""
    one, two = drawn(dice, draft.courses), drawn(dice, draft.courses)
    if one == two:
        return NOTHING
    low, high = min(one, two), max(one, two)
    first = start_of(draft, low)
    small, large = draft.sizes[low], draft.sizes[high]
    between = start_of(draft, high) - first - small
    move_ints(draft.spare, 0, draft.order, first, small + between + large)
    move_ints(draft.order, first, draft.spare, small + between, large)
    move_ints(draft.order, first + large, draft.spare, small, between)
    move_ints(draft.order, first + large + between, draft.spare, 0, small)
    draft.sizes[low], draft.sizes[high] = large, small
    draft.gaps[low], draft.gaps[high] = draft.gaps[high], draft.gaps[low]
    return low


def split(draft, dice, most):
    """Make two courses of one."""
    course = drawn(dice, draft.courses)
    size = draft.sizes[course]
    if size < 2 or draft.courses >= most:
        return NOTHING
    lower: cython.int = 1 + drawn(dice, size - 1)
    for i in range(draft.courses, course + 1, -1):
        draft.sizes[i], draft.gaps[i] = draft.sizes[i - 1], draft.gaps[i - 1]
    draft.courses += 1
    draft.sizes[course], draft.sizes[course + 1] = lower, size - lower
    draft.gaps[course], draft.gaps[course + 1] = (lower + 1) // 2, (size - lower + 1) // 2
    return course


def join(draft, dice):
    """Make one course of two."""
    if draft.courses < 2:
        return NOTHING
    course = drawn(dice, draft.courses - 1)
    draft.gaps[course] = draft.sizes[course]
    size = draft.sizes[course] + draft.sizes[course + 1]
    drop_course(draft, course + 1)
    draft.sizes[course] = size
    return course
