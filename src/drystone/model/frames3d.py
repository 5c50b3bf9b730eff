"""Frames of the world, once for planner and outputs: metres, right-handed, named quaternions.

- **Wall** W: X along the wall to the right, Y into it, Z up; the origin is the bottom-left-front
  corner.  Stones lie between y = 0, the front face, and y = thickness.
- **Photo** P: X to the right and Y up in the picture that stones were read from, Z out of it,
  towards the camera; the origin is the bottom-left corner of the picture, on the ground that the
  stones lie on.
- **Part** S: the origin is the centroid of the solid; its axes are those of W when the part is
  not turned.  A stone that lies on its back under the camera shows its front face: its X is X of
  P, its Z is Y of P, and its Y points into the ground.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.errors import UsageError

Matrix = NDArray[np.float64]
Vector = tuple[float, float, float]

DOWN: Vector = (0.0, 0.0, -1.0)
"""How a tool approaches a part, in W and in P: from above."""


@dataclass(frozen=True)
class Quaternion:
    """A turn, by its ROS message field names; never a bare list, whose order nobody knows."""

    x: float
    y: float
    z: float
    w: float


@dataclass(frozen=True)
class Pose3d:
    """Where a part is: its frame in another one.

    Parameters
    ----------
    x_m, y_m, z_m : float
        Origin, metres.
    quaternion : Quaternion
        Turn, of length 1.

    Examples
    --------
    >>> wall_pose(1.0, 0.5, 0.2, 90.0).xaxis
    (0.0, 0.0, 1.0)
    """

    x_m: float
    y_m: float
    z_m: float
    quaternion: Quaternion

    @property
    def rotation(self) -> Matrix:
        """(3, 3) array whose columns are the axes."""
        q = self.quaternion
        x, y, z, w = q.x, q.y, q.z, q.w
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        # Turns by quarters are exact: their zeros are no rounding errors.
        return np.where(np.abs(turn - np.rint(turn)) < 1e-15, np.rint(turn), turn) + 0.0

    @property
    def matrix(self) -> Matrix:
        """(4, 4) homogeneous transform, part to the frame that the pose is in."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.rotation
        matrix[:3, 3] = self.x_m, self.y_m, self.z_m
        return matrix

    @property
    def xaxis(self) -> Vector:
        """Direction of the part's X."""
        return _vector(self.rotation[:, 0])

    @property
    def yaxis(self) -> Vector:
        """Direction of the part's Y."""
        return _vector(self.rotation[:, 1])

    @property
    def zaxis(self) -> Vector:
        """Direction of the part's Z."""
        return _vector(self.rotation[:, 2])


def wall_pose(x_m: float, z_m: float, thickness_m: float, angle_deg: float) -> Pose3d:
    """Return where a part stands in a wall of some thickness.

    It is turned counter-clockwise as seen from the front.  Who looks at the front looks along +Y,
    so this is a turn by -angle_deg about +Y.
    """
    half = math.radians(angle_deg) / 2.0
    turn = Quaternion(0.0, -math.sin(half), 0.0, math.cos(half))
    return Pose3d(x_m, _half(thickness_m), z_m, turn)


def photo_pose(x_m: float, y_m: float, thickness_m: float) -> Pose3d:
    """Return where a part of some thickness lies in the photo's frame (y up), its front face up."""
    half = math.sqrt(0.5)
    return Pose3d(x_m, y_m, _half(thickness_m), Quaternion(-half, 0.0, 0.0, half))


def _half(thickness_m: float) -> float:
    if not 0.0 <= thickness_m < math.inf:
        what = f"{thickness_m} is not a thickness."
        raise UsageError("E138", what, where="thickness_m", cure="Give 0 or more, in metres.")
    return thickness_m / 2.0


def metres_of(length_px: float, px_per_m: float | None) -> float:
    """Turn a length in source px into metres; UsageError (E131) where there is no scale."""
    if px_per_m is None:
        raise UsageError(
            "E131",
            "a pose is in metres, and this wall has no scale.",
            where="Site.px_per_m",
            cure="There are three ways to give one: --px-per-m 200, in Python Site(..., "
            "px_per_m=200); --ruler x1,y1,x2,y2=1.0m, a length in the source image; or stones "
            "from a photograph with markers (drystone markers, drystone segment).",
        )
    return length_px / px_per_m


def _vector(values: Matrix) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
