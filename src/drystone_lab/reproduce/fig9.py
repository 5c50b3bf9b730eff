"""Fig. 9: stones that fall where they are tried, turned and wedged (§3.7)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.model.placement import Wedge
from drystone.stabilise.rotate import rotate_to_rest
from drystone.stabilise.stabilise import WedgeStock, make_stable
from drystone.stabilise.support import Pose, falling_side, support_polyline
from drystone_lab.pictures.support import SupportedStone, plot_standing, window_around
from drystone_lab.reproduce.construction import Construction, Moment, construction
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.table import Cell, Table
from drystone_lab.walls import PR, Target


@dataclass(frozen=True, eq=False)
class Unstable:
    """A stone that falls where the rule of placement puts it."""

    moment: Moment
    trial: SupportedStone  # The stone there
    turned: (
        SupportedStone | None
    )  # Where it rests after turning; None when it meets the landscape before
    pivots: int  # About how many points it was turned
    wedged: (
        SupportedStone | None
    )  # In its place on wedges; None when no wedge within the limits holds it

    @property
    def stone_id(self) -> int:
        """Id of the stone."""
        return self.trial.pose[0].stone.id

    @property
    def turn_deg(self) -> float | None:
        """How far it was turned, counter-clockwise, in [-180, 180)."""
        if self.turned is None:
            return None
        turn = self.turned.pose[0].angle_deg - self.trial.pose[0].angle_deg
        return float((turn + 180.0) % 360.0 - 180.0)

    @property
    def sign_agrees(self) -> bool:
        """Whether AB x AC says to which side the centre of mass is beyond A."""
        return (self.trial.cross < 0) == (self.trial.falls > 0)

    @property
    def hangs(self) -> bool:
        """Whether its centre of mass is below A."""
        return self.trial.mass[1] < self.trial.ends[0][1]


def unstable_trials(built: Construction) -> tuple[int, tuple[Unstable, ...]]:
    """Try every stone that is left before each step of a run.

    Returns how many were tried and had a position, and those that fall.
    """
    count, found = 0, []
    for moment in built.moments:
        for stone_id in moment.remaining:
            trial = moment.trial(stone_id)
            if trial is None:
                continue
            count += 1
            standing = _standing(moment, trial)
            if standing is not None and standing.falls:
                found.append(_treated(moment, standing))
    return count, tuple(found)


def _treated(moment: Moment, trial: SupportedStone) -> Unstable:
    """Turn a stone that falls, and wedge it instead."""
    occupied, workshop = moment.wall.occupied, moment.workshop
    settings = moment.settings.stabilise
    rotation = rotate_to_rest(occupied, trial.pose, workshop.book, settings)
    turned = None if rotation.pose is None else _standing(moment, rotation.pose)
    wedging = replace(settings, method="wedge")
    first = max([workshop.stock.largest_id, *(wedge.id for wedge in moment.wall.wedges)]) + 1
    stock = WedgeStock(first, workshop.stock.mean_height_px)
    cut = make_stable(occupied, trial.pose, "left", workshop.book, stock, wedging).stabilised
    wedged = None if cut is None else _standing(moment, trial.pose, cut.wedges)
    return Unstable(moment, trial, turned, rotation.pivots, wedged)


def _standing(moment: Moment, pose: Pose, wedges: tuple[Wedge, ...] = ()) -> SupportedStone | None:
    """Return a stone on what is there and its wedges; None when nothing supports it."""
    scene = moment.wall.occupied.copy()
    for wedge in wedges:
        scene[wedge.window] |= wedge.mask
    support = support_polyline(scene, *pose)
    if support is None:
        return None
    falls = falling_side(support, pose, moment.settings.stabilise)
    return SupportedStone(pose, support, falls, wedges, len(scene))


PANEL_IN = (3.1, 2.3)

WIDE = 0.1
"""Cases that are drawn have a support at least this wide, in widths of the stone, so that AB is
seen, unless there is none."""


@dataclass(frozen=True, eq=False)
class Falls:
    """What was tried before each step of a run, what falls there, and the cases that are drawn."""

    wall: Target
    trials: int
    unstable: tuple[Unstable, ...]

    @property
    def shown(self) -> tuple[Unstable, ...]:
        """One that is turned, and one that has to be wedged."""
        return _shown(self.unstable)


def falls(context: Context, wall: Target = PR) -> Falls:
    """Try all stones that are left before each step of a run, and treat those that fall."""
    spec = wall.run(context.seed)
    return Falls(wall, *unstable_trials(construction(context, spec)))


def _shown(unstable: Sequence[Unstable]) -> tuple[Unstable, ...]:
    """Return the case that is turned most, and that of the largest wedge where turning fails."""
    turned = [one for one in unstable if one.turned is not None and one.wedged is not None]
    stuck = [one for one in unstable if one.turned is None and one.wedged is not None]
    most = max(_wide(turned), key=lambda one: abs(one.turn_deg or 0.0), default=None)
    largest = max(_wide(stuck), key=_wedge_area, default=None)
    return tuple(one for one in (most, largest) if one is not None)


def _wide(cases: Sequence[Unstable]) -> Sequence[Unstable]:
    wide = [
        one for one in cases
        if one.trial.support.right_x - one.trial.support.left_x
        >= WIDE * one.trial.pose[0].width_px
    ]  # fmt: skip
    return wide or cases


def _wedge_area(case: Unstable) -> int:
    return sum(wedge.area_px for wedge in case.wedged.wedges) if case.wedged is not None else 0


def _counts(found: Falls) -> Table:
    unstable = found.unstable
    turned = [one for one in unstable if one.turned is not None]
    stuck = [one for one in unstable if one.turned is None]
    rows: tuple[tuple[Cell, ...], ...] = (
        ("tried", found.trials),
        ("not stable", len(unstable)),
        ("stable after turning", len(turned)),
        ("of these, a wedge would do as well", sum(one.wedged is not None for one in turned)),
        ("turning fails, a wedge does", sum(one.wedged is not None for one in stuck)),
        ("neither", sum(one.wedged is None for one in stuck)),
        ("sign of AB x AC is wrong", sum(not one.sign_agrees for one in unstable)),
        ("of these, C is below A", sum(not one.sign_agrees and one.hangs for one in unstable)),
    )
    return Table("Trial placements of a run, every stone that is left before each step",
                 ("what", "count"), rows)  # fmt: skip


def _cases(shown: Sequence[Unstable]) -> Table:
    columns = (
        "stone", "before step", "pose", "A", "B", "C", "AB x AC", "turned deg", "pivots",
        "wedge height px", "wedge width px",
    )  # fmt: skip
    rows = []
    for case in shown:
        rows.append(_row(case, "tried", case.trial))
        if case.turned is not None:
            rows.append(_row(case, "turned", case.turned))
        if case.wedged is not None:
            rows.append(_row(case, "wedged", case.wedged))
    return Table(
        "The stones that are drawn", columns, tuple(rows),
        ("Points in working px of the wall, y up from the ground; angles counter-clockwise.",),
    )  # fmt: skip


def _row(case: Unstable, pose: str, standing: SupportedStone) -> tuple[Cell, ...]:
    a, b = standing.ends
    points = [f"{x:.4g}, {y:.4g}" for x, y in (a, b, standing.mass)]
    turn: Cell = case.turn_deg if pose == "turned" else None
    pivots: Cell = case.pivots if pose == "turned" else None
    size: tuple[Cell, Cell] = (None, None)
    if standing.wedges:
        size = (standing.wedges[0].mask.shape[0], standing.wedges[0].mask.shape[1])
    cross = round(standing.cross, 2)
    return (case.stone_id, case.moment.number, pose, *points, cross, turn, pivots, *size)


def _picture(shown: Sequence[Unstable], name: str) -> ItemPicture:
    size = (3 * PANEL_IN[0], len(shown) * PANEL_IN[1])
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(shown), 3, squeeze=False)
    for axes, case in zip(panels.tolist(), shown, strict=True):
        _draw_case(axes, case)
    return ItemPicture(
        "fig9", figure,
        f"Stones that fall where they are tried, in a run of {name}: A and B are the ends of the "
        "support, A the one nearer to the centre of mass C, C' its projection; the arrow is the "
        "sense of turning. Turned: dashed where it was. Wedged: the wedge (dark red) with its "
        "height and width in working px; grey is the supported side, which wedging leaves alone.",
    )  # fmt: skip


def _draw_case(axes: Sequence[Axes], case: Unstable) -> None:
    stands = [one for one in (case.trial, case.turned, case.wedged) if one is not None]
    window, labels = window_around(stands), case.moment.wall.labels
    title = f"stone {case.stone_id} before step {case.moment.number}: falls"
    plot_standing(labels, case.trial, window, axes[0], title=title)
    turned = "" if case.turn_deg is None else f"turned by {case.turn_deg:g}°"
    for ax, standing, text in ((axes[1], case.turned, turned), (axes[2], case.wedged, "wedged")):
        if standing is not None:
            plot_standing(labels, standing, window, ax, before=case.trial, title=text)
        else:
            ax.set_axis_off()
            ax.text(0.5, 0.5, "fails: it meets what is there,\nor a limit, before it rests",
                    ha="center", va="center",
                    size=8, transform=ax.transAxes)  # fmt: skip


STABILISING = PaperItem(
    **paper("fig9"),
    study=falls,
    tables={"counts": _counts, "cases": lambda found: _cases(found.shown)},
    pictures=lambda found: (_picture(found.shown, found.wall.name),) if found.shown else (),
    needs=(PR.source.name,),
)
