"""What laid courses leave for those that are planned above them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from drystone.kernels.course_types import COLUMN_UNITS, PARTS, STARTS, Bed, Ground, Joints
from drystone.kernels.courses import ways_up
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import bare, extremes, raised


def columns_of(width_px: float, column_px: float) -> int:
    """Return how many columns a wall has."""
    return max(1, math.ceil(width_px / column_px - 1e-9))


@dataclass(frozen=True, eq=False)
class LaidCourses:
    """What is there already, as height profiles see it."""

    tops_px: Points  # (columns,) Its height over columns of half a working px, source px
    # (n, 2) Outlines of the stones of each course in the wall frame, the lowest first; an empty
    # course is none
    courses: tuple[tuple[Points, ...], ...] = field(default=())

    @classmethod
    def of(
        cls, courses: Sequence[Sequence[Points]], width_px: float, cell_px: float
    ) -> "LaidCourses":
        """Return what laid stones leave for the next course."""
        column_px = 0.5 * cell_px
        profile = bare(columns_of(width_px, column_px))
        outlines = [corners for course in courses for corners in course]
        for index, corners in enumerate(outlines):
            profile = raised(profile, corners, index, column_px)
        return cls(profile.tops, tuple(tuple(course) for course in courses if len(course)))


def ground_of(laid: LaidCourses | None, size_px: tuple[float, float], column_px: float) -> Ground:
    """Return what kernels see of what is laid, or of the bare ground."""
    unit_px = column_px / COLUMN_UNITS
    columns = columns_of(size_px[0], column_px)
    width, height = (math.floor(side / unit_px + 1e-6) for side in size_px)
    laid = laid or LaidCourses(np.zeros(columns))
    if laid.tops_px.shape != (columns,):
        raise ValueError(f"{columns} columns are needed, not {laid.tops_px.shape}")
    joints: Joints = []
    ways = np.zeros((0, STARTS), np.int32)
    for course in laid.courses:
        below, joints = joints, joints_of(course, width, unit_px)
        ways = ways_up(joints, below, ways, width)
    beds = [bed_of(course, unit_px) for course in laid.courses]
    return Ground(
        np.rint(laid.tops_px / unit_px).astype(np.int32),
        np.array(joints, np.int32).reshape(-1, 2),
        ways,
        np.array(beds, np.int32).reshape(-1, 3),
        width,
        height,
    )


def joints_of(course: Sequence[Points], width: int, unit_px: float) -> Joints:
    """Return the head joints of a laid course, and what is free at its ends, in units."""
    ends = sorted(
        (round(float(corners[:, 0].min()) / unit_px), round(float(corners[:, 0].max()) / unit_px))
        for corners in course
    )
    ends = [(0, 0), *ends, (width, width)]
    joints = []
    for (_, right), (left, _) in pairwise(ends):
        middle = (left + right) >> 1
        joints.append((min(right, middle), max(left, middle)))
    return joints


def bed_of(course: Sequence[Points], unit_px: float) -> Bed:
    """Return the heights of a laid course's top at its ends, and its ups and downs, in units."""
    peaks = [
        round(top / unit_px)
        for corners in sorted(course, key=lambda corners: float(corners[:, 0].min()))
        for top in part_tops(corners)
    ]
    return peaks[0], peaks[-1], sum(abs(b - a) for a, b in pairwise(peaks))


def part_tops(corners: Points) -> list[float]:
    """Return the highest points of the parts of an outline's top, from left to right."""
    left, right = float(corners[:, 0].min()), float(corners[:, 0].max())
    highest: list[float] = extremes(corners, left, (right - left) / PARTS, PARTS)[1].tolist()
    return highest
