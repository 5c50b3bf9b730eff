"""Build a planned wall again from the input stones and the poses alone (DESIGN 2)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.errors import PlanError
from drystone.kernels.outline import rasterise_polygon
from drystone.kernels.raster import Mask, quantise
from drystone.model.placement import Placement, Wedge
from drystone.model.plan import Plan, Point, StoneStep, WedgeStep
from drystone.model.site import MAX_SITE_PX, Site
from drystone.model.stone import StoneSet
from drystone.model.wall import Group, Labels, Wall
from drystone.poses import pose_at
from drystone.verify.report import Problem

MAX_WALL_PX = MAX_SITE_PX
"""Larger walls are neither planned nor rebuilt."""


@dataclass(frozen=True, eq=False)
class Piece:
    """A stone or wedge where the plan puts it, whether it has room there or not.

    Parameters
    ----------
    step : StoneStep or WedgeStep
        Its step.
    item : Placement or Wedge
        What the step comes to.
    """

    step: StoneStep | WedgeStep
    item: Placement | Wedge

    @property
    def id(self) -> int:
        """Value in wall.png."""
        return self.item.id if isinstance(self.item, Wedge) else self.item.stone_id

    @property
    def mask(self) -> Mask:
        """Pixels, cropped."""
        return self.item.mask if isinstance(self.item, Wedge) else self.item.posed.mask


@dataclass(frozen=True, eq=False)
class Stage:
    """The wall before and after one stone and its wedges.

    Parameters
    ----------
    stone : StoneStep
        The step of the stone.
    last : StoneStep or WedgeStep
        The last step of the group, which claims the load multipliers.
    before, after : Wall
        The wall without and with the group.
    """

    stone: StoneStep
    last: StoneStep | WedgeStep
    before: Wall
    after: Wall

    @property
    def group(self) -> Group:
        """The stone and its wedges."""
        return self.after.groups[-1]


@dataclass(frozen=True, eq=False)
class Replay:
    """A plan played again.

    Parameters
    ----------
    site : Site
        Size and resolution of the wall.
    pieces : tuple of Piece
        Everything that could be derived, in order.
    labels : (h, w) uint32 array
        All of it drawn, row 0 at the top; where two pieces overlap the first one is seen.
    stages : tuple of Stage
        The wall as it grows, up to the first group that cannot be built.
    broken_at : int or None
        First step of that group; None when the whole wall was built.
    problems : tuple of Problem
        E212, E213: ids; E214: order of steps; E220: outside the site; E221: overlap; E222: a
        wedge without pixels.
    """

    site: Site
    pieces: tuple[Piece, ...]
    labels: Labels
    stages: tuple[Stage, ...]
    broken_at: int | None
    problems: tuple[Problem, ...]

    @property
    def wall(self) -> Wall:
        """The wall as far as it could be built."""
        return self.stages[-1].after if self.stages else Wall.empty(self.site)


def rebuild_wall(plan: Plan, stones: StoneSet) -> Wall:
    """Return the wall of a plan, derived from the input stones and the poses alone.

    Each stone is turned, reduced and rasterised from its source pixels, with its centroid where
    the plan puts it (to the nearest 1/64 working px); wedges come from their polygons.

    Parameters
    ----------
    plan : Plan
        What to build.
    stones : StoneSet
        The stones that it was made from.

    Raises
    ------
    PlanError
        The first problem of :class:`Replay`; E215 when the wall is too large or too small to be
        an image.
    """
    replay = replay_plan(plan, stones)
    if replay.problems:
        first = replay.problems[0]
        raise PlanError(
            first.code,
            first.message,
            where=f"step {first.step}",
            cure="Give the stones that the plan was made from; `drystone check` lists everything.",
        )
    return replay.wall


def replay_plan(plan: Plan, stones: StoneSet) -> Replay:
    """Play a plan again and collect what stands in the way.

    Raises
    ------
    PlanError
        E215: the wall is too large or too small to be an image.
    """
    site = plan_site(plan)
    groups, problems = _grouped(plan.steps)
    canvas = np.zeros((site.height_px, site.width_px), np.uint32)
    wall, broken_at = Wall.empty(site), None
    pieces: list[Piece] = []
    stages: list[Stage] = []
    used: set[int] = set()
    for steps in groups:
        derived, found = _derive(steps, stones, site)
        for piece in derived:
            found += _repeated(piece, used, stones) + _painted(piece, canvas)
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
    return Replay(site, tuple(pieces), canvas, tuple(stages), broken_at, tuple(problems))


def plan_site(plan: Plan) -> Site:
    """Return the site of a plan; raise PlanError (E215) when it is no possible image."""
    source_px = plan.px_per_m or 1.0
    # Metres times px per metre leave rounding errors, which must not decide over a half px.
    width, height = round(plan.width * source_px, 6), round(plan.height * source_px, 6)
    area = width * height * plan.working_scale**2
    if not 0.25 <= area <= MAX_WALL_PX or plan.working_scale * min(width, height) < 0.5:
        raise PlanError(
            "E215",
            f"a wall of {width:g} x {height:g} px at a working scale of {plan.working_scale:g} "
            "cannot be made an image.",
            where="wall",
            cure=f"Its image must have 1 to {MAX_WALL_PX} px.",
        )
    return Site.from_source(width, height, plan.working_scale, plan.px_per_m)


def working_points(points: Sequence[Point], site: Site) -> NDArray[np.float64]:
    """Turn points in plan's units into working px."""
    return np.asarray(np.array(points, float) * (site.px_per_m or 1.0) * site.scale)


def place_stone(step: StoneStep, stones: StoneSet, site: Site) -> Placement:
    """Return where a stone step puts its stone; raise PlanError (E201) when there is none."""
    centre = [quantise(v) for v in working_points([step.centroid], site)[0].tolist()]
    corner = [math.floor(v) for v in centre]
    phase = (centre[0] - corner[0], centre[1] - corner[1])
    stone = stones.by_id(step.stone)
    posed, left, bottom = pose_at(stone, step.angle_deg, site.scale, phase)
    row = site.height_px - (corner[1] + bottom) - posed.height_px
    return Placement(posed, row, corner[0] + left, step.side, step.rotation_moves)


def _grouped(
    steps: Sequence[StoneStep | WedgeStep],
) -> tuple[list[list[StoneStep | WedgeStep]], list[Problem]]:
    """Put each stone and its wedges together (E214 where the order is not the contract's)."""
    groups: list[list[StoneStep | WedgeStep]] = []
    problems = []
    for number, step in enumerate(steps, 1):
        if step.step != number:
            problems.append(Problem("E214", step.step, f"this is step {number} of the plan."))
        if isinstance(step, StoneStep):
            groups.append([step])
            continue
        above = groups[-1][0] if groups else None
        if not isinstance(above, StoneStep) or above.stone != step.under:
            message = f"wedge {step.id} does not follow stone {step.under}, which it supports."
            problems.append(Problem("E214", step.step, message))
        if groups:
            groups[-1].append(step)
    for group in groups:
        early = [s.step for s in group[:-1] if (s.alpha_left, s.alpha_right) != (None, None)]
        problems += [
            Problem("E214", at, "load multipliers are claimed before the stone's last wedge.")
            for at in early
        ]
    return groups, problems


def _derive(
    steps: Sequence[StoneStep | WedgeStep], stones: StoneSet, site: Site
) -> tuple[list[Piece], list[Problem]]:
    """Turn the steps of a group into what they place."""
    pieces: list[Piece] = []
    problems = []
    for step in steps:
        try:
            item = (
                place_stone(step, stones, site)
                if isinstance(step, StoneStep)
                else place_wedge(step, site)
            )
        except PlanError as error:
            code = "E212" if error.code == "E201" else error.code
            problems.append(Problem(code, step.step, error.what))
        else:
            pieces.append(Piece(step, item))
    return pieces, problems


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


def _repeated(piece: Piece, used: set[int], stones: StoneSet) -> list[Problem]:
    """Note an id as used; name it when it was (E213)."""
    if piece.id in used:
        kind = piece.step.kind
        return [Problem("E213", piece.step.step, f"{kind} {piece.id} was placed before.")]
    used.add(piece.id)
    if isinstance(piece.item, Wedge) and piece.id <= max((s.id for s in stones), default=0):
        message = f"wedge {piece.id} has an id that is not larger than every stone's."
        return [Problem("E213", piece.step.step, message)]
    return []


def _painted(piece: Piece, canvas: Labels) -> list[Problem]:
    """Draw a piece where there is room; name what is outside (E220) or taken (E221)."""
    rows, cols = piece.item.window
    height, width = canvas.shape
    name = f"{piece.step.kind} {piece.id}"
    outside = (-rows.start, rows.stop - height, -cols.start, cols.stop - width)
    if max(outside) > 0:
        sides = ("above the top", "below the ground", "left of the left end", "right of the right")
        where = ", ".join(f"{n} px {s}" for n, s in zip(outside, sides, strict=True) if n > 0)
        return [Problem("E220", piece.step.step, f"{name} leaves the site: {where}.")]
    view = canvas[rows, cols]
    taken = view[piece.mask]
    view[piece.mask & (view == 0)] = piece.id
    ids, counts = np.unique(taken[taken > 0], return_counts=True)
    return [
        Problem("E221", piece.step.step, f"{name} overlaps {other} by {count} working px.")
        for other, count in zip(ids.tolist(), counts.tolist(), strict=True)
    ]
