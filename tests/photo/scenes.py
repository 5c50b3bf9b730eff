"""Photographs of markers by a camera of which all is known."""

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

from drystone.photo.view import apply
from drystone_lab.photographs.rendered import PhotoLevel

SMALL = PhotoLevel(
    name="small", count=6, width_px=480, height_px=360, px_per_m=400.0, gap_px=10, markers="none"
)
"""Some stones on a ground."""

BITS = {
    "aruco": (cv2.aruco.DICT_4X4_50, 6),
    "apriltag": (cv2.aruco.DICT_APRILTAG_36h11, 8),
    "aruco5x5": (cv2.aruco.DICT_5X5_100, 7),
    "aruco6x6": (cv2.aruco.DICT_6X6_250, 8),
    "aruco7x7": (cv2.aruco.DICT_7X7_50, 9),
    "original": (cv2.aruco.DICT_ARUCO_ORIGINAL, 7),
    "mip36h12": (cv2.aruco.DICT_ARUCO_MIP_36h12, 8),
    "apriltag25h9": (cv2.aruco.DICT_APRILTAG_25h9, 7),
    "apriltag36h10": (cv2.aruco.DICT_APRILTAG_36h10, 8),
    "apriltag16h5": (cv2.aruco.DICT_APRILTAG_16h5, 6),
}


def camera(focal_px, size_px, *, tilt_deg=0.0, turn_deg=0.0, distance_m=1.0):
    """Ground (x to the right, y down, metres; 0, 0 in the middle of the photo) to photo px."""
    turned = Rotation.from_euler("XZ", [tilt_deg, turn_deg], degrees=True)
    inside = np.array([[focal_px, 0, size_px[0] / 2], [0, focal_px, size_px[1] / 2], [0, 0, 1]])
    across, down, _ = turned.as_matrix().T
    return inside @ np.column_stack([across, down, [0, 0, distance_m]])


def outline(angle_deg, x, y, side):
    """Corners of a marker on the ground, as printed clockwise from its upper left."""
    cos, sin = np.cos(np.deg2rad(angle_deg)), np.sin(np.deg2rad(angle_deg))
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * side
    return square @ np.array([[cos, sin], [-sin, cos]]) + (x, y)


def photograph(to_photo, size_px, placed, *, dictionary="aruco", blur_px=0.7):
    """Render markers on grey ground; each px is the mean of 2 x 2 samples.

    `placed` has (id, angle_deg, x, y, side) for each marker: metres, upper left corner.
    """
    family, across = BITS[dictionary]
    family = cv2.aruco.getPredefinedDictionary(family)
    (width, height), module, edge = size_px, 20, 26  # px of the paper
    shown = np.full((height * 2, width * 2), 105.0, np.float32)
    # Of cv2 the centres of pixels have whole coordinates.
    finely = np.array([[2, 0, -0.5], [0, 2, -0.5], [0, 0, 1]])
    for marker_id, angle, x, y, side in placed:
        bits = cv2.aruco.generateImageMarker(family, marker_id, across * module)
        paper = np.pad(np.where(bits > 127, 225.0, 35.0), edge, constant_values=225.0)
        origin, right, _, down = outline(angle, x, y, side / (across * module))
        to_ground = np.eye(3)
        to_ground[:2] = np.column_stack([right - origin, down - origin, origin])
        centres = np.array([[1, 0, 0.5 - edge], [0, 1, 0.5 - edge], [0, 0, 1]])
        cv2.warpPerspective(
            paper.astype(np.float32), finely @ to_photo @ to_ground @ centres, shown.shape[::-1],
            shown, cv2.INTER_NEAREST, cv2.BORDER_TRANSPARENT,
        )  # fmt: skip
    light = ((shown / 255.0 + 0.055) / 1.055) ** 2.4  # linear, as a lens blurs it
    light = cv2.GaussianBlur(light.reshape(height, 2, width, 2).mean(axis=(1, 3)), (0, 0), blur_px)
    shown = 255.0 * (1.055 * light ** (1 / 2.4) - 0.055)
    shown += np.random.default_rng(5).normal(0.0, 3.0, shown.shape)
    return np.repeat(np.clip(np.round(shown), 0, 255).astype(np.uint8)[..., None], 3, axis=2)


def distance_error_percent(view, to_photo, width_m, height_m):
    """Largest error of distances between nine points of the ground, percent."""
    points = np.array([[x, y] for x in (-1, 0, 1) for y in (-1, 0, 1)]) * (width_m, height_m) / 2
    found = apply(view.photo_to_ground, apply(to_photo, points))
    one, other = np.triu_indices(len(points), 1)
    true = np.linalg.norm(points[one] - points[other], axis=1)
    return 100.0 * np.abs(np.linalg.norm(found[one] - found[other], axis=1) / true - 1.0).max()
