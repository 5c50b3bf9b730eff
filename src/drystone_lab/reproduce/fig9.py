"""Fig. 9: stones that fall where they are tried, turned and wedged (§3.7)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Rectangle
from matplotlib.patheffects import withStroke

from drystone.drawing.canvas import draw_block, fit_axes
from drystone.drawing.outlines import Bounds, Loop, label_regions, regions_box
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, WEDGE_COLOUR
from drystone.kernels.raster import Mask
from drystone.model.placement import Placement, Wedge
from drystone.model.wall import Labels
from drystone.stabilise import stabilise
from drystone.stabilise.stabilise import Pose, Support
from drystone_lab.reproduce.construction import Moment, construction
from drystone_lab.reproduce.item import Context, ItemFigure, PaperItem
from drystone_lab.table import Rows
from drystone_lab.walls import PR, Target

BUILT, STONE, GHOST = "#e4e0d8", "#9ecae1", "#0072b2"
LINE, MASS = "#d55e00", "#000000"

PointXY = tuple[float, float]


class SupportedStone(NamedTuple):
    """A stone where it is."""

    pose: Pose  # The stone and the row and column of its mask
    support: Support  # Its support, over wedges as well
    falls: int  # Side to which it falls: -1 left, +1 right, 0 stable
    wedges: tuple[Wedge, ...]  # Under it
    height_px: int

    @property
    def mass(self) -> PointXY:
        """Centre of mass C."""
        return Placement(*self.pose).centroid(self.height_px)

    @property
    def ends(self) -> tuple[PointXY, PointXY]:
        """A, the end of the support that is nearer to the centre of mass, and B."""
        left = float(self.support.left_x), float(self.height_px - self.support.left_row)
        right = float(self.support.right_x), float(self.height_px - self.support.right_row)
        x = self.mass[0]
        return (left, right) if abs(x - left[0]) < abs(x - right[0]) else (right, left)

    @property
    def cross(self) -> float:
        """AB x AC: positive turns counter-clockwise (§3.7)."""
        (x_a, y_a), (x_b, y_b) = self.ends
        x_c, y_c = self.mass
        return (x_b - x_a) * (y_c - y_a) - (y_b - y_a) * (x_c - x_a)

    @property
    def loops(self) -> list[Loop]:
        """Boundary of the stone."""
        posed, row, col = self.pose
        return _loops(posed.mask, row, col, self.height_px)


def _loops(mask: Mask, row: int, col: int, height_px: int) -> list[Loop]:
    """Return the boundary of a mask at a place of a landscape."""
    (region,) = label_regions(mask.astype(np.uint32))
    return [loop + np.array([col, height_px - row - len(mask)]) for loop in region.loops]


def plot_standing(
    ax: Axes,
    labels: Labels,
    standing: SupportedStone,
    window: Bounds,
    *,
    before: SupportedStone | None = None,
    title: str = "",
) -> None:
    """Draw a stone on its support with the points of Fig. 9.

    `labels` is the landscape without the stone, `window` what is shown of it, working px;
    `before` is where the stone was at first, dashed.
    """
    ax = fit_axes(ax, window)
    for region in label_regions(labels):
        draw_block(ax, region.loops, f"block-{region.id}", fill=BUILT, edgecolor=GREY,
                   linewidth=0.5)  # fmt: skip
    if window[1] <= 0:
        ax.plot([window[0], window[2]], [0, 0], color=OUTLINE_COLOUR, linewidth=1.4, gid="ground")
    if standing.wedges:
        # The supported side, which wedging leaves alone (grey in Fig. 9c)
        first = before or standing
        left, bottom, right, top = regions_box([first.loops])
        x_a = first.ends[0][0]
        start, end = (left, x_a) if first.falls > 0 else (x_a, right)
        ax.add_patch(Rectangle((start, bottom), end - start, top - bottom, facecolor=GREY,
                               alpha=0.45, gid="supported", zorder=3))  # fmt: skip
    draw_block(ax, standing.loops, "stone", fill=STONE, zorder=2)
    if before is not None and not standing.wedges:
        draw_block(ax, before.loops, "before", edgecolor=GHOST, linestyle=(0, (3, 2)), zorder=3)
    for wedge in standing.wedges:
        tall, wide = wedge.mask.shape
        low = standing.height_px - wedge.row - tall
        loops = _loops(wedge.mask, wedge.row, wedge.col, standing.height_px)
        draw_block(ax, loops, f"wedge-{wedge.id}", fill=WEDGE_COLOUR, zorder=4)
        _write(ax, f"h {tall}, w {wide}", (wedge.col + wide / 2, float(low)), (0.0, -8.0))
    _draw_points(ax, standing)
    if standing.falls:
        _draw_turn(ax, standing)
    ax.set_xlabel("working px", fontsize=7, labelpad=1)
    ax.set_title(title, fontsize=7, loc="left", pad=3)


def _draw_points(ax: Axes, standing: SupportedStone) -> None:
    """Draw A, B and the line between them, C and its projection C'."""
    a, b = standing.ends
    x_c, y_c = standing.mass
    share = 0.0 if a[0] == b[0] else (x_c - a[0]) / (b[0] - a[0])
    y_on = a[1] + share * (b[1] - a[1]) if 0 <= share <= 1 else a[1]
    ax.plot([a[0], b[0]], [a[1], b[1]], "-o", color=LINE, linewidth=1.8, markersize=4, gid="AB",
            zorder=5)  # fmt: skip
    ax.plot([x_c, x_c], [y_c, y_on], color=MASS, linewidth=0.9, linestyle=(0, (2, 2)),
            gid="projection", zorder=5)  # fmt: skip
    ax.plot([x_c], [y_c], "+", color=MASS, markersize=9, markeredgewidth=1.5, gid="C", zorder=6)
    ax.plot([x_c], [y_on], "x", color=MASS, markersize=5, gid="C'", zorder=6)
    side = 1 if a[0] >= b[0] else -1
    _write(ax, "A", a, (5.0 * side, -7.0))
    _write(ax, "B", b, (-5.0 * side, -7.0))
    _write(ax, "C", (x_c, y_c), (7.0 * side, 4.0))
    _write(ax, "C'", (x_c, y_on), (7.0 * side, 5.0))


def _write(ax: Axes, text: str, at: PointXY, offset: PointXY) -> None:
    ax.annotate(text, at, offset, textcoords="offset points", size=7.5, ha="center", va="center",
                zorder=7, path_effects=[withStroke(linewidth=1.8, foreground="white")])  # fmt: skip


def _draw_turn(ax: Axes, standing: SupportedStone) -> None:
    left, _, right, top = regions_box([standing.loops])
    middle, reach = (left + right) / 2, 0.25 * (right - left)
    side = standing.falls
    arrow = FancyArrowPatch(
        (middle - side * reach, top + 1.5), (middle + side * reach, top + 1.5),
        connectionstyle=f"arc3,rad={-0.35 * side}", arrowstyle="-|>", mutation_scale=9,
        linewidth=1.3, color=LINE, gid="turn", zorder=6,
    )  # fmt: skip
    ax.add_patch(arrow)


class Unstable(NamedTuple):
    """A stone that falls where the rule of placement puts it."""

    moment: Moment
    trial: SupportedStone  # The stone there
    # Where it rests after turning; None when it meets the landscape before
    turned: SupportedStone | None
    pivots: int  # About how many points it was turned
    # In its place on wedges; None when no wedge within the limits holds it
    wedged: SupportedStone | None

    @property
    def turn_deg(self) -> float | None:
        """How far it was turned, counter-clockwise, in [-180, 180)."""
        if self.turned is None:
            return None
        turn = self.turned.pose[0].angle_deg - self.trial.pose[0].angle_deg
        return float((turn + 180.0) % 360.0 - 180.0)


def _treated(moment: Moment, trial: SupportedStone) -> Unstable:
    """Turn a stone that falls, and wedge it instead."""
    occupied, workshop = moment.wall.occupied, moment.workshop
    settings = moment.settings.stabilise
    rotation = stabilise.rotate_to_rest(occupied, trial.pose, workshop.book, settings)
    turned = None if rotation.pose is None else _standing(moment, rotation.pose)
    wedging = replace(settings, method="wedge")
    first = max([workshop.stones.stones[-1].id, *(wedge.id for wedge in moment.wall.wedges)]) + 1
    stock = stabilise.WedgeStock(first, workshop.stock.mean_height_px)
    cut = stabilise.make_stable(
        occupied, trial.pose, "left", workshop.book, stock, wedging
    ).stabilised
    wedged = None if cut is None else _standing(moment, trial.pose, cut.wedges)
    return Unstable(moment, trial, turned, rotation.pivots, wedged)


def _standing(moment: Moment, pose: Pose, wedges: tuple[Wedge, ...] = ()) -> SupportedStone | None:
    """Return a stone on what is there and its wedges; None when nothing supports it."""
    scene = moment.wall.occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    support = stabilise.support_polyline(scene, *pose)
    if support is None:
        return None
    falls = stabilise.falling_side(support, pose, moment.settings.stabilise)
    return SupportedStone(pose, support, falls, wedges, len(scene))


class Falls(NamedTuple):
    """What was tried before each step of a run, what falls there, and the cases that are drawn."""

    trials: int  # Those that had a position
    unstable: tuple[Unstable, ...]

    @property
    def shown(self) -> tuple[Unstable, ...]:
        """The case that is turned most, and that of the largest wedge where turning fails."""

        def wedge_area(case: Unstable) -> int:
            return sum(wedge.area_px for wedge in case.wedged.wedges) if case.wedged else 0

        wedged = [one for one in self.unstable if one.wedged is not None]
        turned = [one for one in wedged if one.turned is not None]
        stuck = [one for one in wedged if one.turned is None]
        most = _largest(turned, lambda one: abs(one.turn_deg or 0.0))
        return (*most, *_largest(stuck, wedge_area))


def falls(context: Context, wall: Target = PR) -> Falls:
    """Try all stones that are left before each step of a run, and treat those that fall."""
    count, found = 0, []
    for moment in construction(context, wall):
        for stone_id in moment.remaining:
            trial = moment.trial(stone_id)
            if trial is None:
                continue
            count += 1
            standing = _standing(moment, trial)
            if standing is not None and standing.falls:
                found.append(_treated(moment, standing))
    return Falls(count, tuple(found))


def _largest(cases: Sequence[Unstable], size: Callable[[Unstable], float]) -> Sequence[Unstable]:
    """Return the largest case, if any: of those whose support is wide enough to see AB."""
    wide = [
        one for one in cases
        if one.trial.support.right_x - one.trial.support.left_x
        >= 0.1 * one.trial.pose[0].width_px
    ]  # fmt: skip
    return sorted(wide or cases, key=size, reverse=True)[:1]


def _counts(found: Falls) -> Rows:
    unstable = found.unstable
    turned = [one for one in unstable if one.turned is not None]
    stuck = [one for one in unstable if one.turned is None]
    # Those that AB x AC would turn to the side on which the centre of mass is not beyond A.
    wrong = [one for one in unstable if (one.trial.cross < 0) != (one.trial.falls > 0)]
    yield "tried", found.trials
    yield "not stable", len(unstable)
    yield "stable after turning", len(turned)
    yield "of these, a wedge would do as well", sum(one.wedged is not None for one in turned)
    yield "turning fails, a wedge does", sum(one.wedged is not None for one in stuck)
    yield "neither", sum(one.wedged is None for one in stuck)
    yield "sign of AB x AC is wrong", len(wrong)
    yield "of these, C is below A", sum(one.trial.mass[1] < one.trial.ends[0][1] for one in wrong)


def _cases(found: Falls) -> Rows:
    for case in found.shown:
        for pose, standing in (
            ("tried", case.trial), ("turned", case.turned), ("wedged", case.wedged),
        ):  # fmt: skip
            if standing is None:
                continue
            points = [f"{x:.4g}, {y:.4g}" for x, y in (*standing.ends, standing.mass)]
            turn = (case.turn_deg, case.pivots) if pose == "turned" else (None, None)
            size = standing.wedges[0].mask.shape if standing.wedges else (None, None)
            cross = round(standing.cross, 2)
            stone_id = case.trial.pose[0].stone.id
            yield stone_id, case.moment.number, pose, *points, cross, *turn, *size


def _picture(found: Falls) -> ItemFigure:
    figure = Figure(figsize=(9.3, len(found.shown) * 2.3), layout="constrained")
    panels = figure.subplots(len(found.shown), 3, squeeze=False)
    for axes, case in zip(panels.tolist(), found.shown, strict=True):
        stands = [one for one in (case.trial, case.turned, case.wedged) if one is not None]
        left, bottom, right, top = regions_box(one.loops for one in stands)
        window = left - 12.0, max(bottom - 12.0, -2.0), right + 12.0, top + 6.0
        labels = case.moment.wall.labels
        title = f"stone {case.trial.pose[0].stone.id} before step {case.moment.number}: falls"
        plot_standing(axes[0], labels, case.trial, window, title=title)
        turned = "" if case.turn_deg is None else f"turned by {case.turn_deg:g}°"
        others = (axes[1], case.turned, turned), (axes[2], case.wedged, "wedged")
        for ax, standing, text in others:
            if standing is not None:
                plot_standing(ax, labels, standing, window, before=case.trial, title=text)
            else:
                ax.set_axis_off()
                ax.text(0.5, 0.5, "fails: it meets what is there,\nor a limit, before it rests",
                        ha="center", va="center", size=8, transform=ax.transAxes)  # fmt: skip
    return ItemFigure("fig9", figure)


STABILISING = PaperItem(
    study=falls,
    tables={"counts": _counts, "cases": _cases},
    pictures=lambda found: [_picture(found)] if found.shown else [],
)
