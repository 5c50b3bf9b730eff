"""How a photograph shows the ground."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.errors import InputError, Notice
from drystone.photo.markers import load_cv2

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
"""Corners of a unit square, clockwise with y down; times a size those of a picture."""


@dataclass(frozen=True, eq=False)
class View:
    """From px of a photograph to metres on the ground."""

    # (3, 3) homography: photo px (x to the right, y down, a pixel is a unit square with its centre
    # at +0.5) to metres on the ground (x to the right, y down as the picture shows it).  Never
    # mirrored; w > 0 in front of the horizon.
    photo_to_ground: NDArray[np.float64]
    # In the middle of the photograph: what a rectified picture needs to be as fine as that.
    px_per_m: float
    ids: tuple[int, ...]  # markers that it was made from
    # Root mean square distance, on the ground, of the marker corners from where they should be.
    residual_mm: float
    residual_percent: float  # the same in percent of the side of a marker
    notices: tuple[Notice, ...]  # markers that were left out (W170, W171), doubts (W172)


def apply(
    homography: NDArray[np.floating[Any]], points: NDArray[np.floating[Any]]
) -> NDArray[np.float64]:
    """Move (n, 2) points by a (3, 3) homography."""
    moved = np.column_stack([points, np.ones(len(points))]) @ homography.T
    return np.asarray(moved[:, :2] / moved[:, 2:], dtype=np.float64)


def depth(homography: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return w of points: it changes its sign at the horizon, where they would be endlessly far."""
    return np.asarray(points @ homography[2, :2] + homography[2, 2], dtype=np.float64)


def jacobian(homography: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (2, 2) derivative of a homography at a point."""
    w = float(depth(homography, point[None])[0])
    moved = apply(homography, point[None])[0]
    return np.asarray((homography[:2, :2] - np.outer(moved, homography[2, :2])) / w)


MAX_STRETCH = 10.0
"""How many times coarser the farthest px of a photograph may be than the nearest."""


class Rectified(NamedTuple):
    """A picture of the ground as a camera far above would take it."""

    picture: NDArray[np.uint8]  # (h, w, 3): black where the photograph shows nothing
    px_per_m: float
    inside: NDArray[np.bool_]  # (h, w): where the photograph shows something
    from_photo: NDArray[np.float64]  # (3, 3): homography from photo px to px of the picture


def rectify(image: NDArray[np.uint8], view: View, max_px: int) -> Rectified:
    """Turn a photograph into the picture that a camera far above would take; it shows all of it.

    It is as fine as the view says, or less where `max_px` would be exceeded.
    """
    height, width = image.shape[:2]
    corners = apply(view.photo_to_ground, SQUARE * (width, height))
    low = corners.min(axis=0)
    extent = corners.max(axis=0) - low
    scale = min(view.px_per_m, math.sqrt(max_px / (extent[0] * extent[1])))
    moved = np.array([[scale, 0, -scale * low[0]], [0, scale, -scale * low[1]], [0, 0, 1]])
    across, down = (max(1, math.ceil(side * scale - 1e-6)) for side in extent)
    from_photo = moved @ view.photo_to_ground
    cv2 = load_cv2()
    # OpenCV puts 0 at the centre of the first pixel, here it is at its corner.
    half = np.array([[1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
    by = np.linalg.inv(half) @ from_photo @ half
    shown = without_bands(image).astype(np.uint8)
    finer = float(np.abs(np.linalg.det(jacobian(from_photo, np.array([width, height]) / 2.0))))
    if finer < 0.5:
        # Px of the photograph between the samples would be skipped, and thin gaps with them.
        blur = 0.5 * math.sqrt(1.0 / finer - 1.0)
        image = cv2.GaussianBlur(image, (0, 0), blur)
    size, beyond = (across, down), cv2.BORDER_REPLICATE
    values = cv2.warpPerspective(image, by, size, flags=cv2.INTER_LINEAR, borderMode=beyond)
    inside = np.asarray(cv2.warpPerspective(shown, by, size, flags=cv2.INTER_NEAREST)) > 0
    values[~inside] = 0
    return Rectified(np.asarray(values, dtype=np.uint8), scale, inside, from_photo)


def without_bands(image: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return all but bands of one colour along the edges, beyond which most has another one."""
    within, bands = np.ones(image.shape[:2], bool), []
    for turns in range(4):
        rows = np.rot90(image, turns)
        step = 1 + rows.shape[1] // 500
        away = rows[:, ::step].astype(np.int16)
        away = np.abs(away - away[0, 0]).max(axis=-1)
        end = int((np.median(away, axis=1) > 16).argmax())
        even = away[: end // 2 + 1] <= 3  # blocks of a JPEG blur the end of a band
        if even.mean() > 0.98 and np.median(away[end:]) > 16:
            np.rot90(within, turns)[:end] = False
            bands.append((turns, end, step, ndimage.label(away <= 16)[0]))
    shown = np.ones_like(within)
    for turns, end, step, alike in bands:
        # A band ends along its whole side.  Ground goes on between stones that lie close, and is a
        # tenth of what they cover even where they nearly touch.
        beyond = alike[np.rot90(within, turns)[:, ::step]]
        if (beyond == alike[0, 0]).mean() < 0.03:
            np.rot90(shown, turns)[:end] = False
    return shown


def refuse_horizon(photo_to_ground: NDArray[np.float64], size_px: tuple[int, int]) -> None:
    """Refuse a view with the horizon, or almost, inside the photograph (E173)."""
    corners = SQUARE * size_px
    seen = bool((depth(photo_to_ground, corners) > 0).all())
    if seen:
        areas = [abs(np.linalg.det(jacobian(photo_to_ground, corner))) for corner in corners]
        seen = max(areas) <= MAX_STRETCH**2 * min(areas)
    if not seen:
        raise InputError(
            "E173",
            "the photograph was taken at so flat an angle that the far end of the ground, or the "
            "horizon, is in it; sizes there mean nothing.",
            cure="Photograph the stones from above, or crop what is far away.",
        )
