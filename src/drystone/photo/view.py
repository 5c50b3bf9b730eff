"""How a photograph shows the ground."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drystone.errors import Notice

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
    ids: tuple[int, ...] = ()  # markers that it was made from; empty for a scale that was given
    # Root mean square distance, on the ground, of the marker corners from where they should be;
    # None for a scale that was given.
    residual_mm: float | None = None
    residual_percent: float | None = None  # the same in percent of the side of a marker
    notices: tuple[Notice, ...] = ()  # markers that were left out (W170, W171), doubts (W172)

    @classmethod
    def flat(cls, px_per_m: float) -> "View":
        """Return the view from straight above: a scale, and nothing to be warped."""
        return cls(np.diag([1.0 / px_per_m, 1.0 / px_per_m, 1.0]), float(px_per_m))

    @property
    def is_flat(self) -> bool:
        """True when the photograph needs no warping: a scale was given."""
        return not self.ids

    def to_ground(self, points_px: NDArray[np.float64] | list[list[float]]) -> NDArray[np.float64]:
        """Return where (n, 2) points of the photograph are on the ground, metres."""
        return apply(self.photo_to_ground, np.asarray(points_px, dtype=np.float64))


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
