"""Trials of seats, each wall built anew from the ground."""

from drystone.kernels.polygons import no_polygons
from drystone.model.builder import Built
from drystone.settle.putting import fallen_share, put_down


def falls(steps, errors, mu, settle, near):
    """Say of each step whether its stone falls, in one wall that is built with errors.

    Steps are pairs of a stone as planned, a `Built`, and corners of its wedges; `errors` says of
    each stone its outline, how far it is put aside, and by how much it is turned.
    """
    built, fallen = [], []
    for (planned, wedges), (outline, aside, turned) in zip(steps, errors, strict=True):
        low, high = planned.corners.min(axis=0), planned.corners.max(axis=0)
        far = near * planned.size
        some = [
            k for k, one in enumerate(built)
            if one[:, 0].min() <= high[0] + far and one[:, 0].max() >= low[0] - far
            and one[:, 1].min() <= high[1] + far and one[:, 1].max() >= low[1] - far
        ]  # fmt: skip
        around = no_polygons().added([*(built[k] for k in some), *wedges])
        put = Built(outline, planned.x + aside, planned.y, planned.angle_deg + turned)
        rest, pushed = put_down(put, around, mu, settle)
        fell = rest is None
        if rest is not None:
            way = rest.x - planned.x, rest.y - planned.y
            fell = fallen_share(*way, rest.angle_deg - planned.angle_deg, planned.size) > 1
        for i, x in pushed.items():
            if not fell and i < len(some):
                built[some[i]] = built[some[i]] + (x, 0.0)
        built += [*wedges, planned.corners if fell or rest is None else rest.corners]
        fallen.append(fell)
    return fallen
