"""The colour of the ground in a photograph, the light on it, and the shadows that stones cast."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.color import rgb2lab
from skimage.filters import threshold_otsu

from drystone.errors import InputError
from drystone.kernels.raster import Mask

Planes = NDArray[np.float32]
"""(h, w, 3)."""

Ground = Literal["auto", "light", "dark"]
"""The lightest or the darkest large area of the photograph; or the colour that is most frequent
along the borders and all over."""


LEAST_SHARE = 0.2
"""Share of the picture that must be ground, or it is no photograph of stones laid out."""

_NEAR = 10.0
"""Distance in Lab of what may be ground, of the first guess."""

_BIN = 4.0
_ORDERS = (0, 1, 1, 2, 2, 2, 3, 3, 3)
"""Order of the polynomial of the light in every round: more is found with what was fitted."""


@dataclass(frozen=True, eq=False)
class GroundModel:
    """A photograph as it would be if the ground were lit evenly."""

    # Natural logarithm of linear light over that of the ground at the same place: 0 on the ground.
    log_light: Planes
    lab: Planes  # (h, w, 3) CIELAB of the evenly lit picture
    colour: NDArray[np.float64]  # (3,) CIELAB of the ground
    spread: NDArray[np.float64]  # (3,) robust standard deviation of the ground; at least 0.8
    share: float  # share of the picture that has the colour of the ground
    uneven: float  # how much darker the darkest place of it is lit than the brightest, 0 to 1

    @property
    def distance(self) -> NDArray[np.float32]:
        """Distance of every px from the ground, (h, w), in standard deviations of the ground."""
        away = (self.lab - self.colour) / self.spread
        return np.asarray(np.linalg.norm(away, axis=-1), np.float32)


def fit_ground(image: NDArray[np.uint8], usable: Mask, ground: Ground) -> GroundModel:
    """Find the ground and take its uneven light out of an RGB photograph.

    `usable` is what may be ground or stone: not the markers, nor what the photograph does not show.
    E176 when no colour is frequent enough to be a ground, or nothing may be one.
    """
    value = np.arange(256) / 255  # of sRGB
    table = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    light = table.astype(np.float32)[image]
    smooth = ndimage.gaussian_filter(light, 1.0, axes=(0, 1))
    step = max(1, round(np.sqrt(usable.size / 15_000)))
    coarse = ndimage.gaussian_filter(light, 2.0, axes=(0, 1))[::step, ::step]
    field = _fit_light(coarse, usable[::step, ::step], ground)
    # It is smooth, so it is evaluated on few places.
    planes = np.moveaxis(_basis((40, 40)) @ field, -1, 0)
    ratio = (usable.shape[0] / 40, usable.shape[1] / 40)
    log_ground = np.stack(
        [ndimage.zoom(plane, ratio, order=1, mode="nearest") for plane in planes], axis=-1
    ).astype(np.float32)
    log_light = np.log(np.maximum(smooth, 1e-3)) - log_ground
    middle = log_ground[usable].mean(axis=0)
    even = np.exp(log_light + middle)
    lab = lab_of(even)
    colour, spread, share = _statistics(lab, usable, middle)
    if share < LEAST_SHARE:
        raise _no_ground(share)
    brightness = log_ground[usable].mean(axis=-1)
    uneven = 1 - float(np.exp(np.percentile(brightness, 1) - np.percentile(brightness, 99)))
    return GroundModel(log_light.astype(np.float32), lab, colour, spread, share, uneven)


def _no_ground(share: float) -> InputError:
    return InputError(
        "E176",
        "no even ground was found: the colour that is most frequent along the borders and all over "
        f"fills only {100 * share:.0f} % of the photograph.",
        cure="Lay the stones on a plain sheet of another colour than theirs, and photograph "
        "nothing else; or say --ground light or --ground dark.",
    )


def lab_of(light: NDArray[Any]) -> Planes:
    """Return CIELAB of linear light; above 1 is cut off."""
    low = np.clip(light, 0, 1)
    value = np.where(low <= 0.0031308, 12.92 * low, 1.055 * low ** (1 / 2.4) - 0.055)
    return np.asarray(rgb2lab(value.astype(np.float32)), np.float32)


def _fit_light(light: Planes, usable: Mask, ground: Ground) -> NDArray[np.float64]:
    """Return coefficients (10, 3) of the logarithm of the light on the ground."""
    if not usable.any():
        raise _no_ground(0.0)
    lab = lab_of(light)
    log = np.log(np.maximum(light, 1e-3))
    near = usable & (np.linalg.norm(lab - _frequent(lab, usable, ground), axis=-1) < _NEAR)
    if not near.any():
        raise _no_ground(0.0)
    basis = _basis(usable.shape)
    field = np.zeros((10, 3))
    for order in _ORDERS:
        terms = (order + 1) * (order + 2) // 2
        field[:] = 0
        known_basis = basis[near][:, :terms]
        # Few terms of one size: the normal equations are exact enough, and fast.
        square = known_basis.T @ known_basis + 1e-9 * len(known_basis) * np.eye(terms)
        field[:terms] = np.linalg.solve(square, known_basis.T @ log[near])
        away = np.linalg.norm(lab - lab_of(np.exp(basis @ field)), axis=-1)
        limit = np.clip(3.5 * 1.48 * np.median(away[near]), 6.0, 1.6 * _NEAR)
        near = usable & (away < limit)
        if near.sum() < max(20, 0.5 * LEAST_SHARE * usable.sum()):
            break
    return field


def _frequent(lab: Planes, usable: Mask, ground: Ground) -> NDArray[np.float64]:
    """Return the most frequent colour, counted along the borders and all over."""
    allowed = usable
    if ground != "auto":
        split = threshold_otsu(lab[..., 0][usable])
        side = usable & ((lab[..., 0] > split) == (ground == "light"))
        # Where all is equally bright there is no lighter side to choose from.
        allowed = side if side.any() else usable
    depth = ndimage.distance_transform_edt(np.pad(usable, 1))[1:-1, 1:-1]
    border = allowed & (depth < 0.06 * max(usable.shape))
    edges = [np.arange(0, 105, _BIN), np.arange(-110, 114, _BIN), np.arange(-110, 114, _BIN)]
    counts = np.zeros([len(edge) - 1 for edge in edges])
    for part in (allowed, border):
        if part.any():
            counts = counts + np.histogramdd(lab[part], edges)[0] / part.sum()
    best = np.unravel_index(int(ndimage.gaussian_filter(counts, 0.8).argmax()), counts.shape)
    middle = np.array([edges[k][best[k]] + _BIN / 2 for k in range(3)])
    near = lab[allowed][np.linalg.norm(lab[allowed] - middle, axis=-1) < 2 * _BIN]
    return np.asarray(np.median(near, axis=0) if len(near) else middle, np.float64)


def _basis(shape: tuple[int, int]) -> NDArray[np.float64]:
    """Return the products of powers of x and y up to the third, (h, w, 10), from low to high."""
    y, x = np.meshgrid(*(np.linspace(-1, 1, side) for side in shape), indexing="ij")
    return np.stack(
        [x ** (order - k) * y**k for order in range(4) for k in range(order + 1)], axis=-1
    )


def _statistics(
    lab: Planes, usable: Mask, log_ground: NDArray[Any]
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    colour = lab_of(np.exp(log_ground)[None, None])[0, 0].astype(float)
    values = lab[usable][:: max(1, int(usable.sum()) // 200_000)]
    limit = 1.6 * _NEAR
    for left in (3, 2, 1, 0):
        near = values[np.linalg.norm(values - colour, axis=-1) < limit]
        if len(near) < 10:
            return colour, np.full(3, 0.8), 0.0
        if left:
            colour = np.median(near, axis=0).astype(float)
            limit = np.clip(4 * 1.48 * np.median(np.linalg.norm(near - colour, axis=-1)), 8.0, 30.0)
    spread = 1.48 * np.median(np.abs(near - colour), axis=0)
    return colour, np.maximum(spread, 0.8), len(near) / len(values)


_DARKEST, _LIGHTEST = -2.0, -0.06
"""Logarithm of the light in a shadow over that beside it."""

_WINDOW_PX = 9
"""Where the roughness of a surface is measured."""

_SHADED_SHARE = 0.35
"""Share of the stones that must have a shadow, unless few agree well."""

_AGREEMENT, _FEW_AGREEMENT = 0.7, 0.9
"""How well they must agree on its side, 0 to 1; and where few of three stones or more do."""


def find_shadows(ground: GroundModel, foreground: Mask, usable: Mask) -> tuple[Mask, float, Mask]:
    """Tell cast shadows from stones: ground with less light, all on one side of the stones.

    Return where they are, the light in them over that beside them (1 when there are none), and
    what has the colour of shaded ground, shadow or not.

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
    square = ndimage.uniform_filter(light**2, _WINDOW_PX)
    rough = np.sqrt(np.maximum(square - ndimage.uniform_filter(light, _WINDOW_PX) ** 2, 0))
    alike = tinted & (rough < 0.03 + 2.5 * float(np.median(rough[about])))
    none = np.zeros_like(foreground), 1.0, alike
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
    around = _grown(body, _WINDOW_PX + 3) & tinted & (light > level - width)
    sure = ndimage.binary_opening(foreground & ~around & ~body, iterations=3)
    direction = _direction(body, sure)
    if direction is None:
        return none
    # The soft edge of a shadow, on the side of the lit ground, has light of its own.
    depth = ndimage.distance_transform_edt(foreground)
    edge = around & ((depth <= _WINDOW_PX) | _grown(body, _WINDOW_PX // 2))
    # A shadow may be as long as the largest stones are wide.
    reach = max(10, int(3 * float(ndimage.distance_transform_edt(sure).max())))
    zone = np.zeros_like(sure)  # behind stones, seen from the light
    height, width = sure.shape
    for far in range(0, reach, 2):
        down, right = (round(float(part) * far) for part in direction)
        to = (_overlap(down, height), _overlap(right, width))
        zone[to] |= sure[_overlap(-down, height), _overlap(-right, width)]
    zone = _grown(zone, _WINDOW_PX // 2)
    body = _open_ended(body, sure, direction)
    edge &= _grown(body, _WINDOW_PX + 3)
    return (body | edge) & zone, float(np.exp(level)), alike


def _grown(mask: Mask, by_px: int) -> Mask:
    return np.asarray(ndimage.binary_dilation(mask, iterations=by_px))


def _direction(core: Mask, sure: Mask) -> NDArray[np.float64] | None:
    """Return where shadows fall from what casts them: rows and columns (2,), of length 1.

    None when they fall anywhere.
    """
    labels, _ = ndimage.label(sure)
    vectors, weights = [], []
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        pad = 3 * _WINDOW_PX
        area = tuple(slice(max(side.start - pad, 0), side.stop + pad) for side in box)
        stone = labels[area] == number
        if stone.sum() < 60:
            continue
        near = core[area] & _grown(stone, 2 * _WINDOW_PX)
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
    many = among >= _SHADED_SHARE * sum(weights) and length >= _AGREEMENT * among
    # Faint shadows are seen beside some stones only, but then on the very same side.
    few = np.count_nonzero(shaded) >= 3 and length >= _FEW_AGREEMENT * among
    if not (many or few):
        return None
    return np.asarray(total / length)


def _open_ended(body: Mask, sure: Mask, direction: NDArray[np.float64]) -> Mask:
    """Return the areas that have ground behind them: others are patches of a stone."""
    areas, count = ndimage.label(body)
    down, right = (round(float(part) * 1.5 * _WINDOW_PX) for part in direction)
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
