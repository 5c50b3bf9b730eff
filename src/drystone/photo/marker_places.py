"""Where the markers of a photograph are in P, the frame of the picture from above.

A robot that sees a marker knows by this where P is (drystone.model.frames3d).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.model.frames3d import Pose3d, Quaternion
from drystone.photo.common_plane import rigid
from drystone.photo.layout import MarkerLayout
from drystone.photo.markers import FoundMarker
from drystone.photo.view import apply


@dataclass(frozen=True, eq=False)
class PlacedMarker:
    """A marker in P: corners (4, 2) in metres, y up, from the upper left of its print, clockwise.

    The pose is that of its frame: the origin in its middle, X to the right and Y up in its print, Z
    out of it, as OpenCV has it.  All markers that were seen of its sheet say where that is.
    """

    id: int
    corners_m: NDArray[np.float64]
    pose: Pose3d


def placed_markers(
    markers: Sequence[FoundMarker],
    layout: MarkerLayout,
    from_photo: NDArray[np.float64],
    px_per_m: float,
    height_px: int,
) -> tuple[PlacedMarker, ...]:
    """Place markers of a photograph in P, by their ids.

    `from_photo` leads from px of the photograph to those of the picture from above.
    """
    flip, top = np.array([1.0, -1.0]), np.array([0.0, height_px / px_per_m])
    ordered = sorted(markers, key=lambda marker: marker.id)
    seen = {one.id: apply(from_photo, one.corners_px) / px_per_m * flip + top for one in ordered}
    printed = {one: layout.corners_m(one) * flip for one in seen}
    placed = []
    for one, corners in seen.items():
        paper = [other for other in seen if layout.group(other) == layout.group(one)]
        on_paper, in_p = (np.concatenate([of[i] for i in paper]) for of in (printed, seen))
        turn, shift = rigid(on_paper, in_p)
        x, y = (turn @ printed[one].mean(axis=0) + shift).tolist()
        half = math.atan2(turn[1, 0], turn[0, 0]) / 2.0
        pose = Pose3d(x, y, 0.0, Quaternion(0.0, 0.0, math.sin(half), math.cos(half)))
        placed.append(PlacedMarker(one, corners, pose))
    return tuple(placed)
