"""Putting the pieces of a plan on the outlines that are there (DESIGN 4.9)."""

import numpy as np
import shapely

from drystone.errors import PlanError
from drystone.kernels.polygons import Points
from drystone.model.outlines import Outlines
from drystone.model.overlap import overlap_depth, shape_of
from drystone.model.placement import Placement, Settled, Wedge
from drystone.model.plan import StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Labels
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import placed_outline
from drystone.settle.settings import SettleSettings
from drystone.verify.lengths import source_points
from drystone.verify.pieces import Piece, Step, piece_id, piece_name
from drystone.verify.report import Problem

PENETRATION_PX = 0.05
"""So deep, source px, outlines may lie in each other and beyond the edges of the wall (DESIGN 2).

Depth is that of :func:`drystone.model.overlap.overlap_depth`.  Settled stones keep a clearance,
so this is for plans of other hands and of other arithmetic."""


class ExactCanvas:
    """Stones and wedges are their outlines; no two may lie deep in each other.

    Parameters
    ----------
    site : Site
        Of the plan.
    stones : StoneSet
        That it was made from.
    settings : SettleSettings
        How far outlines may stay away from the contour of the pixels, and how far stones may
        stand out of the wall.
    """

    def __init__(self, site: Site, stones: StoneSet, settings: SettleSettings) -> None:
        self._site = site
        self._stones = stones
        self._outline_px = settings.outline_px
        self._beyond_px = settings.beyond_px
        self._outlines = Outlines.empty(site)
        self._names: list[str] = []
        self._shapes: list[shapely.Geometry] = []

    @property
    def labels(self) -> Labels:
        """All pieces; a pixel belongs to the one that covers most of it (DESIGN 4.9)."""
        return self._outlines.shares.labels

    def put(self, step: Step) -> tuple[Piece, list[Problem]]:
        """See :class:`drystone.verify.pieces.Canvas`."""
        place = (
            wedge_corners(step, self._site)
            if isinstance(step, WedgeStep)
            else settled_stone(step, self._stones, self._site, self._outline_px)
        )
        corners = place.corners if isinstance(place, Settled) else place
        where = leaves(corners, self._site.extent_px, self._beyond_px)
        if where:
            # It is not drawn, as its image could be of any size.
            message = f"{piece_name(step)} leaves the site: {where}."
            return Piece(step, None, corners), [Problem("E220", step.step, message)]
        problems = self._overlaps(step, shape_of(corners))
        item = self._item(step, place)
        if item is None and not problems:
            message = f"{piece_name(step)} fills no px of the wall."
            problems.append(Problem("E220", step.step, message))
        self._outlines = self._outlines.added([(piece_id(step), corners)], self._site.scale)
        return Piece(step, item, corners), problems

    def _item(self, step: Step, place: Settled | Points) -> Placement | Wedge | None:
        """Return a piece with the pixels that it fills beside those before it."""
        if isinstance(step, WedgeStep):
            assert not isinstance(place, Settled)  # noqa: S101 - wedges have corners only
            return settled_wedge(self._outlines, self._site, step.id, step.under, place)
        assert isinstance(place, Settled)  # noqa: S101
        return settled_placement(
            self._outlines,
            self._site,
            self._stones.by_id(step.stone),
            step.angle_deg,
            place,
            step.side,
            step.rotation_moves,
        )

    def _overlaps(self, step: Step, shape: shapely.Geometry) -> list[Problem]:
        """Name the pieces that this one lies in, too deep (E221); remember it."""
        name, problems = piece_name(step), []
        shapely.prepare(shape)
        met = shapely.intersects(shape, np.array(self._shapes, object))
        for place in np.flatnonzero(met).tolist():
            depth = overlap_depth(self._shapes[place], shape)
            if depth > PENETRATION_PX:
                message = f"{name} lies {depth:.3g} source px deep in {self._names[place]}."
                problems.append(Problem("E221", step.step, message))
        self._names.append(name)
        self._shapes.append(shape)
        return problems


def settled_stone(step: StoneStep, stones: StoneSet, site: Site, outline_px: float) -> Settled:
    """Return where a stone step puts its outline; raise PlanError (E201) when there is none."""
    outline = stones.by_id(step.stone).outline_within(outline_px)
    x, y = source_points([step.centroid], site)[0].tolist()
    return Settled(x, y, placed_outline(outline, step.angle_deg, x, y))


def wedge_corners(step: WedgeStep, site: Site) -> Points:
    """Return the outline of a wedge step in source px.

    Raises
    ------
    PlanError
        E222 when its polygon crosses or touches itself, names a corner twice, has no area, or is
        clockwise.
    """
    corners = source_points(step.polygon, site)
    polygon = shapely.Polygon(corners)
    apart = np.abs(corners - np.roll(corners, 1, axis=0)).max(axis=1) > 0.0
    if not (apart.all() and polygon.is_valid):
        raise PlanError(
            "E222",
            f"the polygon of wedge {step.id} crosses itself, names a corner twice or has no area.",
        )
    if not polygon.exterior.is_ccw:
        raise PlanError("E222", f"the polygon of wedge {step.id} is clockwise.")
    return corners


def leaves(corners: Points, extent_px: tuple[float, float], beyond_px: float = 0.0) -> str:
    """Say where an outline is out of the wall by more than it may and `PENETRATION_PX`.

    Over the ends and the top it may stand out by `beyond_px`, into the ground by nothing.

    Examples
    --------
    >>> leaves(np.array([[0.0, -0.3], [2.0, -0.02], [2.0, 5.0]]), (9.0, 4.5))
    '0.5 px above the top, 0.3 px below the ground'
    """
    (left, bottom), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    width, height = extent_px
    beyond = {
        "above the top": (top - height, beyond_px),
        "below the ground": (-bottom, 0.0),
        "left of the left end": (-left, beyond_px),
        "right of the right": (right - width, beyond_px),
    }
    return ", ".join(
        f"{by:.3g} px {side}"
        for side, (by, allowed) in beyond.items()
        if by > allowed + PENETRATION_PX
    )
