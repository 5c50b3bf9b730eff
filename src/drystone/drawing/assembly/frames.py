"""Frames of the world, once for all outputs: those of :mod:`drystone.model.frames3d`."""

from drystone.model.frames3d import (
    DOWN,
    Matrix,
    Pose3d,
    Quaternion,
    Vector,
    photo_pose,
    wall_pose,
)

__all__ = ["DOWN", "Matrix", "Pose3d", "Quaternion", "Vector", "photo_pose", "wall_pose"]
