"""Poses against SciPy's rotations and by hand."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drystone.model.frames3d import photo_pose, wall_pose

ANGLES = [-180.0, -135.3, -90.0, -12.5, 0.0, 1e-7, 33.0, 90.0, 179.9]


def rotation(pose):
    turn = pose.quaternion
    return Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])


@pytest.mark.parametrize("angle_deg", ANGLES)
def test_quaternion_and_matrix_are_one_turn_and_never_a_mirror(angle_deg):
    for pose in (wall_pose(1.2, 0.4, 0.3, angle_deg), photo_pose(2.0, 1.0, 0.3)):
        assert pose.rotation == pytest.approx(rotation(pose).as_matrix(), abs=1e-14)
        assert np.linalg.det(pose.rotation) == pytest.approx(1.0, abs=1e-14)
        assert pose.matrix[3].tolist() == [0.0, 0.0, 0.0, 1.0]
        assert pose.matrix[:3, 3].tolist() == [pose.x_m, pose.y_m, pose.z_m]
        axes = np.column_stack([pose.xaxis, pose.yaxis, pose.zaxis])
        assert (axes == pose.rotation).all()
