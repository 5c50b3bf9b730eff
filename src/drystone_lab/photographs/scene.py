"""A test photograph: stones on a ground, lit, and the truth about them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy import ndimage
from skimage.draw import polygon2mask

from drystone_lab.photographs.camera import (
    Homography,
    exposed,
    frame_corners,
    inverse,
    moved,
    view_of,
)
from drystone_lab.photographs.layout import Labels, lay_stones
from drystone_lab.photographs.level import Level
from drystone_lab.photographs.sheets import place_markers
from drystone_lab.photographs.texture import (
    Light,
    Plane,
    clouds,
    ground_surface,
    stone_face,
)

HEIGHT = 0.4
"""Height of a stone over the square root of its area."""

SKY = (0.92, 1.0, 1.12)
"""Colour of the light in a shadow: it comes from the sky."""


@dataclass(frozen=True, eq=False)
class Photograph:
    """A rendered photograph and the truth.

    Parameters
    ----------
    jpeg : bytes
        The file.
    truth : (h, w) uint16 array
        Stones 1 ... n in the frame of the ground.
    homography : (3, 3) float array
        Ground px to px of the photograph as it is seen.
    px_per_m : float
        Ground px in a metre.
    touching : tuple of (int, int)
        Stones that touch.
    level : Level
        What was asked for.
    """

    jpeg: bytes
    truth: Labels
    homography: Homography
    px_per_m: float
    touching: tuple[tuple[int, int], ...]
    level: Level

    def truth_in(self, to_photo: Homography, shape: tuple[int, int]) -> Labels:
        """Return the true stones in another frame, such as that of a label image."""
        rows, cols = np.indices(shape)
        points = np.column_stack([cols.ravel() + 0.5, rows.ravel() + 0.5])
        ground = moved(inverse(self.homography) @ to_photo, points)
        where = np.floor(ground).astype(int)
        inside = ((where >= 0) & (where < self.truth.shape[::-1])).all(axis=1)
        where[~inside] = 0
        found = np.where(inside, self.truth[where[:, 1], where[:, 0]], 0)
        return found.reshape(shape).astype(np.uint16)


def photograph(level: Level) -> Photograph:
    """Render a photograph."""
    rng = np.random.default_rng(level.seed)
    homography, shape = view_of(level)
    corners = moved(inverse(homography), frame_corners(level))
    seen = polygon2mask(shape, corners[:, ::-1])
    surface = ground_surface(level.ground, shape, rng)
    markers = place_markers(level, surface, seen)
    layout = lay_stones(level, markers, seen, rng)
    light = _light_on_ground(layout.labels, level, rng)
    lit = surface * light
    for number, box in enumerate(ndimage.find_objects(layout.labels), start=1):
        mask = layout.labels[box] == number
        rock = level.rocks[number % len(level.rocks)]
        face = stone_face(rock, mask.shape, rng) * _shading(mask, level)[..., None]
        lit[box][mask] = face[mask]
    lit *= _lamp(shape, level, rng)[..., None]
    jpeg = exposed(lit, homography, level, rng)
    return Photograph(jpeg, layout.labels, homography, level.px_per_m, layout.touching, level)


def _light_on_ground(labels: Labels, level: Level, rng: Generator) -> Light:
    """Return what reaches the ground, (h, w, 3): cast shadows, and a dim rim below the stones."""
    shadow = np.zeros(labels.shape, np.float32)
    azimuth = rng.uniform(0, 2 * math.pi)
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        mask = labels[box] == number
        long = HEIGHT * math.sqrt(mask.sum()) / math.tan(math.radians(level.sun_deg))
        pad = int(long) + 12
        here = np.zeros((mask.shape[0] + 2 * pad, mask.shape[1] + 2 * pad), bool)
        for step in np.arange(0, long, 1.0):
            top = pad + round(step * math.sin(azimuth))
            left = pad + round(step * math.cos(azimuth))
            here[top : top + mask.shape[0], left : left + mask.shape[1]] |= mask
        _add(shadow, here, box[0].start - pad, box[1].start - pad)
    shadow = ndimage.gaussian_filter(shadow, 2.5) * np.float32(level.shadow)
    near = ndimage.distance_transform_edt(labels == 0)
    rim = np.exp(-near / 3.0) * (0.25 if level.shadow else 0.08)
    sky = np.array(SKY, np.float32)
    dark = shadow[..., None]
    light = (1 - dark) + dark * (sky - 1) * (1 - level.shadow)
    return np.asarray(light * (1 - rim[..., None]), np.float32)


def _add(whole: Plane, part: NDArray[np.bool_], row: int, col: int) -> None:
    """Mark a part of a picture that may reach beyond it."""
    top, left = max(row, 0), max(col, 0)
    area = whole[top : row + part.shape[0], left : col + part.shape[1]]
    np.maximum(area, part[top - row :, left - col :][: area.shape[0], : area.shape[1]], out=area)


def _shading(mask: NDArray[np.bool_], level: Level) -> Plane:
    """Return how bright a domed stone is: its rim turns away from the light."""
    depth = ndimage.distance_transform_edt(np.pad(mask, 1))[1:-1, 1:-1]
    dome = np.sqrt(np.clip(1 - (1 - np.clip(depth / max(depth.max(), 1), 0, 1)) ** 2, 0, 1))
    side = 0.10 + 0.25 * level.shadow
    return np.asarray(1 - side * (1 - dome), np.float32)


def _lamp(shape: tuple[int, int], level: Level, rng: Generator) -> Plane:
    """Return uneven light over the whole picture: a slope and a bright spot, 1 at most."""
    if not level.uneven:
        return np.ones(shape, np.float32)
    rows, cols = np.indices(shape, np.float32) / max(shape)
    angle = rng.uniform(0, 2 * math.pi)
    slope = rows * math.sin(angle) + cols * math.cos(angle)
    spot = -((rows - rng.uniform(0.2, 0.6)) ** 2 + (cols - rng.uniform(0.3, 0.7)) ** 2)
    light = slope + 1.5 * spot + 0.03 * clouds(shape, [(max(shape) / 2, max(shape) / 2)], rng)
    light = (light - light.min()) / (light.max() - light.min())
    return np.asarray(1 - level.uneven * (1 - light), np.float32)
