"""A wall to be planned course by course, in the whole numbers of the kernels."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.course_types import (
    COLUMN_UNITS,
    PARTS,
    SLOPE_ONE,
    STARTS,
    Bed,
    Ground,
    Ints,
    Joints,
    Longs,
    Poses,
    Rules,
    Weights,
)
from drystone.kernels.courses import ways_up
from drystone.kernels.polygons import Points, turn
from drystone.kernels.profiles import StoneProfile, bare, extremes, hanging, raised
from drystone.model.stone import Stone
from drystone.planner.search_settings import CourseSettings
from drystone.poses import PoseBook

PINNED = 10
"""A pinned stone that is left out counts so many times its area."""

PLENTY = 1.5
"""From so many times the area of the wall on, a stock leaves a choice."""

LEFT_OUT, HIGH = 0.5, 5.0
"""Factors on the weights of what is left out and of what stands out above the wall when there is a
choice: else stones would be planned above the wall's height, where they cannot be laid, as they
cost less there than left out."""


@dataclass(frozen=True, eq=False)
class CourseTask:
    """A wall to be planned; a column of the kernels' profiles is half a working px wide."""

    settings: CourseSettings
    stones: tuple[Stone, ...]  # by their numbers
    # Four turns of each: those at which it fits into the wall, over and over.
    angles_deg: tuple[tuple[float, ...], ...]
    corners: tuple[Points, ...]  # of these turns, relative to the centroid, source px
    poses: Poses
    ground: Ground  # what the stones are laid on
    rules: Rules
    unit_px: float  # of the kernels, in source px

    @property
    def taken(self) -> int:
        """About how many stones the wall takes, at most all."""
        median = float(np.median(self.poses.area))
        return max(1, min(self.poses.area.size, round(self._room / median)))

    @property
    def _room(self) -> float:
        return self.ground.width * self.ground.height / COLUMN_UNITS

    def choosing(self, pinned: Collection[int]) -> "CourseTask":
        """Return the task for annealing: with a choice in a large stock, and what is pinned.

        Until then it is as if the stones were about enough for the wall.
        """
        rules, poses = self.rules, self.poses
        stock = int(poses.area.sum()) + int(self.ground.tops.sum())
        if stock > PLENTY * self._room:
            share = self.taken / poses.area.size  # these count by the stone that the wall takes
            weights = rules.weights._replace(
                left_out=LEFT_OUT * rules.weights.left_out,
                high=HIGH * rules.weights.high,
                across=share * rules.weights.across,
                down=share * rules.weights.down,
            )
            rules = rules._replace(weights=weights)
        if pinned:
            factors = [PINNED if stone.id in pinned else 1 for stone in self.stones]
            poses = poses._replace(area=poses.area * np.array(factors, np.int64))
        return replace(self, rules=rules, poses=poses)


def task_of(
    stones: Collection[Stone],
    size_px: tuple[float, float],
    cell_px: float,
    tolerance_px: float,
    settings: CourseSettings,
    *,
    laid: Sequence[Sequence[Points]] = (),
    book: PoseBook | None = None,
) -> CourseTask | None:
    """Return what the kernels are asked; None when no stone fits into the wall.

    The wall and a working px (`cell_px`) are in source px, and so is the tolerance of outlines.
    `laid` are the outlines of the stones of each course that is there, the lowest first.
    """
    book, column_px = book or PoseBook(), 0.5 * cell_px
    fitting: list[Stone] = []
    angles: list[tuple[float, ...]] = []
    corners: list[Points] = []
    for stone in stones:
        outline = stone.outline_within(tolerance_px)
        turned = {angle: turn(outline, angle) for angle in book.angles(stone, "quarter")}
        possible = [
            angle for angle, points in turned.items() if (np.ptp(points, axis=0) <= size_px).all()
        ]
        if possible:
            fitting.append(stone)
            angles.append(tuple(possible[i % len(possible)] for i in range(4)))
            corners += [turned[angle] for angle in angles[-1]]
    if not fitting:
        return None
    areas = np.array([stone.area_px for stone in fitting], np.float64)
    poses = poses_of(corners, areas, column_px)
    ground = ground_of(laid, size_px, column_px)
    rules = _rules_of(settings, poses, ground.height)
    unit_px = column_px / COLUMN_UNITS
    return CourseTask(
        settings, tuple(fitting), tuple(angles), tuple(corners), poses, ground, rules, unit_px
    )


def _rules_of(settings: CourseSettings, poses: Poses, height: int) -> Rules:
    area = float(poses.area.mean()) * COLUMN_UNITS
    size = math.sqrt(area)
    part = size * poses.peaks.shape[1]
    stones = poses.area.size
    weights = Weights(
        step=settings.step / size,
        level=settings.level / part,
        top=settings.top / part,
        joint=settings.joint,
        overflow=settings.overflow / size,
        slack=settings.slack * COLUMN_UNITS / (area * size),
        void=settings.void * COLUMN_UNITS / area,
        turn=settings.turn / size,
        rock=settings.rock / size,
        support=settings.support,
        overhead=settings.overhead / size,
        high=settings.high,
        flush=settings.flush / size,
        upright=settings.upright,
        left_out=settings.left_out * COLUMN_UNITS / area,
        across=settings.across * stones,
        down=settings.down * stones,
    )
    # A plan may have twice the courses that a wall of flat stones needs.
    flat_height = float(np.median(poses.height.reshape(-1, 4).min(axis=1)))
    most = math.ceil(2.0 * height / max(flat_height, 1.0)) + 2
    return Rules(
        weights,
        reach=max(1, round(settings.reach * size)),
        margin=settings.margin,
        steepest=round(math.tan(math.radians(settings.steepest_deg)) * COLUMN_UNITS * SLOPE_ONE),
        joint=round(settings.apart * size),
        courses=max(1, min(stones, most)),
        target=settings.target,
    )


def poses_of(corners: Collection[Points], areas_px: NDArray[np.float64], column_px: float) -> Poses:
    """Return outlines, four of each stone relative to its centroid, in the units of the kernels."""
    unit_px = column_px / COLUMN_UNITS
    beside = [hanging(points, column_px) for points in corners]
    above = [hanging(points[:, ::-1], column_px) for points in corners]
    parts = [_parts_of(profile, unit_px) for profile in beside]
    boxes = np.array([(p.right - p.left, p.top - p.bottom) for p in beside]).reshape(-1, 2)
    return Poses(
        first=_starts(beside),
        bottoms=_units([profile.bottoms - profile.bottom for profile in beside], unit_px),
        tops=_units([profile.tops - profile.bottom for profile in beside], unit_px),
        first_row=_starts(above),
        lefts=_units([profile.bottoms - profile.bottom for profile in above], unit_px),
        rights=_units([profile.tops - profile.bottom for profile in above], unit_px),
        # No pose is wider than it is: a wall that is as wide as a stone has room for it.
        width=np.floor(boxes[:, 0] / unit_px + 1e-6).astype(np.int32),
        height=np.floor(boxes[:, 1] / unit_px + 1e-6).astype(np.int32),
        # The first column right of the centroid; there is one left of it if there are two.
        middle=np.array(
            [max(1, min(round(-p.left / column_px), p.bottoms.size - 1)) for p in beside], np.int32
        ),
        peaks=np.array([peaks for peaks, _ in parts], np.int32),
        part_at=np.array([at for _, at in parts], np.int32),
        # How far the left and right faces are inside the box in the mean, by profiles of rows.
        faces=np.array(
            [
                (
                    round((float(p.bottoms.mean()) - p.bottom) / unit_px),
                    round((p.top - float(p.tops.mean())) / unit_px),
                )
                for p in above
            ],
            np.int32,
        ),
        area=np.rint(areas_px / (column_px * unit_px)).astype(np.int64),
    )


def _starts(profiles: list[StoneProfile]) -> Longs:
    """Return where each profile starts in one array of all, and where the last ends."""
    counts = [profile.bottoms.size for profile in profiles]
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def _units(lengths_px: list[Points], unit_px: float) -> Ints:
    return np.rint(np.concatenate(lengths_px) / unit_px).astype(np.int32)


def _parts_of(profile: StoneProfile, unit_px: float) -> tuple[list[int], list[int]]:
    """Return the highest points of the parts of a top, and the columns in their middle."""
    columns = profile.tops.size
    ends = [columns * i // PARTS for i in range(PARTS + 1)]
    peaks, at = [], []
    for start, end in pairwise(ends):
        part = profile.tops[start : max(end, start + 1)]
        peaks.append(round((float(part.max()) - profile.bottom) / unit_px))
        at.append((start + max(end, start + 1)) // 2)
    return peaks, at


def ground_of(
    laid: Sequence[Sequence[Points]], size_px: tuple[float, float], column_px: float
) -> Ground:
    """Return what kernels see of courses that are laid, the lowest first, or of the bare ground."""
    unit_px = column_px / COLUMN_UNITS
    width, height = (math.floor(side / unit_px + 1e-6) for side in size_px)
    profile = bare(max(1, math.ceil(size_px[0] / column_px - 1e-9)))
    for index, corners in enumerate(corners for course in laid for corners in course):
        profile = raised(profile, corners, index, column_px)
    joints: Joints = []
    beds: list[Bed] = []
    ways = np.zeros((0, STARTS), np.int32)
    for course in filter(len, laid):
        below, joints = joints, _joints_of(course, width, unit_px)
        ways = ways_up(joints, below, ways, width)
        beds.append(_bed_of(course, unit_px))
    return Ground(
        np.rint(profile.tops / unit_px).astype(np.int32),
        np.array(joints, np.int32).reshape(-1, 2),
        ways,
        np.array(beds, np.int32).reshape(-1, 3),
        width,
        height,
    )


def _joints_of(course: Sequence[Points], width: int, unit_px: float) -> Joints:
    """Return the head joints of a laid course, and what is free at its ends, in units."""
    ends = sorted(
        (round(float(corners[:, 0].min()) / unit_px), round(float(corners[:, 0].max()) / unit_px))
        for corners in course
    )
    joints = []
    for (_, right), (left, _) in pairwise([(0, 0), *ends, (width, width)]):
        middle = (left + right) >> 1
        joints.append((min(right, middle), max(left, middle)))
    return joints


def _bed_of(course: Sequence[Points], unit_px: float) -> Bed:
    """Return the heights of a laid course's top at its ends, and its ups and downs, in units."""
    peaks: list[int] = []
    for corners in sorted(course, key=lambda corners: float(corners[:, 0].min())):
        left, right = float(corners[:, 0].min()), float(corners[:, 0].max())
        # The highest points of the parts of the top, from left to right.
        highest = extremes(corners, left, (right - left) / PARTS, PARTS)[1].tolist()
        peaks += [round(top / unit_px) for top in highest]
    return peaks[0], peaks[-1], sum(abs(b - a) for a, b in pairwise(peaks))
