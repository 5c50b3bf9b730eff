"""Putting the pieces of a plan on the pixels of the working resolution (DESIGN 2)."""

import math

import numpy as np

from drystone.errors import PlanError
from drystone.kernels.outline import rasterise_polygon
from drystone.kernels.raster import quantise
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.poses import pose_at
from drystone.verify.lengths import working_points
from drystone.verify.pieces import Piece, Step, piece_name
from drystone.verify.report import Problem


class RasterCanvas:
    """Stones and wedges are their pixels; no two may share one.

    Parameters
    ----------
    site : Site
        Of the plan.
    stones : StoneSet
        That it was made from.
    """

    def __init__(self, site: Site, stones: StoneSet) -> None:
        self._site = site
        self._stones = stones
        self._labels = np.zeros((site.height_px, site.width_px), np.uint32)

    @property
    def labels(self) -> Labels:
        """All pieces; where two overlap the first one is seen."""
        return self._labels

    def put(self, step: Step) -> tuple[Piece, list[Problem]]:
        """See :class:`drystone.verify.pieces.Canvas`."""
        if isinstance(step, WedgeStep):
            wedge = place_wedge(step, self._site)
            return Piece(step, wedge), self._painted(step, wedge)
        placement = place_stone(step, self._stones, self._site)
        return Piece(step, placement), self._painted(step, placement)

    def _painted(self, step: Step, item: Placement | Wedge) -> list[Problem]:
        """Draw a piece where there is room; name what is outside (E220) or taken (E221)."""
        rows, cols = item.window
        mask = item.mask if isinstance(item, Wedge) else item.posed.mask
        height, width = self._labels.shape
        name = piece_name(step)
        outside = (-rows.start, rows.stop - height, -cols.start, cols.stop - width)
        if max(outside) > 0:
            sides = (
                "above the top", "below the ground", "left of the left end", "right of the right",
            )  # fmt: skip
            where = ", ".join(f"{n} px {s}" for n, s in zip(outside, sides, strict=True) if n > 0)
            return [Problem("E220", step.step, f"{name} leaves the site: {where}.")]
        view = self._labels[rows, cols]
        taken = view[mask]
        view[mask & (view == 0)] = item.id if isinstance(item, Wedge) else item.stone_id
        ids, counts = np.unique(taken[taken > 0], return_counts=True)
        return [
            Problem("E221", step.step, f"{name} overlaps {other} by {count} working px.")
            for other, count in zip(ids.tolist(), counts.tolist(), strict=True)
        ]


def place_stone(step: StoneStep, stones: StoneSet, site: Site) -> Placement:
    """Return where a stone step puts its stone; raise PlanError (E201) when there is none.

    The stone is turned, reduced and rasterised from its source pixels, with its centroid where
    the plan puts it, to the nearest 1/64 working px.
    """
    centre = [quantise(v) for v in working_points([step.centroid], site)[0].tolist()]
    corner = [math.floor(v) for v in centre]
    phase = (centre[0] - corner[0], centre[1] - corner[1])
    stone = stones.by_id(step.stone)
    posed, left, bottom = pose_at(stone, step.angle_deg, site.scale, phase)
    row = site.height_px - (corner[1] + bottom) - posed.height_px
    return Placement(posed, row, corner[0] + left, step.side, step.rotation_moves)


def place_wedge(step: WedgeStep, site: Site) -> Wedge:
    """Return the pixels of a wedge step.

    Raises
    ------
    PlanError
        E220 when its polygon leaves the site, E222 when there is no pixel in it.
    """
    polygon = working_points(step.polygon, site)
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    if (low < -0.5).any() or (high > (site.width_px + 0.5, site.height_px + 0.5)).any():
        raise PlanError("E220", f"wedge {step.id} leaves the site.")
    mask, left, bottom = rasterise_polygon(polygon)
    if not mask.size:
        raise PlanError("E222", f"wedge {step.id} has no pixel at the working resolution.")
    return Wedge(step.id, step.under, mask, site.height_px - bottom - mask.shape[0], left)
