"""What a wall of courses is planned from, in whole numbers.

Lengths are whole numbers of a unit of which a column of the height profiles has
:data:`COLUMN_UNITS`; slopes are units a column times :data:`SLOPE_ONE`.  Stones are numbered from
0; stone s after q quarter turns is pose 4 s + q.
"""

import math
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Floats = NDArray[np.float64]

COLUMN_BITS: Final = 4
COLUMN_UNITS: Final = 1 << COLUMN_BITS
"""Units in a column."""

PIXEL_UNITS: Final = 2 * COLUMN_UNITS
"""Units in a working px, of which the joint paths speak."""

SLOPE_BITS: Final = 12
SLOPE_ONE: Final = 1 << SLOPE_BITS
"""A slope of one unit a column."""

PARTS: Final = 4
"""So many heights of a stone's top are compared with those of its neighbours."""

INSET: Final = (2, 5)
"""A course that keeps away from the ends does so by this share of its room: an end stone that is
as wide as the room, in the course above, still has its centroid on it."""

TERMS: Final = 17
"""Terms of the cost, in the order of :class:`Weights`."""

FIRST_PX: Final = 10
"""Distance of the first path's start from the end of the wall, px."""

STARTS: Final = 10
"""The side is divided by this to find the distance between two starts; there are no more."""

PADDING_PX: Final = 3
"""Open rows and columns around the wall, px; one of them comes first."""

Joints = list[tuple[int, int]]
Bed = tuple[int, int, int]


class Weights(NamedTuple):
    """What a plan costs, for each unit of what is counted; nothing is below 0."""

    step: float  # a unit by which the tops of a course go up or down along it
    level: float  # a unit by which a part of a course's top is off their mean
    top: float  # the same in the last course, on top
    joint: float  # a head joint right above another
    overflow: float  # a unit by which the stones of a course are too wide for the wall
    slack: float  # a unit of width times a unit of area of what they leave free below the mean top
    void: float  # a unit of height of a column that is void below a stone
    # a unit by which a stone's ends go up and down when it turns until it rests on two points
    turn: float
    rock: float  # a unit by which one of its sides stays above what is below after that turn
    support: float  # the whole width by which the centroid is too near to the end of the support
    overhead: float  # a unit by which a stone is above the wall's height
    high: float  # a stone that is above it
    flush: float  # a unit between the end of the wall and the mean face of the stone there
    upright: float  # by how much a stone is higher than wide, over its width
    left_out: float  # the unit of area, a column times a unit, of stones left out
    across: float  # a percent of F_AH, as far as bed joints and starts tell
    down: float  # a percent by which F_AV is short of the target, as far as head joints tell


class Rules(NamedTuple):
    """How stones are laid and what that costs."""

    weights: Weights  # of the terms of the cost
    reach: int  # head joints are crossed when this far from those below, positive
    margin: float  # the centroid is this far inside its support, over the stone's width
    steepest: int  # slope to which a stone turns at most until it rests
    joint: int  # stones are this far apart, more than they must
    courses: int  # there are at most so many
    target: float  # f_AV that is enough, percent


class Poses(NamedTuple):
    """Stones in their four quarter turns."""

    first: Longs  # (4 n + 1,) where the columns of each pose start in `bottoms` and `tops`
    bottoms: Ints  # lowest and highest points of a pose over its columns, from its lowest point
    tops: Ints
    # (4 n + 1,) where the rows of each pose, as high as columns are wide, start in `lefts`
    # and `rights`
    first_row: Longs
    # leftmost and rightmost points of a pose in its rows, from its left end; rows are counted
    # from its lowest point
    lefts: Ints
    rights: Ints
    width: Ints  # (4 n,) of its box
    height: Ints
    middle: Ints  # (4 n,) the first column right of its centroid
    peaks: Ints  # (4 n, PARTS) highest points of the parts of its top, from its lowest point
    part_at: Ints  # (4 n, PARTS) columns in the middle of the parts
    faces: Ints  # (4 n, 2) how far its left and right faces are, in the mean, inside its box
    area: Longs  # (n,) of the stones, columns times units


class Ground(NamedTuple):
    """What the courses are laid on, and the room that there is."""

    tops: Ints  # (columns,) height of what is there
    # (n, 2) left and right ends of the head joints of the course below, and of what is free
    # at the two ends of the wall, from left to right; none on bare ground
    joints: Ints
    # (n, STARTS) how far paths from the bottom to these joints go aside, from each start
    ways: Ints
    # (m, 3) heights of the bed joints below at the left and right ends of the wall, and how
    # much they go up and down in between
    beds: Ints
    width: int  # of the wall
    height: int


class Arrangement(NamedTuple):
    """Stones in courses."""

    # (n,) all stones: those of the first course from left to right, the next one's, ...; at
    # the end those that are left out
    order: Ints
    turns: Ints  # (n,) quarter turns of each stone, 0 to 3, by its number
    sizes: Ints  # (courses,) how many stones there are in each course, none empty
    # (courses,) how many of them are laid from the left end, the others from the right end.
    # below 0 it is -1 less that number, and the course keeps away from both ends of the wall
    # (:data:`INSET`): so whole bricks are bonded in a wall that fits so many
    gaps: Ints


class Cooling(NamedTuple):
    """How annealing goes on."""

    evaluations: int  # how many
    # at the start; a plan costlier by this much is accepted with probability 1/e
    temperature: float
    factor: float  # of the temperature, after each evaluation
    seed: int  # any integer; equal seeds give equal plans
    # a changed plan is given up when, up to the highest course that changed or one above it,
    # it costs more by this than it may: what is above seldom makes up for it
    doubt: float = math.inf


class Layout(NamedTuple):
    """Where the stones of an arrangement lie."""

    # (placed,) left end and lowest point (before it turned) of each, in the order of the
    # arrangement
    x: Ints
    y: Ints
    slope: Ints  # (placed,) by how much each turned until it rested
    tops: Ints  # (columns,) height of all
    joints: Ints  # (n, 2) head joints of the last course, and its ends
    # (courses + 1, TERMS) what is counted in each course, and in the whole, before weights
    terms: Floats
    cost: float  # of all
