"""Trials of seats, each wall built anew from the ground."""

import numpy as np

from drystone.kernels.polygons import area_and_centroid, no_polygons
from drystone.settle.putting import fallen_share, put_down


def falls(steps, errors, trial, mu, settle, near):
    """Say of each step whether its stone falls, in one wall that is built with errors.

    Steps are the id of a stone, its corners as planned, and corners of its wedges.
    """
    built, fallen = [], []
    for stone, planned, wedges in steps:
        area, x, y = area_and_centroid(planned)
        low, high, far = planned.min(axis=0), planned.max(axis=0), near * area**0.5
        some = [
            k for k, one in enumerate(built)
            if one[:, 0].min() <= high[0] + far and one[:, 0].max() >= low[0] - far
            and one[:, 1].min() <= high[1] + far and one[:, 1].max() >= low[1] - far
        ]  # fmt: skip
        around = no_polygons().added([*(built[k] for k in some), *wedges])
        put = errors.built(planned, np.random.default_rng([7, trial, stone]))
        rest, pushed = put_down(put, around, mu, settle)
        fell = rest is None
        if rest is not None:
            fell = fallen_share(rest.x - x, rest.y - y, rest.angle_deg, rest.size) > 1
        for i, way in pushed.items():
            if not fell and i < len(some):
                built[some[i]] = built[some[i]] + (way, 0.0)
        built += [*wedges, planned if fell or rest is None else rest.corners]
        fallen.append(fell)
    return fallen
