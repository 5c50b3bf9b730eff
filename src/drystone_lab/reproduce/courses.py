"""Courses of a brick wall: whether bricks lie level and whether head joints are crossed."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from drystone.model.wall import Wall

OVERLAP = 0.25
"""Of the brick's length, by which head joints of neighbouring courses are apart at least: the
usual rule of a bond."""


@dataclass(frozen=True)
class Brick:
    """The box of a placed brick, px; full when it fills it, so that it is not turned."""

    left: int
    right: int
    bottom: int
    top: int
    full: bool


@dataclass(frozen=True)
class Courses:
    """What the courses of a wall are like.

    Parameters
    ----------
    bricks : int
        In the wall.
    lying : int
        With their long side level.
    in_course : int
        Lying, with their foot at a whole number of brick heights.
    courses : int
        Of these bricks.
    joints : int
        Head joints within courses that have a course next to them.
    crossed : int
        Those that are apart from all head joints of the courses beside them by :data:`OVERLAP`.
    """

    bricks: int
    lying: int
    in_course: int
    courses: int
    joints: int
    crossed: int


def bricks_of(wall: Wall) -> tuple[Brick, ...]:
    """Return the boxes of the stones of a wall of pixels."""
    bricks = []
    for placement in wall.placements:
        rows, cols = placement.window
        height = wall.site.height_px
        bricks.append(
            Brick(cols.start, cols.stop, height - rows.stop, height - rows.start,
                  bool(placement.posed.mask.all()))
        )  # fmt: skip
    return tuple(bricks)


def courses_of(bricks: Sequence[Brick], height_px: int, width_px: int) -> Courses:
    """Look at the courses of equal bricks, of the size of one that lies.

    Examples
    --------
    >>> low = [Brick(0, 20, 0, 10, True), Brick(20, 40, 0, 10, True)]
    >>> courses_of([*low, Brick(10, 30, 10, 20, True), Brick(30, 50, 10, 20, True)], 10, 20)
    Courses(bricks=4, lying=4, in_course=4, courses=2, joints=2, crossed=2)
    """
    lying = [b for b in bricks if b.full and b.right - b.left == width_px]
    level = [b for b in lying if b.bottom % height_px == 0]
    by_course: dict[int, list[Brick]] = {}
    for brick in level:
        by_course.setdefault(brick.bottom // height_px, []).append(brick)
    joints = {course: head_joints(found) for course, found in by_course.items()}
    count = crossed = 0
    for course, places in joints.items():
        if not {course - 1, course + 1} & set(joints):
            continue
        beside = joints.get(course - 1, []) + joints.get(course + 1, [])
        count += len(places)
        crossed += sum(
            all(abs(place - other) >= OVERLAP * width_px for other in beside) for place in places
        )
    return Courses(len(bricks), len(lying), len(level), len(by_course), count, crossed)


def head_joints(course: Sequence[Brick]) -> list[float]:
    """Return the middles of the joints between the bricks of a course that are next to each other.

    A joint may be open, by less than the length of a brick: a wider one is a hole.
    """
    row = sorted(course, key=lambda brick: brick.left)
    return [
        (one.right + other.left) / 2
        for one, other in pairwise(row)
        if other.left - one.right < one.right - one.left
    ]
