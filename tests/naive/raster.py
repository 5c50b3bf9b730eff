"""Slow, obvious twins of rasterising: exact clipping of polygons, samples one by one."""

import math

import numpy as np
import shapely
from scipy import ndimage
from shapely import affinity

from drystone.kernels.raster import rotation


def polygon_of(mask):
    """The pixel squares of a mask, y up from its bottom-left corner."""
    y, x = np.nonzero(mask[::-1])
    return shapely.union_all(shapely.box(x, y, x + 1, y + 1))


def coverage(mask, centre, angle_deg, scale, phase, window):
    """Covered share of every pixel of a window (left, bottom, right, top), row 0 at the top."""
    polygon = affinity.translate(polygon_of(mask), -centre[0], -centre[1])
    polygon = affinity.rotate(polygon, angle_deg, origin=(0, 0))
    polygon = affinity.scale(polygon, scale, scale, origin=(0, 0))
    polygon = affinity.translate(polygon, *phase)
    left, bottom, right, top = window
    y, x = np.mgrid[bottom:top, left:right]
    return shapely.area(shapely.intersection(shapely.box(x, y, x + 1, y + 1), polygon))[::-1]


def second_moment_eccentricity(mask):
    """Focal distance over major axis of the ellipse of equal second moments (§3.4)."""
    # Parts of every pixel instead of its own moment: converges to the unit square.
    fine = np.argwhere(np.kron(mask, np.ones((64, 64))))
    small, large = np.linalg.eigvalsh(np.cov(fine.T, bias=True))
    return float(np.sqrt(1 - small / large))


def sampled(mask, centre, angle_deg, scale, phase):
    """Samples that hit, of each pixel (x, y of its bottom-left corner), and samples in a pixel."""
    height, width = mask.shape
    cos, sin = rotation(angle_deg)
    k = 4
    while k < (1 - 1e-9) / scale:
        k *= 2
    reach = math.ceil(scale * math.hypot(width, height)) + 1  # from any point of the mask
    counts = {}
    for x in range(-reach, reach + 1):
        for y in range(-reach, reach + 1):
            for i in range(k * k):
                u = (x + (i % k + 0.5) / k - phase[0]) / scale
                v = (y + (i // k + 0.5) / k - phase[1]) / scale
                col = math.floor(cos * u + (sin * v + centre[0]))
                row = math.floor(sin * u + (height - centre[1] - cos * v))
                if 0 <= row < height and 0 <= col < width and mask[row, col]:
                    counts[x, y] = counts.get((x, y), 0) + 1
    return counts, k * k


def rasterised(mask, centre, angle_deg, scale, phase):
    """Pixels covered to a half, or to less where the mask would fall apart; empty when missed."""
    counts, full = sampled(mask, centre, angle_deg, scale, phase)
    for share in (2, 4):
        taken = {pixel for pixel, count in counts.items() if share * count >= full}
        if pieces(taken) == 1:
            return taken
    return set(counts)


def rasterised_to_area(mask, centre, angle_deg, scale, phase, area):
    """Rasterise at one sub-pixel position after the other until the area is right."""
    phases = [(phase[0] + i / 4, phase[1] + j / 4) for j in range(4) for i in range(4)]
    errors = []
    for at in phases:
        counts, full = sampled(mask, centre, angle_deg, scale, at)
        errors.append(abs(sum(2 * count >= full for count in counts.values()) - area[0]))
        if errors[-1] <= area[1]:
            break
    best = phases[errors.index(min(errors))]
    return rasterised(mask, centre, angle_deg, scale, best), best


def pieces(pixels, joined=((1, 1, 1),) * 3):
    """Count the pieces of some pixels, joined at edges or corners, or as is asked for."""
    if not pixels:
        return 0
    places = np.array(sorted(pixels))
    image = np.zeros(np.ptp(places, axis=0) + 1, bool)
    image[tuple((places - places.min(axis=0)).T)] = True
    return ndimage.label(image, joined)[1]
