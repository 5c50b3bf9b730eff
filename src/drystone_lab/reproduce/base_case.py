"""Figs. 14 and 15: the base case PR and its failure mechanisms (§5.1); Fig. 19: wedges (§5.2)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import accumulate
from statistics import fmean, median

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.drawing.pictures.mechanism import plot_mechanism
from drystone.drawing.pictures.wall import plot_wall
from drystone.model.placement import Wedge
from drystone.model.wall import Wall
from drystone.statics.failing.mechanism import Names, describe_mechanism
from drystone.statics.flow.nonassociative import NonassociativeResult, nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus
from drystone_lab.pictures.charts import group_panels
from drystone_lab.pictures.walls import Panel, sheet_of, wall_aspect
from drystone_lab.reproduce import cells
from drystone_lab.reproduce.cells import ClaimCheck, rounded
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import Study, StudyWalls, Trials, sheet
from drystone_lab.table import Cell, Table
from drystone_lab.walls import IR, LIU_5, PR

ALPHAS: Mapping[str, float] = {"left": 0.79, "right": 0.71}
"""Load multipliers of §5.1, tilting towards that side."""

EitherResult = LimitResult | NonassociativeResult


@dataclass(frozen=True, eq=False)
class BaseCase:
    """Walls of several seeds, and the mechanisms of the first by both flow rules."""

    built: StudyWalls
    wall: Wall
    model: RigidBlockModel
    pairs: tuple[tuple[LimitResult, NonassociativeResult], ...]

    @property
    def trials(self) -> Trials:
        """The walls."""
        return self.built.all[0]

    def over_mu(self, side: str) -> list[float]:
        """Return the load multipliers of all walls towards a side, over mu."""
        return [a / self.model.mu for a in cells.figures_of(self.trials.outcomes, f"alpha_{side}")]


def base_case(context: Context, study: Study) -> BaseCase:
    """Build the walls, and look at the first one's mechanisms."""
    found = study(context)
    (trials,) = found
    wall = found.wall(trials)
    model = model_from_labels(wall.labels, trials.specs[0].settings().mu).model
    both = lateral_resistance(model, mechanism=True)
    without = nonassociative_resistance(model)
    pairs = ((both.left, without.left), (both.right, without.right))
    return BaseCase(found, wall, model, pairs)


def _summary(case: BaseCase) -> Table:
    row = dict(zip(cells.COLUMNS, cells.summary(case.trials.outcomes), strict=True))
    for side, papers in ALPHAS.items():
        found, name = case.over_mu(side), f"alpha {side} / mu"
        row[f"{name} median"] = rounded(median(found)) if found else None
        row[f"{name} range"] = f"{min(found):.2f} to {max(found):.2f}" if found else None
        row[f"{name} paper"] = papers
    title = f"The base case {case.built.name} over its seeds"
    return Table(title, tuple(row), (tuple(row.values()),))


def _rules(case: BaseCase) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for one, other in case.pairs:
        found: tuple[tuple[EitherResult, str], ...] = (
            (one, "associative"),
            (other, "without dilatancy"),
        )
        for result, rule in found:
            over = None if result.alpha is None else rounded(result.alpha / case.model.mu)
            papers = ALPHAS[result.direction] if result is one else None
            alpha = rounded(result.alpha)
            words = _words(case, result)
            rows.append((result.direction, rule, str(result.status), alpha, over, papers, words))
    return Table(
        "Load multipliers of the drawn wall by both flow rules",
        ("towards", "flow rule", "status", "alpha", "alpha / mu", "paper", "mechanism"),
        tuple(rows),
        ("Without dilatancy: Coulomb friction, the least of the solutions that were found.",),
    )


def _words(case: BaseCase, result: EitherResult) -> str | None:
    if result.mechanism is None:
        return None
    falls = result.status is LimitStatus.UNSTABLE
    wedges = frozenset(wedge.id for wedge in case.wall.wedges)
    return describe_mechanism(
        case.model, result.mechanism, falls=falls, names=Names("stone", wedges)
    ).words


def _pictures(case: BaseCase) -> Iterator[ItemPicture]:
    title = f"{case.built.name}, seed {case.built.seeds[0]}"
    yield sheet(case.built, "fig14", 1, lambda _: title, "The first wall.")
    for one, other in case.pairs:
        named: tuple[tuple[EitherResult, str, str], ...] = (
            (one, "", "associative"), (other, "_coulomb", "no dilatancy"),
        )  # fmt: skip
        for result, name, rule in named:
            if result.mechanism is not None:
                falls = result.status is LimitStatus.UNSTABLE
                towards = None if falls else result.direction
                ax = plot_mechanism(case.wall.labels, result.mechanism, towards, result.alpha)
                figure = ax.get_figure(root=True)
                assert figure is not None  # noqa: S101 - it was made for the axes
                caption = f"Mechanism towards the {one.direction}, {rule}; colours are "
                caption += "displacements over the largest, grey lines the wall before."
                yield ItemPicture(f"fig15_{one.direction}{name}", figure, caption)
    sides = {side: case.over_mu(side) for side in ALPHAS}
    metrics: dict[str, dict[str, Sequence[float | None]]] = {
        name: {case.built.name: case.trials.values(name)} for name in ("F_SF", "F_AV", "F_AH")
    }
    panels = group_panels({"alpha / mu": sides, **metrics}, claims={"alpha / mu": ALPHAS})
    caption = "All seeds; lines are medians, crosses the paper's load multipliers over mu."
    yield ItemPicture("fig14_seeds", panels, caption)


BASE_CASE = PaperItem(
    **paper("fig14-15"),
    study=partial(base_case, study=Study(walls=(PR,), quick_seeds=5)),
    tables={"fig14": _summary, "fig15": _rules},
    pictures=lambda case: tuple(_pictures(case)),
    needs=(PR.source.name,),
)

SHOWN = 3
"""Wedges that are zoomed in on at most."""

ZOOM = 0.25
"""Width of what a zoom shows, over that of the wall."""

ZOOM_ASPECT = 0.6

ZoomBox = tuple[float, float, float, float]


def _wedges_claims(found: StudyWalls) -> Iterator[ClaimCheck]:
    for one in found:
        wall, figures = found.wall(one), one.outcomes[0].figures
        share = 100 * float(figures["wedge_area"] or 0.0) / (one.wall.width * one.wall.height)
        tallest = max((wedge.mask.shape[0] for wedge in wall.wedges), default=0)
        yield ClaimCheck(
            f"Wall {one.wall.number} ({one.wall.name}) needs wedges.",
            f"{len(wall.wedges)} under {len({w.under for w in wall.wedges})} of "
            f"{figures['placed']} stones, {share:.2f} % of the wall's area; the tallest has "
            f"{tallest / _mean_height_px(wall):.0%} of the mean height of a stone.",
            bool(wall.wedges),
        )


def _mean_height_px(wall: Wall) -> float:
    return fmean(placement.posed.mask.shape[0] for placement in wall.placements)


def _wedges_table(found: StudyWalls) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for one in found:
        wall = found.wall(one)
        unit, mean = 1 / wall.site.scale, _mean_height_px(wall)
        for wedge in wall.wedges:
            height, width = wedge.mask.shape
            sizes = (width * unit, height * unit, wedge.area_px * unit**2, height / mean)
            rows.append((one.wall.number, wedge.id, wedge.under, *map(rounded, sizes)))
    return Table(
        "Wedges, in the order of construction",
        (
            "wall", "wedge", "under stone", "width, px", "height, px", "area, px2",
            "height / mean stone height",
        ),
        tuple(rows),
        ("Lengths in px of the source.",),
    )  # fmt: skip


def _wedges_picture(trials: Trials, wall: Wall) -> ItemPicture:
    boxes = [_box(wall, wedge) for wedge in shown(wall)]
    title = f"Wall {trials.wall.number}, {trials.wall.name}\n"
    title += cells.in_words(trials.outcomes[0].figures)
    aspect = wall_aspect(wall.site.height_px / wall.site.width_px)
    sizes = accumulate((1 + len(group.wedges) for group in wall.groups), initial=1)
    steps = dict(zip((group.placement.stone_id for group in wall.groups), sizes, strict=False))
    zooms = [
        Panel(f"{letter}: a wedge under stone {wedge.under} (step {steps[wedge.under]})",
              ZOOM_ASPECT, partial(_draw_zoom, wall, box))
        for letter, wedge, box in zip("abc", shown(wall), boxes, strict=False)
    ]  # fmt: skip
    figure: Figure = sheet_of([Panel(title, aspect, partial(_draw_whole, wall, boxes)), *zooms], 2)
    return ItemPicture(
        f"fig19_wall{trials.wall.number}",
        figure,
        f"Wall {trials.wall.number} ({trials.wall.name}): all wedges in dark red, and the "
        "largest ones from near. Numbers on stones are steps of the plan.",
    )


def shown(wall: Wall) -> list[Wedge]:
    """Return the largest wedges, without those that are seen beside a larger one."""
    found: list[Wedge] = []
    for wedge in sorted(wall.wedges, key=lambda each: (-each.area_px, each.id)):
        x, y = _middle(wall, wedge)
        boxes = (_box(wall, other) for other in found)
        if not any(x0 <= x <= x1 and y0 <= y <= y1 for x0, y0, x1, y1 in boxes):
            found.append(wedge)
    return found[:SHOWN]


def _middle(wall: Wall, wedge: Wedge) -> tuple[float, float]:
    """Return the middle of a wedge in source px, y up."""
    height, width = wedge.mask.shape
    unit = wall.site.units_per_px
    return (wedge.col + width / 2) * unit, (wall.site.height_px - wedge.row - height / 2) * unit


def _box(wall: Wall, wedge: Wedge) -> ZoomBox:
    """Return what a zoom on a wedge shows."""
    x, y = _middle(wall, wedge)
    width = wall.site.width_px * wall.site.units_per_px
    half = ZOOM * width / 2
    # Little of the ground and nothing beyond the ends, which are of no interest.
    x = min(max(x, half), width - half)
    y0 = max(y - ZOOM_ASPECT * half, -0.1 * half)
    return x - half, y0, x + half, y0 + 2 * ZOOM_ASPECT * half


def _draw_whole(wall: Wall, boxes: Sequence[ZoomBox], ax: Axes) -> None:
    plot_wall(wall, None, ax)
    for letter, (x0, y0, x1, y1) in zip("abc", boxes, strict=False):
        ax.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color=OUTLINE_COLOUR, linewidth=0.9,
                linestyle=":", zorder=6)  # fmt: skip
        ax.text(
            x0, y1, letter, fontsize=8, ha="right", va="top", zorder=7, fontweight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
        )  # fmt: skip


def _draw_zoom(wall: Wall, box: ZoomBox, ax: Axes) -> None:
    plot_wall(wall, None, ax)
    ax.set_xlim(box[0], box[2])
    ax.set_ylim(box[1], box[3])


WEDGES = PaperItem(
    **paper("fig19"),
    study=Study(walls=(IR, LIU_5), seeds=1, quick_seeds=1),
    claims=_wedges_claims,
    tables={"fig19": _wedges_table},
    pictures=lambda found: [_wedges_picture(one, found.wall(one)) for one in found],
    needs=(IR.source.name,),
)
