"""What a camera makes of the ground: perspective, blur, noise, a file."""

import io
import math

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage
from skimage.transform import warp

from drystone_lab.photographs.level import Level
from drystone_lab.photographs.texture import Light

Homography = NDArray[np.float64]
"""(3, 3); maps points (x, y, 1), y down, px."""

FOCAL = 1.2
"""Focal length over the width of the photograph: of a phone."""

_TURNS = {
    2: Image.Transpose.FLIP_LEFT_RIGHT, 3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM, 5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_90, 7: Image.Transpose.TRANSVERSE, 8: Image.Transpose.ROTATE_270,
}  # fmt: skip
"""How a picture is stored that a viewer turns back for its EXIF orientation."""


def inverse(homography: Homography) -> Homography:
    """Return the way back."""
    return np.asarray(np.linalg.inv(homography), np.float64)


def view_of(level: Level) -> tuple[Homography, tuple[int, int]]:
    """Return the homography from the ground to the photograph, and the ground that is seen.

    Returns
    -------
    homography : (3, 3) float array
        Ground px to photograph px.
    shape : (int, int)
        Height and width of the ground that holds all that the camera sees, px.
    """
    focal = FOCAL * level.width_px
    tilt, turn = math.radians(level.tilt_deg), math.radians(level.turn_deg)
    spin = np.array(
        [[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    look = np.array([[focal, 0, 0], [0, focal * math.cos(tilt), 0], [0, -math.sin(tilt), focal]])
    middle = np.array([[1, 0, level.width_px / 2], [0, 1, level.height_px / 2], [0, 0, 1]])
    centred = middle @ look @ spin
    corners = moved(inverse(centred), frame_corners(level))
    low, high = np.floor(corners.min(axis=0)), np.ceil(corners.max(axis=0))
    shift = np.array([[1, 0, low[0]], [0, 1, low[1]], [0, 0, 1]])
    width, height = (int(side) for side in high - low)
    return centred @ shift, (height, width)


def frame_corners(level: Level) -> NDArray[np.float64]:
    """Return the corners of the photograph, (4, 2), in turn."""
    width, height = level.width_px, level.height_px
    return np.array([[0, 0], [width, 0], [width, height], [0, height]], float)


def moved(homography: Homography, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Map points (n, 2).

    Examples
    --------
    >>> moved(np.diag([2.0, 2.0, 1.0]), np.array([[1.0, 3.0]])).tolist()
    [[2.0, 6.0]]
    """
    mapped = np.column_stack([points, np.ones(len(points))]) @ homography.T
    return np.asarray(mapped[:, :2] / mapped[:, 2:])


def exposed(ground: Light, homography: Homography, level: Level, rng: Generator) -> bytes:
    """Return the JPEG that a camera makes of a lit ground."""
    shape = (level.height_px, level.width_px)
    # Centres of px lie at halves in the homography and at whole numbers in `warp`.
    half = np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])
    back = np.linalg.inv(half) @ np.linalg.inv(homography) @ half
    planes = [
        warp(ground[..., k], back, output_shape=shape, order=1, mode="edge", preserve_range=True)
        for k in range(3)
    ]
    seen = [ndimage.gaussian_filter(plane, level.blur_px) for plane in planes]
    light = np.clip(np.stack(seen, axis=-1), 0, 1)
    grey = 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    grey += rng.normal(0, level.noise, grey.shape)
    picture = Image.fromarray(np.clip(np.rint(grey), 0, 255).astype(np.uint8))
    if level.orientation != 1:
        picture = picture.transpose(_TURNS[level.orientation])
    exif = Image.Exif()
    exif[0x0112] = level.orientation
    file = io.BytesIO()
    picture.save(file, "JPEG", quality=level.quality, exif=exif)
    return file.getvalue()
