"""Corners of a marker as the meeting points of its edges, each measured along its length.

Where two edges meet, blur rounds the corner off, and what looks for the corner itself finds it too
far inside: the marker then reads small and the scale with it.  Edges are not moved by blur.
"""

import numpy as np
from numpy.typing import NDArray

from drystone.photo.dictionaries import load_cv2

Points = NDArray[np.float64]

_ALONG = np.linspace(0.1, 0.9, 81)
"""Places along an edge: not near the corners, which are rounded."""

_ACROSS = np.linspace(-1.0, 1.0, 41)
"""Places across an edge, in reaches: from the black border to the white one."""

_REACHES_PX = (2.0, 10.0)
"""Least and largest reach: farther off, samples would be more than half a px apart."""

_LEAST_CONTRAST = 8.0


def corners_by_edges(grey: NDArray[np.uint8], corners_px: Points, modules: int) -> Points | None:
    """Measure where the four edges of a marker meet.

    Parameters
    ----------
    grey : (h, w) uint8 array
        The photograph.
    corners_px : (4, 2) float array
        Corners to within a third of a square of the pattern, clockwise; pixel centres at +0.5.
    modules : int
        Squares of the pattern along an edge.

    Returns
    -------
    corners : (4, 2) float array or None
        None when an edge cannot be measured: little contrast, or no straight line.
    """
    corners = corners_px
    for _ in range(2):
        lines = [_edge(grey, np.roll(corners, -i, axis=0), modules) for i in range(4)]
        found = [line for line in lines if line is not None]
        if len(found) < 4:
            return None
        corners = np.array([_meeting(found[i - 1], found[i]) for i in range(4)])
        sides = np.hypot(*(corners_px - np.roll(corners_px, 1, axis=0)).T)
        if not (np.hypot(*(corners - corners_px).T) < sides.min() / modules / 2).all():
            return None
    return corners


def _edge(grey: NDArray[np.uint8], corners: Points, modules: int) -> tuple[Points, Points] | None:
    """Return a point and the direction of the first edge; None when it is no straight edge."""
    start, end = corners[:2]
    along = (end - start) / float(np.hypot(*(end - start)))
    # Clockwise as printed and never mirrored: with y down, outside is to the left.
    outward = np.array([along[1], -along[0]])
    # Squares are foreshortened: what counts is how wide they are across this edge.
    width = -float(((corners[2:] - start) @ outward).mean()) / modules
    reach = float(np.clip(0.7 * width, *_REACHES_PX))
    places = start + _ALONG[:, None] * (end - start)
    at = places[:, None, :] + reach * _ACROSS[:, None] * outward
    cv2 = load_cv2()
    seen = cv2.remap(
        grey,
        (at[..., 0] - 0.5).astype(np.float32),
        (at[..., 1] - 0.5).astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    ).astype(np.float64)
    # Lenses blur light, not the grey values of sRGB, in which black squares would seem smaller.
    offset = _offsets(255.0 * ((seen / 255.0 + 0.055) / 1.055) ** 2.4)
    if offset is None:
        return None
    return _line(places + reach * offset[:, None] * outward)


def _offsets(seen: Points) -> Points | None:
    """Return where each profile, dark to bright, has its step, in reaches from its middle."""
    ends = len(_ACROSS) // 5
    # Light changes along an edge, but slowly.
    dark = np.polyval(np.polyfit(_ALONG, seen[:, :ends].mean(axis=1), 1), _ALONG)
    bright = np.polyval(np.polyfit(_ALONG, seen[:, -ends:].mean(axis=1), 1), _ALONG)
    if not (bright - dark > _LEAST_CONTRAST).all():
        return None
    share = (seen - dark[:, None]) / (bright - dark)[:, None]
    return np.asarray(1.0 - np.trapezoid(share, _ACROSS, axis=1))


def _line(points: Points) -> tuple[Points, Points] | None:
    """Return a point and the direction of the line through points, without the odd ones."""
    keep = np.ones(len(points), dtype=bool)
    middle, direction = points.mean(axis=0), np.zeros(2)
    for _ in range(3):
        middle = points[keep].mean(axis=0)
        direction = np.linalg.svd(points[keep] - middle)[2][0]
        off = np.abs((points - middle) @ np.array([-direction[1], direction[0]]))
        keep = off <= max(3.0 * float(np.median(off)), 0.1)
        if keep.sum() < len(points) / 2:
            return None
    return middle, direction


def _meeting(one: tuple[Points, Points], other: tuple[Points, Points]) -> Points:
    matrix = np.column_stack([one[1], -other[1]])
    if abs(np.linalg.det(matrix)) < 1e-6:
        return np.full(2, np.nan)
    return np.asarray(one[0] + np.linalg.solve(matrix, other[0] - one[0])[0] * one[1])
