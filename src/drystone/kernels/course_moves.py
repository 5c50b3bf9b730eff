"""Small changes of an arrangement of stones in courses.

The twin of `compiled/course_moves.pyx`.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from drystone.kernels.course_types import Arrangement, left_of

NOTHING: Final = -1
"""A change that could not be made."""

SWAP, MOVE, TURN, SWAP_TURN, GAP, REVERSE, EXCHANGE, SPLIT = 20, 36, 48, 54, 58, 61, 62, 63
"""Of 64 changes, so many are of this kind or one before it; what is left joins two courses."""

WORD: Final = (1 << 64) - 1


class Dice:
    """Random whole numbers, the same everywhere: splitmix64.

    Parameters
    ----------
    seed : int
        Any.
    """

    def __init__(self, seed: int) -> None:
        self.state = seed & WORD

    def below(self, count: int) -> int:
        """Return a number from 0 to below `count`, which is less than 2^32."""
        self.state = (self.state + 0x9E3779B97F4A7C15) & WORD
        mixed = self.state
        mixed = ((mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9) & WORD
        mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & WORD
        mixed ^= mixed >> 31
        return ((mixed >> 32) * count) >> 32


@dataclass
class Draft:
    """An arrangement that is being changed; its fields are those of `Arrangement`.

    Parameters
    ----------
    order, turns, sizes, gaps : list of int
        As there.
    """

    order: list[int]
    turns: list[int]
    sizes: list[int]
    gaps: list[int]

    @classmethod
    def of(cls, plan: Arrangement) -> "Draft":
        """Start from an arrangement."""
        return cls(*(part.tolist() for part in plan))

    def copy(self) -> "Draft":
        """Return another one that may be changed."""
        return Draft(list(self.order), list(self.turns), list(self.sizes), list(self.gaps))

    def done(self) -> Arrangement:
        """Return the arrangement."""
        parts = (self.order, self.turns, self.sizes, self.gaps)
        return Arrangement(*(np.array(part, np.int32) for part in parts))

    @property
    def placed(self) -> int:
        """How many stones are in courses."""
        return sum(self.sizes)

    def start(self, course: int) -> int:
        """Return the place of the first stone of a course, or of what is left out."""
        return sum(self.sizes[:course])

    def posed(self, course: int) -> list[int]:
        """Return the poses of the stones of a course, from left to right."""
        start = self.start(course)
        stones = self.order[start : start + self.sizes[course]]
        return [4 * stone + self.turns[stone] for stone in stones]

    def course_of(self, place: int) -> int:
        """Return the course of a place; the number of courses for what is left out."""
        course = 0
        while course < len(self.sizes) and place >= self.sizes[course]:
            place -= self.sizes[course]
            course += 1
        return course

    def move_gap(self, course: int, by: int) -> None:
        """Let so many more stones of a course be laid from the left end, as many as there are."""
        gap = self.gaps[course]
        from_left = min(left_of(gap) + by, self.sizes[course])
        self.gaps[course] = from_left if gap >= 0 else -1 - from_left


def change(draft: Draft, dice: Dice, courses: int) -> int:
    """Change a draft at random.

    Parameters
    ----------
    draft : Draft
        It is changed.
    dice : Dice
        For what is drawn.
    courses : int
        It gets no more.

    Returns
    -------
    course : int
        The lowest one in which something changed, or -1 when nothing did.
    """
    kind = dice.below(64)
    if kind < SWAP:
        return swap(draft, dice, turned=False)
    if kind < MOVE:
        return move(draft, dice)
    if kind < TURN:
        return turn(draft, dice)
    if kind < SWAP_TURN:
        return swap(draft, dice, turned=True)
    return change_course(draft, dice, kind, courses)


def change_course(draft: Draft, dice: Dice, kind: int, courses: int) -> int:
    """Change a draft by more than one or two stones."""
    if kind < GAP:
        return shift_gap(draft, dice)
    if kind < REVERSE:
        return reverse(draft, dice)
    if kind < EXCHANGE:
        return exchange(draft, dice)
    return split(draft, dice, courses) if kind < SPLIT else join(draft, dice)


def swap(draft: Draft, dice: Dice, *, turned: bool) -> int:
    """Swap a stone of a course with any other; where it was, the other may be turned."""
    one, two = dice.below(draft.placed), dice.below(len(draft.order))
    if one == two:
        return NOTHING
    order = draft.order
    order[one], order[two] = order[two], order[one]
    if turned:
        draft.turns[order[one]] = (draft.turns[order[one]] + 1 + dice.below(3)) % 4
    return min(draft.course_of(one), draft.course_of(two))


def turn(draft: Draft, dice: Dice) -> int:
    """Turn a stone of a course by one, two or three quarters."""
    place = dice.below(draft.placed)
    stone = draft.order[place]
    draft.turns[stone] = (draft.turns[stone] + 1 + dice.below(3)) % 4
    return draft.course_of(place)


def move(draft: Draft, dice: Dice) -> int:
    """Move a stone to a place in the same or another course, or leave it out, or take it back."""
    place, to = dice.below(len(draft.order)), dice.below(len(draft.sizes) + 1)
    course = draft.course_of(place)
    left_out = course == len(draft.sizes)
    alone = not left_out and draft.sizes[course] == 1
    if (left_out and to == course) or (alone and (to == course or len(draft.sizes) == 1)):
        return NOTHING
    stone = draft.order[place]
    inside = place - draft.start(course)
    del draft.order[place]
    if alone:
        del draft.sizes[course], draft.gaps[course]
        to -= to > course
    elif not left_out:
        draft.sizes[course] -= 1
        draft.move_gap(course, -(inside < left_of(draft.gaps[course])))
    insert(draft, dice, stone, to)
    return min(course, to, len(draft.sizes) - 1)


def insert(draft: Draft, dice: Dice, stone: int, course: int) -> None:
    """Insert a stone anywhere in a course, or in what is left out."""
    start = draft.start(course)
    if course == len(draft.sizes):
        draft.order.insert(start + dice.below(len(draft.order) - start + 1), stone)
        return
    inside = dice.below(draft.sizes[course] + 1)
    draft.order.insert(start + inside, stone)
    draft.sizes[course] += 1
    draft.move_gap(course, inside < left_of(draft.gaps[course]))


def shift_gap(draft: Draft, dice: Dice) -> int:
    """Put the gap of a course somewhere else; of one in four it keeps away from the ends."""
    course = dice.below(len(draft.sizes))
    gap = dice.below(draft.sizes[course] + 1)
    if dice.below(4) == 0:
        gap = -1 - gap
    if gap == draft.gaps[course]:
        return NOTHING
    draft.gaps[course] = gap
    return course


def reverse(draft: Draft, dice: Dice) -> int:
    """Reverse some neighbours of a course."""
    course = dice.below(len(draft.sizes))
    start, size = draft.start(course), draft.sizes[course]
    one, two = dice.below(size), dice.below(size)
    if one == two:
        return NOTHING
    first, end = start + min(one, two), start + max(one, two) + 1
    draft.order[first:end] = draft.order[first:end][::-1]
    return course


def exchange(draft: Draft, dice: Dice) -> int:
    """Exchange two courses."""
    one, two = dice.below(len(draft.sizes)), dice.below(len(draft.sizes))
    if one == two:
        return NOTHING
    low, high = min(one, two), max(one, two)
    ends = [draft.start(low), draft.start(low + 1), draft.start(high), draft.start(high + 1)]
    order = draft.order
    order[ends[0] : ends[3]] = (
        order[ends[2] : ends[3]] + order[ends[1] : ends[2]] + order[ends[0] : ends[1]]
    )
    for numbers in (draft.sizes, draft.gaps):
        numbers[low], numbers[high] = numbers[high], numbers[low]
    return low


def split(draft: Draft, dice: Dice, courses: int) -> int:
    """Make two courses of one."""
    course = dice.below(len(draft.sizes))
    size = draft.sizes[course]
    if size < 2 or len(draft.sizes) >= courses:
        return NOTHING
    lower = 1 + dice.below(size - 1)
    draft.sizes[course] = lower
    draft.gaps[course] = (lower + 1) // 2
    draft.sizes.insert(course + 1, size - lower)
    draft.gaps.insert(course + 1, (size - lower + 1) // 2)
    return course


def join(draft: Draft, dice: Dice) -> int:
    """Make one course of two."""
    if len(draft.sizes) < 2:
        return NOTHING
    course = dice.below(len(draft.sizes) - 1)
    draft.gaps[course] = draft.sizes[course]
    draft.sizes[course] += draft.sizes.pop(course + 1)
    del draft.gaps[course + 1]
    return course
