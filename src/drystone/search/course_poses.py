"""Stones in quarter turns, as profiles in whole numbers."""

from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drystone.kernels.course_types import COLUMN_UNITS, PARTS, Ints, Longs, Poses
from drystone.kernels.polygons import Points
from drystone.kernels.profiles import StoneProfile, hanging
from drystone.kernels.raster import turn
from drystone.model.stone import Stone
from drystone.poses import PoseBook


@dataclass(frozen=True, eq=False)
class Quarters:
    """Stones in their quarter turns."""

    stones: tuple[Stone, ...]  # By their numbers
    # Four of each: those at which it fits into the wall, over and over
    angles_deg: tuple[tuple[float, ...], ...]
    # (n, 2) Turned outlines, relative to the centroid, source px; four of each stone
    corners: tuple[Points, ...]
    poses: Poses  # As the kernels see them


def quarters_of(
    stones: Collection[Stone],
    size_px: tuple[float, float],
    column_px: float,
    tolerance_px: float,
    book: PoseBook,
) -> Quarters | None:
    """Turn stones by quarters; None when none fits into the wall."""
    fitting: list[Stone] = []
    angles: list[tuple[float, ...]] = []
    corners: list[Points] = []
    for stone in stones:
        outline = stone.outline_within(tolerance_px)
        turned = {angle: turn(outline, angle) for angle in book.angles(stone, "quarter")}
        possible = [angle for angle, points in turned.items() if fits(points, size_px)]
        if possible:
            fitting.append(stone)
            angles.append(tuple(possible[i % len(possible)] for i in range(4)))
            corners += [turned[angle] for angle in angles[-1]]
    if not fitting:
        return None
    areas = np.array([stone.area_px for stone in fitting], np.float64)
    poses = poses_of(corners, areas, column_px)
    return Quarters(tuple(fitting), tuple(angles), tuple(corners), poses)


def fits(corners: Points, size_px: tuple[float, float]) -> bool:
    """Return whether a turned outline is no larger than the wall."""
    width, height = (corners.max(axis=0) - corners.min(axis=0)).tolist()
    return bool(width <= size_px[0] and height <= size_px[1])


def poses_of(corners: Collection[Points], areas_px: NDArray[np.float64], column_px: float) -> Poses:
    """Return outlines in the units of the kernels."""
    unit_px = column_px / COLUMN_UNITS
    beside = [hanging(points, column_px) for points in corners]
    above = [hanging(points[:, ::-1], column_px) for points in corners]
    middles = [middle_of(profile, column_px) for profile in beside]
    parts = [parts_of(profile, unit_px) for profile in beside]
    faces = [faces_of(profile, unit_px) for profile in above]
    boxes = np.array([(p.right - p.left, p.top - p.bottom) for p in beside]).reshape(-1, 2)
    return Poses(
        first=starts([profile.bottoms.size for profile in beside]),
        bottoms=units([profile.bottoms - profile.bottom for profile in beside], unit_px),
        tops=units([profile.tops - profile.bottom for profile in beside], unit_px),
        first_row=starts([profile.bottoms.size for profile in above]),
        lefts=units([profile.bottoms - profile.bottom for profile in above], unit_px),
        rights=units([profile.tops - profile.bottom for profile in above], unit_px),
        # No pose is wider than it is: a wall that is as wide as a stone has room for it.
        width=np.floor(boxes[:, 0] / unit_px + 1e-6).astype(np.int32),
        height=np.floor(boxes[:, 1] / unit_px + 1e-6).astype(np.int32),
        middle=np.array(middles, np.int32),
        peaks=np.array([peaks for peaks, _ in parts], np.int32),
        part_at=np.array([at for _, at in parts], np.int32),
        faces=np.array(faces, np.int32),
        area=np.rint(areas_px / (column_px * unit_px)).astype(np.int64),
    )


def starts(counts: list[int]) -> Longs:
    """Return where each of some runs starts in one array, and where the last ends."""
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)


def units(lengths_px: list[Points], unit_px: float) -> Ints:
    """Return lengths in units, in one array."""
    return np.rint(np.concatenate(lengths_px) / unit_px).astype(np.int32)


def middle_of(profile: StoneProfile, column_px: float) -> int:
    """Return the first column right of the centroid; there is one left of it if there are two."""
    return max(1, min(round(-profile.left / column_px), profile.bottoms.size - 1))


def parts_of(profile: StoneProfile, unit_px: float) -> tuple[list[int], list[int]]:
    """Return the highest points of the parts of a top, and the columns in their middle."""
    columns = profile.tops.size
    ends = [columns * i // PARTS for i in range(PARTS + 1)]
    peaks, at = [], []
    for start, end in pairwise(ends):
        part = profile.tops[start : max(end, start + 1)]
        peaks.append(round((float(part.max()) - profile.bottom) / unit_px))
        at.append((start + max(end, start + 1)) // 2)
    return peaks, at


def faces_of(profile: StoneProfile, unit_px: float) -> tuple[int, int]:
    """Return how far the left and right faces are inside the box in the mean.

    The profile is one of rows: its bottoms are the left face.
    """
    left = float(profile.bottoms.mean()) - profile.bottom
    right = profile.top - float(profile.tops.mean())
    return round(left / unit_px), round(right / unit_px)
