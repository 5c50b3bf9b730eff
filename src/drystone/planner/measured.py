"""Where the stones of a wall are, as it was measured: by poses, or by a picture of ids."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError
from drystone.kernels.coverage import coverage, windows
from drystone.kernels.polygons import Points, turn
from drystone.kernels.raster import Mask, wrap_deg
from drystone.model.settings import of_type
from drystone.model.site import Site, working_px
from drystone.model.stone import Stone, StoneSet
from drystone.model.wall import Labels, Wall
from drystone.settle.rest import settled_at

SEEN = (0.6, 1.5)
"""A stone of which less than this share is in the picture, or more, is not measured by it."""

SHARPER = 0.8
"""A stone is turned otherwise than planned when that explains the picture so much better."""

FIRST_STEP, LAST_STEP = 0.5, 0.02
"""Of the search for the best overlap: px of the picture, and as far at the rim of the stone."""

COARSE_DEG = 10.0

SAME = 0.15
"""Pixels in a picture that are not where they were planned, over those at the rim of the stone:
with fewer it is where it was planned, as far as the picture can tell."""


Fit = tuple[float, float, float]
"""x, y in px of a picture, y up, and an angle in degrees."""


@dataclass(frozen=True)
class MeasuredPose:
    """Where a stone is, in the numbers of a plan (:class:`drystone.model.plan.StoneStep`).

    Parameters
    ----------
    x, y : float
        Its centroid in the wall frame, from the left end and from the ground: metres when the
        site has a scale, otherwise source px.
    angle_deg : float
        Counter-clockwise from the source image.
    """

    x: float
    y: float
    angle_deg: float


@dataclass(frozen=True)
class MeasuredPlace:
    """The same in source px."""

    # centroid, source px
    x_px: float
    y_px: float
    angle_deg: float  # in [-180, 180)
    as_planned: bool = False  # the picture shows the stone where it was planned


def places_of(poses: Mapping[int, MeasuredPose], site: Site) -> dict[int, MeasuredPlace]:
    """Return measured poses in source px.

    InputError (E197): a pose is not a number, or its centroid is outside of the wall.
    """
    px = site.px_per_m or 1.0
    width, height = site.extent_px
    found = {}
    for stone_id, pose in poses.items():
        try:
            told = (pose.x, pose.y, pose.angle_deg)
            x, y, angle = (of_type(number, float, "each") for number in told)
        except (AttributeError, TypeError, OverflowError):
            what = f"stone {stone_id} is measured at {pose!r}, which is not a MeasuredPose."
            cure = "Give MeasuredPose(x, y, angle_deg), three numbers, for each stone."
            raise InputError("E197", what, where="observe", cure=cure) from None
        # What is no number compares with nothing.
        inside = 0.0 <= x * px <= width and 0.0 <= y * px <= height
        if not inside or not math.isfinite(angle):
            raise InputError(
                "E197",
                f"stone {stone_id} is measured at ({x:g}, {y:g}), {angle:g} degrees, which is not "
                f"in the wall of {width / px:g} x {height / px:g} "
                f"{'m' if site.px_per_m else 'source px'}.",
                where="observe",
                cure="Leave out what has fallen; poses are of the wall frame, from its left end "
                "and the ground.",
            )
        found[int(stone_id)] = MeasuredPlace(x * px, y * px, wrap_deg(angle))
    return found


def places_in(
    labels: NDArray[np.integer], wall: Wall, stones: StoneSet, wedge_ids: frozenset[int]
) -> dict[int, MeasuredPlace]:
    """Return where the stones of a picture of ids are.

    The picture has 0 for nothing, row 0 at the top; it shows the whole wall at the working or the
    source resolution of the site.  Ids of wedges are not looked at.

    Each stone is matched with its outline: its centroid is that of its pixels, its angle the one
    at which the outline covers them best, and both are refined together until the squared
    difference of pixels and coverage is least.

    InputError: E196: the picture is not one of the wall; E195: an id is not that of a stone; E197:
    much of a stone is not to be seen, or more than there is of it.
    """
    labels, site = np.asarray(labels), wall.site
    scale = _scale_of(labels, site)
    planned = {p.stone_id: p for p in wall.placements}
    ids = set(np.unique(labels).tolist()) - {0} - wedge_ids
    require_known(ids, stones)
    expected = _expected(wall, scale)
    found = {}
    for stone_id in sorted(ids):
        seen = np.asarray(labels == stone_id)
        stone = stones.by_id(stone_id)
        _require_seen(stone, int(seen.sum()) / scale**2)
        placement = planned.get(stone_id)
        if placement is None:
            found[stone_id] = fitted(seen, stone.outline, scale, None)
            continue
        x, y = placement.centroid(site.height_px)
        there = MeasuredPlace(x / site.scale, y / site.scale, placement.posed.angle_deg, True)
        planned_px = np.asarray(expected == stone_id)
        # How many pixels differ, over how many are at the rim of what was planned.
        rim = int((planned_px & ~ndimage.binary_erosion(planned_px)).sum())
        if int((seen ^ planned_px).sum()) / max(rim, 1) <= SAME:
            found[stone_id] = there
        else:
            found[stone_id] = fitted(seen, stone.outline, scale, there.angle_deg)
    return found


def require_known(ids: Iterable[object], stones: StoneSet) -> None:
    """Raise InputError (E195) for ids that are of no stone."""
    unknown = sorted(
        set(ids) - {stone.id for stone in stones}, key=lambda i: (str(i), str(type(i)))
    )
    if unknown:
        # The keys of JSON are text: '5' is not 5.
        named = ", ".join(repr(i) if isinstance(i, str) else str(i) for i in unknown)
        what = f"there is no stone {named} among the {len(stones)} stones."
        cure = "Measure stones by the ids that they were read with; 0 is the background."
        raise InputError("E195", what, where="observe", cure=cure)


def fitted(seen: Mask, outline: Points, scale: float, planned_deg: float | None) -> MeasuredPlace:
    """Return the pose at which an outline covers the pixels of a stone best.

    `seen` are the pixels, row 0 at the top; the outline is about the centroid, source px; `scale`
    that of the picture over the source.  `planned_deg` is the angle to begin with, if any.  All
    others are tried as well, but one that is far from it is taken only if it is clearly better:
    some stones look the same upside down.
    """
    rows, cols = np.nonzero(seen)
    x, y = float(cols.mean()) + 0.5, len(seen) - float(rows.mean()) - 0.5
    shape = np.asarray(outline * scale)
    reach = float(np.hypot(*shape.T).max())

    def misfit(pose: Fit) -> float:
        """Return the sum, over the picture, of squares of what is covered less what is seen."""
        shares, left, bottom = coverage(turn(shape, pose[2]) + pose[:2])
        inside, part = windows(seen.shape, shares.shape, len(seen) - bottom - len(shares), left)
        shares = shares[part]
        both = float(shares[seen[inside]].sum())
        return len(rows) + float((shares * shares).sum()) - 2.0 * both

    angles = np.arange(0.0, 360.0, COARSE_DEG).tolist()
    coarse = min(angles, key=lambda angle: misfit((x, y, angle)))
    first = coarse if planned_deg is None else planned_deg
    best = _refined(misfit, (x, y, first), reach)
    if abs(wrap_deg(coarse - first)) > COARSE_DEG:
        other = _refined(misfit, (x, y, coarse), reach)
        best = other if other[0] < SHARPER * best[0] else best
    _, (x, y, angle) = best
    return MeasuredPlace(x / scale, y / scale, wrap_deg(angle))


def _refined(misfit: Callable[[Fit], float], pose: Fit, reach: float) -> tuple[float, Fit]:
    """Go down from a pose along x, y and the angle, with steps that get shorter."""
    least = misfit(pose)
    step = 8.0 * FIRST_STEP
    while step > LAST_STEP:
        sizes = (min(step, FIRST_STEP), min(step, FIRST_STEP), math.degrees(step / reach))
        better = False
        for axis, size in enumerate(sizes):
            for signed in (size, -size):
                moved = list(pose)
                moved[axis] += signed
                there = (moved[0], moved[1], moved[2])
                value = misfit(there)
                if value < least:
                    least, pose, better = value, there, True
                    break
        if not better:
            step /= 2.0
    return least, pose


def _scale_of(labels: NDArray[np.integer], site: Site) -> float:
    """Return the resolution of a picture of the wall over that of the source (E196)."""
    width, height = site.extent_px
    sizes = {
        (working_px(height, 1.0), working_px(width, 1.0)): 1.0,
        (site.height_px, site.width_px): site.scale,
    }
    if labels.ndim == 2 and np.issubdtype(labels.dtype, np.integer) and labels.shape in sizes:
        return sizes[labels.shape]
    said = " or ".join(f"{h} rows x {w} columns" for h, w in dict.fromkeys(sizes))
    raise InputError(
        "E196",
        f"an array of {' x '.join(map(str, labels.shape))} {labels.dtype} is not a picture of the "
        "ids of the wall.",
        where="observe",
        cure=f"Give whole numbers, {said}: the whole wall at the source or working resolution, "
        "row 0 at the top.",
    )


def _expected(wall: Wall, scale: float) -> Labels:
    """Return the picture of the wall as it was planned, at a resolution."""
    site = wall.site
    if scale == site.scale:
        return wall.labels
    width, height = site.extent_px
    labels = np.zeros((working_px(height, scale), working_px(width, scale)), np.uint32)
    for placement in wall.placements:
        x, y = placement.centroid(site.height_px)
        at = placement.posed.angle_deg, x / site.scale, y / site.scale
        corners = settled_at(placement.posed.stone.outline, *at).corners
        shares, left, bottom = coverage(corners * scale)
        top = len(labels) - bottom - len(shares)
        inside, part = windows(labels.shape, shares.shape, top, left)
        labels[inside][shares[part] >= 0.5] = placement.stone_id
    return labels


def _require_seen(stone: Stone, seen_px: float) -> None:
    """Raise InputError (E197) when much of a stone is not to be seen, or more than there is."""
    # A hole that is kept is shown or not.
    share = seen_px / min(max(seen_px, stone.area_px), int(stone.solid.sum()))
    if SEEN[0] <= share <= SEEN[1]:
        return
    what = f"stone {stone.id} has {100 * share:.0f} % of its area in the picture."
    cure = "Give a picture of all of it, or set its pixels to 0 when it has fallen."
    raise InputError("E197", what, where="observe", cure=cure)
