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

TERMS: Final = 16
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
    """What a plan costs, for each unit of what is counted; nothing is below 0.

    Parameters
    ----------
    step : float
        A unit by which the tops of a course go up or down along it.
    level : float
        A unit by which a part of a course's top is off their mean.
    top : float
        The same in the last course, on top.
    joint : float
        A head joint right above another.
    overflow : float
        A unit by which the stones of a course are too wide for the wall.
    slack : float
        A unit of width times a unit of area of what they leave free below the mean top.
    void : float
        A unit of height of a column that is void below a stone.
    turn : float
        A unit by which a stone's ends go up and down when it turns until it rests on two points.
    rock : float
        A unit by which one of its sides stays above what is below after that turn.
    support : float
        The whole width by which the centroid is too near to the end of the support.
    overhead : float
        A unit by which a stone is above the wall's height.
    high : float
        A stone that is above it.
    flush : float
        A unit between the end of the wall and the mean face of the stone there.
    left_out : float
        The unit of area, a column times a unit, of stones left out.
    across : float
        A percent of F_AH, as far as bed joints and starts tell.
    down : float
        A percent by which F_AV is short of the target, as far as head joints tell.
    """

    step: float
    level: float
    top: float
    joint: float
    overflow: float
    slack: float
    void: float
    turn: float
    rock: float
    support: float
    overhead: float
    high: float
    flush: float
    left_out: float
    across: float
    down: float


class Rules(NamedTuple):
    """How stones are laid and what that costs.

    Parameters
    ----------
    weights : Weights
        Of the terms of the cost.
    reach : int
        Head joints are crossed when this far from those below, positive.
    margin : float
        The centroid is this far inside its support, over the stone's width.
    steepest : int
        Slope to which a stone turns at most until it rests.
    joint : int
        Stones are this far apart, more than they must.
    courses : int
        There are at most so many.
    target : float
        F_AV that is enough, percent.
    """

    weights: Weights
    reach: int
    margin: float
    steepest: int
    joint: int
    courses: int
    target: float


class Poses(NamedTuple):
    """Stones in their four quarter turns.

    Parameters
    ----------
    first : (4 n + 1,) int64 array
        Where the columns of each pose start in `bottoms` and `tops`.
    bottoms, tops : int32 arrays
        Lowest and highest points of a pose over its columns, from its lowest point.
    first_row : (4 n + 1,) int64 array
        Where the rows of each pose, as high as columns are wide, start in `lefts` and `rights`.
    lefts, rights : int32 arrays
        Leftmost and rightmost points of a pose in its rows, from its left end; rows are counted
        from its lowest point.
    width, height : (4 n,) int32 arrays
        Of its box.
    middle : (4 n,) int32 array
        The first column right of its centroid.
    peaks : (4 n, PARTS) int32 array
        Highest points of the parts of its top, from its lowest point.
    part_at : (4 n, PARTS) int32 array
        Columns in the middle of the parts.
    faces : (4 n, 2) int32 array
        How far its left and right faces are, in the mean, inside its box.
    area : (n,) int64 array
        Of the stones, columns times units.
    """

    first: Longs
    bottoms: Ints
    tops: Ints
    first_row: Longs
    lefts: Ints
    rights: Ints
    width: Ints
    height: Ints
    middle: Ints
    peaks: Ints
    part_at: Ints
    faces: Ints
    area: Longs


class Ground(NamedTuple):
    """What the courses are laid on, and the room that there is.

    Parameters
    ----------
    tops : (columns,) int32 array
        Height of what is there.
    joints : (n, 2) int32 array
        Left and right ends of the head joints of the course below, and of what is free at the two
        ends of the wall, from left to right; none on bare ground.
    ways : (n, STARTS) int32 array
        How far paths from the bottom to these joints go aside, from each start.
    beds : (m, 3) int32 array
        Heights of the bed joints below at the left and right ends of the wall, and how much they
        go up and down in between.
    width, height : int
        Of the wall.
    """

    tops: Ints
    joints: Ints
    ways: Ints
    beds: Ints
    width: int
    height: int


class Arrangement(NamedTuple):
    """Stones in courses.

    Parameters
    ----------
    order : (n,) int32 array
        All stones: those of the first course from left to right, the next one's, ...; at the end
        those that are left out.
    turns : (n,) int32 array
        Quarter turns of each stone, 0 to 3, by its number.
    sizes : (courses,) int32 array
        How many stones there are in each course, none empty.
    gaps : (courses,) int32 array
        How many of them are laid from the left end, the others from the right end.  Below 0 it
        is -1 less that number, and the course keeps away from both ends of the wall
        (:data:`INSET`): so whole bricks are bonded in a wall that fits so many.
    """

    order: Ints
    turns: Ints
    sizes: Ints
    gaps: Ints


class Cooling(NamedTuple):
    """How annealing goes on.

    Parameters
    ----------
    evaluations : int
        How many.
    temperature : float
        At the start; a plan costlier by this much is accepted with probability 1/e.
    factor : float
        Of the temperature, after each evaluation.
    seed : int
        Any integer; equal seeds give equal plans.
    doubt : float
        A changed plan is given up when, up to the highest course that changed or one above it, it
        costs more by this than it may: what is above seldom makes up for it.
    """

    evaluations: int
    temperature: float
    factor: float
    seed: int
    doubt: float = math.inf


class Layout(NamedTuple):
    """Where the stones of an arrangement lie.

    Parameters
    ----------
    x, y : (placed,) int32 arrays
        Left end and lowest point (before it turned) of each, in the order of the arrangement.
    slope : (placed,) int32 array
        By how much each turned until it rested.
    tops : (columns,) int32 array
        Height of all.
    joints : (n, 2) int32 array
        Head joints of the last course, and its ends.
    terms : (courses + 1, TERMS) float array
        What is counted in each course, and in the whole, before weights.
    cost : float
        Of all.
    """

    x: Ints
    y: Ints
    slope: Ints
    tops: Ints
    joints: Ints
    terms: Floats
    cost: float
