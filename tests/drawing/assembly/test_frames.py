"""Poses against SciPy's rotations and by hand."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from drystone.model.frames3d import Pose3d, photo_pose, wall_pose

ANGLES = [-180.0, -135.3, -90.0, -12.5, 0.0, 1e-7, 33.0, 90.0, 179.9]


def rotation(pose: Pose3d) -> Rotation:
    turn = pose.quaternion
    return Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])


@pytest.mark.parametrize("angle_deg", ANGLES)
def test_quaternion_and_matrix_are_one_turn_and_never_a_mirror(angle_deg: float) -> None:
    for pose in (wall_pose(1.2, 0.4, 0.3, angle_deg), photo_pose(2.0, 1.0, 0.3)):
        assert pose.rotation == pytest.approx(rotation(pose).as_matrix(), abs=1e-14)
        assert np.linalg.det(pose.rotation) == pytest.approx(1.0, abs=1e-14)
        assert pose.matrix[3].tolist() == [0.0, 0.0, 0.0, 1.0]
        assert pose.matrix[:3, 3].tolist() == [pose.x_m, pose.y_m, pose.z_m]
        axes = np.column_stack([pose.xaxis, pose.yaxis, pose.zaxis])
        assert (axes == pose.rotation).all()


@pytest.mark.parametrize("angle_deg", ANGLES)
def test_counter_clockwise_from_the_front_is_a_turn_by_minus_the_angle_about_y(
    angle_deg: float,
) -> None:
    found = wall_pose(0.0, 0.0, 0.2, angle_deg).rotation
    about_y = Rotation.from_rotvec([0.0, -np.radians(angle_deg), 0.0])
    assert found == pytest.approx(about_y.as_matrix(), abs=1e-14)
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    assert found[:, 0] == pytest.approx([cos, 0.0, sin], abs=1e-14)


def test_a_part_stands_behind_the_front_face() -> None:
    matrix = wall_pose(1.0, 0.5, 0.2, 30.0).matrix
    front, back = (matrix @ [0.0, y, 0.0, 1.0] for y in (-0.1, 0.1))
    assert front.tolist() == pytest.approx([1.0, 0.0, 0.5, 1.0])
    assert back.tolist() == pytest.approx([1.0, 0.2, 0.5, 1.0])


def test_in_the_photo_the_front_face_is_up() -> None:
    pose = photo_pose(0.7, 0.3, 0.2)
    assert pose.xaxis == (1.0, 0.0, 0.0)
    assert pose.zaxis == (0.0, 1.0, 0.0)
    assert pose.yaxis == (0.0, 0.0, -1.0)
    front = pose.matrix @ [0.0, -0.1, 0.0, 1.0]
    assert front.tolist() == pytest.approx([0.7, 0.3, 0.2, 1.0])
