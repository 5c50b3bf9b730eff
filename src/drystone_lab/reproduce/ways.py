"""Walls of §5.1 and §5.2 and B.1: the base case PR, how it fails, wedges, and settings compared."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from statistics import fmean
from typing import NamedTuple

from matplotlib.axes import Axes

from drystone.contacts.blocks import model_from_labels
from drystone.drawing.drawing import step_by_id
from drystone.drawing.outlines import Bounds
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
from drystone_lab import cells, walls
from drystone_lab.cells import METRICS, rounded
from drystone_lab.pictures import Panel, group_panels, plot_two_figures, sheet_of, wall_aspect
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem, StudyWalls, Trials
from drystone_lab.reproduce.items import ITEMS
from drystone_lab.runs.spec import Changes
from drystone_lab.table import Rows
from drystone_lab.walls import IR, PR, R, Target

ALPHAS: Mapping[str, float] = {"left": 0.79, "right": 0.71}
"""Load multipliers of §5.1, tilting towards that side."""


class BaseCase(NamedTuple):
    """Walls of several seeds, and the mechanisms of the first by both flow rules."""

    trials: Trials
    wall: Wall
    model: RigidBlockModel
    # Flow rule and result, both rules of the left side first
    mechanisms: tuple[tuple[str, LimitResult | NonassociativeResult], ...]

    def over_mu(self, side: str) -> list[float]:
        """Return the load multipliers of all walls towards a side, over mu."""
        return [a / self.model.mu for a in cells.figures_of(self.trials.outcomes, f"alpha_{side}")]


def base_case(found: StudyWalls) -> BaseCase:
    """Look at the mechanisms of the first wall."""
    (trials,) = found
    wall = trials.built()
    model = model_from_labels(wall.labels, trials.specs[0].settings().mu).model
    both = lateral_resistance(model, mechanism=True)
    without = nonassociative_resistance(model)
    mechanisms = (
        ("associative", both.left), ("without dilatancy", without.left),
        ("associative", both.right), ("without dilatancy", without.right),
    )  # fmt: skip
    return BaseCase(trials, wall, model, mechanisms)


def _summary(case: BaseCase) -> Rows:
    row = [*cells.summary(case.trials.outcomes)]
    for side, papers in ALPHAS.items():
        found = case.over_mu(side)
        words = f"{min(found):.2f} to {max(found):.2f}" if found else None
        row += [rounded(cells.median_of(found)), words, papers]
    yield tuple(row)


def _rules(case: BaseCase) -> Rows:
    wedges = frozenset(wedge.id for wedge in case.wall.wedges)
    for rule, result in case.mechanisms:
        over = None if result.alpha is None else rounded(result.alpha / case.model.mu)
        papers = ALPHAS[result.direction] if rule == "associative" else None
        words = None
        if result.mechanism is not None:
            falls = result.status is LimitStatus.UNSTABLE
            names = Names("stone", wedges)
            words = describe_mechanism(case.model, result.mechanism, falls=falls, names=names).words
        alpha = rounded(result.alpha)
        yield result.direction, rule, str(result.status), alpha, over, papers, words


def _pictures(case: BaseCase) -> Iterator[ItemFigure]:
    name = case.trials.wall.name
    title = f"{name}, seed {case.trials.specs[0].seed}"
    yield ItemFigure("fig14", sheet_of([case.trials.titled(title)], 1))
    for rule, result in case.mechanisms:
        if result.mechanism is not None:
            falls = result.status is LimitStatus.UNSTABLE
            towards = None if falls else result.direction
            ax = plot_mechanism(case.wall.labels, result.mechanism, towards, result.alpha)
            loose = rule != "associative"
            about = (result.direction, "no dilatancy" if loose else rule)
            yield ItemFigure(f"fig15_{result.direction}{'_coulomb' * loose}", ax.figure, about)
    metrics: dict[str, dict[str, Sequence[float | None]]] = {
        "alpha / mu": {side: case.over_mu(side) for side in ALPHAS},
        **{metric: {name: case.trials.values(metric)} for metric in ("F_SF", "F_AV", "F_AH")},
    }
    yield ItemFigure("fig14_seeds", group_panels(metrics, claims={"alpha / mu": ALPHAS}))


BASE_CASE = PaperItem(
    then=base_case,
    tables={"fig14": _summary, "fig15": _rules},
    pictures=_pictures,
)

ZOOM_ASPECT = 0.6


def _wedges_claims(found: StudyWalls) -> Iterator[Claimed]:
    for one in found:
        wall, figures = one.built(), one.outcomes[0].figures
        area = float(figures["wedge_area"] or 0.0)
        tallest = max((wedge.mask.shape[0] for wedge in wall.wedges), default=0)
        yield Claimed(
            "needed", bool(wall.wedges), number=one.wall.number, name=one.wall.name,
            count=len(wall.wedges), under=len({wedge.under for wedge in wall.wedges}),
            placed=figures["placed"], share=100 * area / (one.wall.width * one.wall.height),
            tallest=tallest / fmean(stone.posed.height_px for stone in wall.placements),
        )  # fmt: skip


def _wedges(found: StudyWalls) -> Rows:
    for one in found:
        wall = one.built()
        unit = 1 / wall.site.scale
        mean = fmean(stone.posed.height_px for stone in wall.placements)
        for wedge in wall.wedges:
            height, width = wedge.mask.shape
            sizes = (width * unit, height * unit, wedge.area_px * unit**2, height / mean)
            yield one.wall.number, wedge.id, wedge.under, *map(rounded, sizes)


def _wedges_picture(trials: Trials) -> ItemFigure:
    wall = trials.built()
    zoomed = [
        (letter, wedge, _box(wall, wedge))
        for letter, wedge in zip("abc", shown(wall), strict=False)
    ]
    title = f"Wall {trials.wall.number}, {trials.wall.name}\n"
    title += cells.in_words(trials.outcomes[0].figures)
    aspect = wall_aspect(wall.site.height_px / wall.site.width_px)
    steps = step_by_id(wall)

    def draw_whole(ax: Axes) -> None:
        plot_wall(wall, None, ax)
        for letter, _, (x0, y0, x1, y1) in zoomed:
            ax.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color=OUTLINE_COLOUR,
                    linewidth=0.9, linestyle=":", zorder=6)  # fmt: skip
            ax.text(
                x0, y1, letter, fontsize=8, ha="right", va="top", zorder=7, fontweight="bold",
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
            )  # fmt: skip

    def draw_zoom(box: Bounds, ax: Axes) -> None:
        plot_wall(wall, None, ax)
        ax.set_xlim(box[0], box[2])
        ax.set_ylim(box[1], box[3])

    zooms = [
        Panel(f"{letter}: a wedge under stone {wedge.under} (step {steps[wedge.under]})",
              ZOOM_ASPECT, partial(draw_zoom, box))
        for letter, wedge, box in zoomed
    ]  # fmt: skip
    figure = sheet_of([Panel(title, aspect, draw_whole), *zooms], 2)
    return ItemFigure(f"fig19_wall{trials.wall.number}", figure, trials.wall)


def shown(wall: Wall) -> list[Wedge]:
    """Return the three largest wedges, without those that are seen beside a larger one."""
    found: list[Wedge] = []
    for wedge in sorted(wall.wedges, key=lambda each: (-each.area_px, each.id)):
        x, y = _middle(wall, wedge)
        boxes = (_box(wall, other) for other in found)
        if not any(x0 <= x <= x1 and y0 <= y <= y1 for x0, y0, x1, y1 in boxes):
            found.append(wedge)
    return found[:3]


def _middle(wall: Wall, wedge: Wedge) -> tuple[float, float]:
    """Return the middle of a wedge in source px, y up."""
    height, width = wedge.mask.shape
    unit = wall.site.units_per_px
    return (wedge.col + width / 2) * unit, (wall.site.height_px - wedge.row - height / 2) * unit


def _box(wall: Wall, wedge: Wedge) -> Bounds:
    """Return what a zoom on a wedge shows: a quarter of the width of the wall."""
    x, y = _middle(wall, wedge)
    width = wall.site.width_px * wall.site.units_per_px
    half = 0.25 * width / 2
    # Little of the ground and nothing beyond the ends, which are of no interest.
    x = min(max(x, half), width - half)
    y0 = max(y - ZOOM_ASPECT * half, -0.1 * half)
    return x - half, y0, x + half, y0 + 2 * ZOOM_ASPECT * half


WEDGES = PaperItem(
    claims=_wedges_claims,
    tables={"fig19": _wedges},
    pictures=lambda found: map(_wedges_picture, found),
)


def _beta_picture(found: StudyWalls) -> Iterator[ItemFigure]:
    panels = {
        f"{group.name}, {figure}": {one.way: one.values(figure) for one in group}
        for group in found.by_wall
        for figure in METRICS
    }
    title = "Walls by the threshold beta of GDS; lines are medians"
    yield ItemFigure("beta", group_panels(panels, title=title))


BETA = PaperItem(pictures=_beta_picture)


def _sampling_claims(found: StudyWalls) -> Iterator[Claimed]:
    counts = {one.way: one.least("candidates") for one in found}
    ratios = (f"{way} {count / counts['variant']:.2f}" for way, count in counts.items())
    # The paper counts sub-iterations: whether that agrees cannot be told.
    yield Claimed("twice", None, ratios=", ".join(ratios))
    whole = ", ".join(f"{one.way} {one.whole}" for one in found)
    ends = Counter(outcome.plan["stopped"] for one in found for outcome in one.outcomes)
    stopped = ", ".join(f"'{reason}' {count} times" for reason, count in ends.most_common())
    yield Claimed("filled", None, whole=whole, seeds=len(found.seeds), stopped=stopped)
    (full,) = found.of("full")
    plans = [outcome.plan["steps"] for outcome in full.outcomes]
    kinds = sum(plan not in plans[:place] for place, plan in enumerate(plans))
    yield Claimed("chance", kinds == 1, kinds=kinds)


SAMPLING = PaperItem(claims=_sampling_claims)


def _stabilised_claims(found: StudyWalls) -> Iterator[Claimed]:
    for group in found.by_wall:
        filled = {one.way: one.least("F_SF") for one in group}
        best = max(filled, key=lambda way: filled[way])
        yield Claimed("together", best == "both", name=group.name, best=best)


def _stabilised_pictures(found: StudyWalls) -> Iterator[ItemFigure]:
    for number, group in enumerate(found.by_wall, 1):
        points = {one.way: (one.values("wedge_share"), one.values("F_SF")) for one in group}
        # The set is named in the picture itself, as one of them stands in for the paper's.
        across = f"{group.name}: area of wedges, % of the wall"
        ax = plot_two_figures(points, across=across, up="F_SF")
        yield ItemFigure(f"fig20_{number}", ax.figure, group)


STABILISATION = PaperItem(claims=_stabilised_claims, pictures=_stabilised_pictures)

NAMED, RELEASED, CAUSES = (
    {name: tuple(changes.items()) for name, changes in ways.items()}
    for ways in ITEMS["variants"]["ways"].values()
)
"""What else the paper's method could be; what the released code comes with; what might keep PR from
its 32 stones."""

VARIED: tuple[tuple[Target, dict[str, Changes]], ...] = (
    (R, NAMED | RELEASED),
    (PR, NAMED | RELEASED | CAUSES),
    (walls.PR_FREE_596, RELEASED | CAUSES),
    (IR, RELEASED),
    *((wall, {}) for wall in walls.FRAMED),
)
"""Walls, and by what else they are built; 596 px is the width of the authors' released times."""


def named_variants(
    context: Context,
    varied: Sequence[tuple[Target, dict[str, Changes]]] = VARIED,
    count: int = 20,
) -> StudyWalls:
    """Build walls by variants of the paper's method."""
    if context.quick:
        varied, count = [(wall, NAMED) for wall in walls.COARSE], 2
    seeds = range(context.seed, context.seed + count)
    each = (
        StudyWalls.built(context, (wall,), {"paper": (), **ways}, seeds) for wall, ways in varied
    )
    return StudyWalls(one for found in each for one in found)


VARIANTS = PaperItem(
    study=named_variants,
    pictures=lambda found: [
        group.strips(f"variants_{number}", ("placed", "F_SF", "F_LR"), "{0.way}")
        for number, group in enumerate(found.by_wall, 1)
        if len(group) > 1
    ],
)


def _methods_pictures(found: StudyWalls) -> Iterator[ItemFigure]:
    for group in found.by_wall:
        number = {"R": "B.30", "PR": "B.31", "IR": "B.32"}[group.name]
        drawn = group.sheet(f"fig{number.replace('.', '')}", 2, "{0.way}")
        yield drawn._replace(about=(number, group.name))


ALL_METHODS = PaperItem(pictures=_methods_pictures)
