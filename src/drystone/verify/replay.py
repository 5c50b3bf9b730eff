"""Build a planned wall again from the input stones and the poses alone (DESIGN 2)."""

import math
from dataclasses import dataclass

import numpy as np
import shapely

from drystone.errors import PlanError
from drystone.kernels.outline import rasterise_polygon
from drystone.kernels.polygons import Points
from drystone.kernels.raster import quantise
from drystone.model.outlines import Outlines
from drystone.model.overlap import overlap_depth, shape_of
from drystone.model.placement import Placement, Settled, Wedge
from drystone.model.plan import Plan, StoneStep, WedgeStep
from drystone.model.site import Site
from drystone.model.steps import Problem, Step, grouped, id_fault, piece_id, piece_name
from drystone.model.stone import StoneSet
from drystone.model.wall import Group, Labels, Wall
from drystone.planner.settings import PlannerSettings
from drystone.poses import pose_at
from drystone.settle.placing import settled_placement, settled_wedge
from drystone.settle.rest import settled_at
from drystone.settle.settings import SettleSettings
from drystone.verify.lengths import plan_settings, plan_site, source_points, working_points

SIDES = "above the top", "below the ground", "left of the left end", "right of the right"
"""Where a piece may leave the site."""

PENETRATION_PX = 0.05
"""So deep, source px, outlines may lie in each other and beyond the edges of the wall (DESIGN 2).

Depth is that of :func:`drystone.model.overlap.overlap_depth`.  Settled stones keep a clearance,
so this is for plans of other hands and of other arithmetic."""


@dataclass(frozen=True, eq=False)
class PlanPiece:
    """A stone or wedge where the plan puts it, whether it has room there or not."""

    step: Step
    item: Placement | Wedge | None
    """What the step comes to; None when it cannot be in the wall at all, which is a problem."""
    corners: Points | None = None
    """(n, 2): its outline in the wall frame, source px, when the stones of the plan are outlines.
    """

    @property
    def id(self) -> int:
        """Value in wall.png."""
        return piece_id(self.step)


class ExactCanvas:
    """Stones and wedges are their outlines; no two may lie deep in each other."""

    def __init__(self, site: Site, stones: StoneSet, settings: SettleSettings) -> None:
        self._site, self._stones, self._settings = site, stones, settings
        self._outlines = Outlines.empty(site)
        self._names: list[str] = []
        self._shapes: list[shapely.Geometry] = []

    @property
    def labels(self) -> Labels:
        """All pieces; a pixel belongs to the one that covers most of it (DESIGN 4.9)."""
        return self._outlines.shares.labels

    def put(self, step: Step) -> tuple[PlanPiece, list[Problem]]:
        """Return what a step places, and what stands in the way (E220, E221).

        PlanError when it places nothing: there is no such stone (E201) or no such wedge (E222).
        """
        site, settled = self._site, None
        if isinstance(step, WedgeStep):
            corners = wedge_corners(step, site)
        else:
            settled = settled_stone(step, self._stones, site, self._settings.outline_px)
            corners = settled.corners
        where = leaves(corners, site.extent_px, self._settings.beyond_px)
        if where:
            # It is not drawn, as its image could be of any size.
            message = f"{piece_name(step)} leaves the site: {where}."
            return PlanPiece(step, None, corners), [Problem("E220", step.step, message)]
        problems = self._overlaps(step, shape_of(corners))
        # With the pixels that it fills beside those before it.
        item: Placement | Wedge | None
        if isinstance(step, WedgeStep):
            item = settled_wedge(self._outlines, site, step.id, step.under, corners)
        else:
            assert settled is not None  # noqa: S101
            stone, moves = self._stones.by_id(step.stone), step.rotation_moves
            item = settled_placement(
                self._outlines, site, stone, step.angle_deg, settled, step.side, moves
            )
        if item is None and not problems:
            message = f"{piece_name(step)} fills no px of the wall."
            problems.append(Problem("E220", step.step, message))
        self._outlines = self._outlines.added([(piece_id(step), corners)], site.scale)
        return PlanPiece(step, item, corners), problems

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


class RasterCanvas:
    """Stones and wedges are their pixels; no two may share one."""

    def __init__(self, site: Site, stones: StoneSet) -> None:
        self._site, self._stones = site, stones
        self.labels: Labels = np.zeros((site.height_px, site.width_px), np.uint32)
        """All pieces; where two overlap the first one is seen."""

    def put(self, step: Step) -> tuple[PlanPiece, list[Problem]]:
        """See :meth:`ExactCanvas.put`; E220 is raised of a wedge, too."""
        item: Placement | Wedge
        if isinstance(step, WedgeStep):
            item = place_wedge(step, self._site)
            mask = item.mask
        else:
            item = place_stone(step, self._stones, self._site)
            mask = item.posed.mask
        piece, name, (rows, cols) = PlanPiece(step, item), piece_name(step), item.window
        height, width = self.labels.shape
        outside = (-rows.start, rows.stop - height, -cols.start, cols.stop - width)
        if max(outside) > 0:
            where = ", ".join(f"{n} px {s}" for n, s in zip(outside, SIDES, strict=True) if n > 0)
            return piece, [Problem("E220", step.step, f"{name} leaves the site: {where}.")]
        view = self.labels[rows, cols]
        taken = view[mask]
        view[mask & (view == 0)] = piece.id
        ids, counts = np.unique(taken[taken > 0], return_counts=True)
        return piece, [
            Problem("E221", step.step, f"{name} overlaps {other} by {count} working px.")
            for other, count in zip(ids.tolist(), counts.tolist(), strict=True)
        ]


def settled_stone(step: StoneStep, stones: StoneSet, site: Site, outline_px: float) -> Settled:
    """Return where a stone step puts its outline; raise PlanError (E201) when there is none."""
    outline = stones.by_id(step.stone).outline_within(outline_px)
    x, y = source_points([step.centroid], site)[0].tolist()
    return settled_at(outline, step.angle_deg, x, y)


def wedge_corners(step: WedgeStep, site: Site) -> Points:
    """Return the outline of a wedge step in source px.

    PlanError E222 when it crosses or touches itself, names a corner twice, has no area, or is
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
    """
    (left, bottom), (right, top) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    width, height = extent_px
    out = top - height, -bottom, -left, right - width
    allowed = beyond_px, 0.0, beyond_px, beyond_px
    return ", ".join(
        f"{by:.3g} px {side}"
        for side, by, most in zip(SIDES, out, allowed, strict=True)
        if by > most + PENETRATION_PX
    )


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
    """Return the pixels of a wedge; PlanError E220 outside of the site, E222 without a pixel."""
    polygon = working_points(step.polygon, site)
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    if (low < -0.5).any() or (high > (site.width_px + 0.5, site.height_px + 0.5)).any():
        raise PlanError("E220", f"wedge {step.id} leaves the site.")
    mask, left, bottom = rasterise_polygon(polygon)
    if not mask.size:
        raise PlanError("E222", f"wedge {step.id} has no pixel at the working resolution.")
    return Wedge(step.id, step.under, mask, site.height_px - bottom - mask.shape[0], left)


@dataclass(frozen=True, eq=False)
class Stage:
    """The wall before and after one stone and its wedges."""

    stone: StoneStep
    last: StoneStep | WedgeStep  # the last step of the group, which claims the load multipliers
    before: Wall  # the wall without and with the group
    after: Wall

    @property
    def group(self) -> Group:
        """The stone and its wedges."""
        return self.after.groups[-1]


@dataclass(frozen=True, eq=False)
class Replay:
    """A plan played again."""

    settings: PlannerSettings
    site: Site
    pieces: tuple[PlanPiece, ...]  # everything that could be derived, in order
    labels: Labels
    """(h, w): all of it drawn, row 0 at the top; where pixels of two pieces overlap the first one
    is seen, where outlines do the one that covers most."""
    stages: tuple[Stage, ...]  # the wall as it grows, up to the first group that cannot be built
    broken_at: int | None  # first step of that group; None when the whole wall was built
    problems: tuple[Problem, ...]
    """E212, E213: ids; E214: order of steps; E217: settings; E220: outside the site; E221: overlap;
    E222: a wedge whose polygon is none."""

    @property
    def exact(self) -> bool:
        """True when stones are their outlines."""
        return self.settings.geometry == "exact"

    @property
    def wall(self) -> Wall:
        """The wall as far as it could be built."""
        return self.stages[-1].after if self.stages else Wall.empty(self.site, exact=self.exact)


def rebuild_wall(plan: Plan, stones: StoneSet) -> Wall:
    """Return the wall of a plan, derived from the input stones and the poses alone.

    On the raster each stone is turned, reduced and rasterised from its source pixels, with its
    centroid where the plan puts it (to the nearest 1/64 working px); on exact geometry its outline
    is.  Wedges come from their polygons.  The first problem of :class:`Replay` is a PlanError, as
    is a wall that is too large or too small to be an image (E215).
    """
    replay = replay_plan(plan, stones)
    if replay.problems:
        first = replay.problems[0]
        where = "settings" if first.step is None else f"step {first.step}"
        cure = "Correct the plan, or give its own stones; `drystone check` lists everything."
        raise PlanError(first.code, first.message, where=where, cure=cure)
    return replay.wall


def replay_plan(plan: Plan, stones: StoneSet) -> Replay:
    """Play a plan again and collect what stands in the way; PlanError (E215) as above."""
    settings, problems = plan_settings(plan)
    site = plan_site(plan)
    groups, disorder = grouped(plan.steps)
    problems += disorder
    exact = settings.geometry == "exact"
    canvas = ExactCanvas(site, stones, settings.settle) if exact else RasterCanvas(site, stones)
    wall, broken_at = Wall.empty(site, exact=exact), None
    pieces: list[PlanPiece] = []
    stages: list[Stage] = []
    used: set[int] = set()
    largest = max((stone.id for stone in stones), default=0)
    for steps in groups:
        derived: list[PlanPiece] = []
        found: list[Problem] = []
        for step in steps:
            try:
                piece, faults = canvas.put(step)
            except PlanError as error:
                code = "E212" if error.code == "E201" else error.code
                found.append(Problem(code, step.step, error.what))
            else:
                derived.append(piece)
                repeated = id_fault(step, used, largest)
                found += faults if repeated is None else [repeated, *faults]
        pieces += derived
        problems += found
        if found and broken_at is None:
            broken_at = steps[0].step
        if broken_at is None:
            before = wall
            placement, *wedges = (piece.item for piece in derived)
            assert isinstance(placement, Placement)  # noqa: S101 - a group starts with a stone
            assert isinstance(steps[0], StoneStep)  # noqa: S101
            wall = wall.add(placement, tuple(w for w in wedges if isinstance(w, Wedge)))
            stages.append(Stage(steps[0], steps[-1], before, wall))
    return Replay(
        settings, site, tuple(pieces), canvas.labels, tuple(stages), broken_at, tuple(problems)
    )
