"""Cast shadows, which are not stone: ground with less light, all on one side of the stones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask
from drystone.photo.segment_ground import GroundModel

Vector = NDArray[np.float64]

_DARKEST, _LIGHTEST = -2.0, -0.06
"""Logarithm of the light in a shadow over that beside it."""

WINDOW_PX = 9
"""Where the roughness of a surface is measured."""

_LEAST_SHARE = 0.35
"""Share of the stones that must have a shadow, unless few agree well."""

_AGREEMENT = 0.7
"""How well they must agree on its side, 0 to 1."""

_FEW_AGREEMENT = 0.9
"""The same of three stones or more."""


@dataclass(frozen=True, eq=False)
class Shadows:
    """Shadows in a photograph."""

    mask: Mask  # (h, w) where they are
    level: float  # light in them over that beside them; 1 when there are none
    alike: Mask  # (h, w) what has the colour of shaded ground, shadow or not


def find_shadows(ground: GroundModel, foreground: Mask, usable: Mask) -> Shadows:
    """Tell shadows from stones.

    A px may be in a shadow when it has the colour of the ground with less light.  Such px are
    shadows when most of them have the same light, and lie on the same side of what cannot be
    shadow: a grey stone on grey ground has its own light, all round.

    `foreground` is what is not ground, `usable` what is ground, stone or shadow.
    """
    light = ground.log_light.mean(axis=-1)
    # Faint shadows are not far from the colour of the ground, but tell where the light is.
    noise = 1.48 * float(np.median(np.abs(light[~foreground & usable])))
    foreground = foreground | (usable & (light < -(0.1 + 3 * noise)))
    about = ~foreground & usable
    # Ground with less light: its colours are as far apart as the ground's.
    tint = np.abs(ground.log_light - light[..., None])
    own = 1.48 * float(np.median(tint[about], axis=0).max())
    tinted = foreground & (tint.max(axis=-1) < 0.05 + 0.12 * np.abs(light) + 2.5 * own)
    tinted &= (light > _DARKEST) & (light < _LIGHTEST)
    # Shaded ground is no rougher than lit.
    square = ndimage.uniform_filter(light**2, WINDOW_PX)
    rough = np.sqrt(np.maximum(square - ndimage.uniform_filter(light, WINDOW_PX) ** 2, 0))
    alike = tinted & (rough < 0.03 + 2.5 * float(np.median(rough[about])))
    none = Shadows(np.zeros_like(foreground), 1.0, alike)
    if alike.sum() < 50:
        return none
    width = 0.08 + 2.5 * noise
    counts, edges = np.histogram(light[alike], bins=80, range=(_DARKEST, 0.0))
    best = int(ndimage.gaussian_filter1d(counts.astype(float), 1.5).argmax())
    level = float(edges[best] + edges[best + 1]) / 2
    near = np.abs(light - level)
    body = ndimage.binary_opening(alike & (near < width), iterations=2)
    # Uneven light is known about, so a shadow may be a little lighter or darker in places.
    about_level = ndimage.binary_opening(alike & (near < width + 0.12), iterations=2)
    body = ndimage.binary_propagation(body & about_level, mask=about_level)
    around = _grown(body, WINDOW_PX + 3) & tinted & (light > level - width)
    sure = ndimage.binary_opening(foreground & ~around & ~body, iterations=3)
    direction = _direction(body, sure)
    if direction is None:
        return none
    # The soft edge of a shadow, on the side of the lit ground, has light of its own.
    depth = ndimage.distance_transform_edt(foreground)
    edge = around & ((depth <= WINDOW_PX) | _grown(body, WINDOW_PX // 2))
    # A shadow may be as long as the largest stones are wide.
    reach = max(10, int(3 * float(ndimage.distance_transform_edt(sure).max())))
    zone = np.zeros_like(sure)  # behind stones, seen from the light
    height, width = sure.shape
    for far in range(0, reach, 2):
        down, right = (round(float(part) * far) for part in direction)
        to = (_overlap(down, height), _overlap(right, width))
        zone[to] |= sure[_overlap(-down, height), _overlap(-right, width)]
    zone = _grown(zone, WINDOW_PX // 2)
    body = _open_ended(body, sure, direction)
    edge &= _grown(body, WINDOW_PX + 3)
    return Shadows((body | edge) & zone, float(np.exp(level)), alike)


def _grown(mask: Mask, by_px: int) -> Mask:
    return np.asarray(ndimage.binary_dilation(mask, iterations=by_px))


def _direction(core: Mask, sure: Mask) -> Vector | None:
    """Return where shadows fall from what casts them: rows and columns (2,), of length 1.

    None when they fall anywhere.
    """
    labels, count = ndimage.label(sure)
    if count == 0:
        return None
    numbers = np.arange(1, count + 1)
    boxes = ndimage.find_objects(labels)
    vectors, weights = [], []
    for number, box in zip(numbers, boxes, strict=True):
        pad = 3 * WINDOW_PX
        area = tuple(slice(max(side.start - pad, 0), side.stop + pad) for side in box)
        stone = labels[area] == number
        if stone.sum() < 60:
            continue
        near = core[area] & _grown(stone, 2 * WINDOW_PX)
        weights.append(np.sqrt(float(stone.sum())))
        vectors.append(np.zeros(2))
        if near.sum() < 0.02 * stone.sum():
            continue
        middle = [np.argwhere(part).mean(axis=0) for part in (stone, near)]
        way = middle[1] - middle[0]
        length = float(np.hypot(*way))
        # Shaded all round points nowhere.
        if length > 0.15 * weights[-1]:
            vectors[-1] = way / length
    if not weights:
        return None
    shaded = np.any(vectors, axis=1)
    total = np.sum(np.multiply(vectors, np.array(weights)[:, None]), axis=0)
    length, among = float(np.hypot(*total)), float(np.sum(weights, where=shaded))
    many = among >= _LEAST_SHARE * sum(weights) and length >= _AGREEMENT * among
    # Faint shadows are seen beside some stones only, but then on the very same side.
    few = np.count_nonzero(shaded) >= 3 and length >= _FEW_AGREEMENT * among
    if not (many or few):
        return None
    return np.asarray(total / length)


def _open_ended(body: Mask, sure: Mask, direction: Vector) -> Mask:
    """Return the areas that have ground behind them: others are patches of a stone."""
    areas, count = ndimage.label(body)
    down, right = (round(float(part) * 1.5 * WINDOW_PX) for part in direction)
    behind = ndimage.shift(areas, (down, right), order=0, output=np.int32)
    new = np.where(body, 0, behind)
    total = np.bincount(new.ravel(), minlength=count + 1)
    on_stone = np.bincount(new[sure], minlength=count + 1)
    kept = on_stone < 0.5 * total
    kept[0] = False
    return np.asarray(kept[areas])


def _overlap(by: int, size: int) -> slice:
    """Return what of a row is still in the picture when it is moved."""
    return slice(max(by, 0), size + min(by, 0))
