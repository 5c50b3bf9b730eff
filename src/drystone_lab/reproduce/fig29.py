"""Fig. 29: the wall PR at several resolutions, and the time against pixels (§6.3)."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from matplotlib.figure import Figure

from drystone.planner.settings import method_settings
from drystone_lab.pictures.growth import GROWTH_IN
from drystone_lab.pictures.wall_grid import plot_walls
from drystone_lab.reproduce.base import PR, PaperWall
from drystone_lab.reproduce.findings import Finding, findings_table
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.summary import METRICS, metric_cells
from drystone_lab.reproduce.timing import how_timed, repeats, task_of
from drystone_lab.runs.outcome import Outcome
from drystone_lab.runs.spec import RunSpec
from drystone_lab.table import Cell, Table
from drystone_lab.time_tables import PAPER_STEP_S, PAPER_WALL_S, pixels_table, plot_pixels
from drystone_lab.timed_walls import Planned, exponent, planned, size_of

SCALES = (0.5, 1.0, 1.5, 2.0)
"""Of the paper's size, 280 x 80 px."""

QUADRATIC, TOLERANCE = 2.0, 0.5
"""Exponent over the scale that the paper finds, and how far another one is from it at most."""

PAPER = (
    "Fig. 29 (§6.3): the stones PR at resolutions of .5, 1, 1.5 and 2 times 280 x 80 px, each "
    "stone in one colour, and the time of the wall and of its longest step. 'There is a quadratic "
    "relationship between the resolution scale and the computation cost'; 'when the image is of "
    "size 140 x 40, it only takes 0.18 min to stack 32 stones'; at the highest resolution 'the "
    "maximum step time remains below 25 s'. Other times are only in the picture. 'The difference "
    "in stone layout results from the non-deterministic nature of the algorithm.'",
)


def make(context: Context, wall: PaperWall = PR, scales: Sequence[float] = SCALES) -> Output:
    """Plan a wall at several resolutions, to be drawn and by the clock.

    Parameters
    ----------
    context : Context
        `quick` times each wall once.
    wall : PaperWall
        Stones, size and scale 1.
    scales : sequence of float
        Of its scale.
    """
    specs = {s: replace(wall, scale=s * wall.scale).run(context.seed) for s in scales}
    outcomes = dict(zip(scales, context.run(list(specs.values())), strict=True))
    task, settings = task_of(context, wall), method_settings("paper")
    timed = {
        s: planned(
            task, s * wall.scale, settings, seed=context.seed, repeats=repeats(context)
        )
        for s in scales
    }  # fmt: skip
    return Output(
        paper=PAPER,
        ours=(_layouts(outcomes), how_timed(context)),
        tables=(("walls", _walls(timed, outcomes)),),
        times=(
            ("claims", findings_table("The paper's claims about resolution", findings(timed))),
            ("pixels", pixels_table(task.name, timed)),
        ),
        pictures=(
            _drawn(context, specs, outcomes, timed),
            Picture(
                "fig29-time", _over_pixels(task.name, timed),
                "Time of the whole wall and of its longest step over the pixels of the wall, with "
                "the power laws fitted to them; exponents over the scale are twice as large.",
            ),
        ),
        runs=tuple(specs.values()),
    )  # fmt: skip


def findings(timed: Mapping[float, Planned]) -> tuple[Finding, ...]:
    """Compare times with what §6.3 says of them."""
    found = [
        _growth("whole wall", [(scale, wall.seconds) for scale, wall in timed.items()]),
        _growth("longest step", [(scale, wall.longest) for scale, wall in timed.items()]),
    ]
    for wall in timed.values():
        for what, seconds, said in (
            ("whole wall", wall.seconds, PAPER_WALL_S.get(wall.pixels)),
            ("longest step", wall.longest, PAPER_STEP_S.get(wall.pixels)),
        ):
            if said is not None:
                claim = f"At {size_of(wall.site)} px the {what} takes {said:.3g} s or less."
                words = f"{seconds:.3g} s in one process."
                found.append(Finding(claim, words, seconds <= said))
    return tuple(found)


def _growth(what: str, points: Sequence[tuple[float, float]]) -> Finding:
    claim = f"The time of the {what} is quadratic in the scale."
    power = exponent(points)
    if power is None:
        return Finding(claim, "too few scales.", None)
    near = abs(power - QUADRATIC) <= TOLERANCE
    how = "" if near else f", which is {'less' if power < QUADRATIC else 'more'} growth than that"
    return Finding(claim, f"exponent over the scale {power:.2f}{how}.", near)


def _layouts(outcomes: Mapping[float, Outcome]) -> str:
    placed = ", ".join(f"{o.figures['placed']} at {s:g}" for s, o in outcomes.items())
    first = {s: tuple(outcome.clusters)[:4] for s, outcome in outcomes.items()}
    orders = "; ".join(f"{s:g}: {' '.join(map(str, ids))}" for s, ids in first.items())
    return (
        f"Stones placed, by scale: {placed}. All walls have the seed of the plan in common and "
        f"come out the same whenever they are planned again. Ids of the first four stones, by "
        f"scale: {orders}; there are {len({*first.values()})} "
        f"different beginnings of {len(first)} walls. Every resolution has "
        "positions and indices of its own, and one other choice changes all that follow."
    )


def _walls(timed: Mapping[float, Planned], outcomes: Mapping[float, Outcome]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (scale, size_of(timed[scale].site), outcome.figures["placed"], outcome.figures["stones"],
         *metric_cells(outcome))
        for scale, outcome in outcomes.items()
    ]  # fmt: skip
    return Table(
        "The wall at several resolutions",
        ("scale", "wall, px", "placed", "of", *METRICS),
        tuple(rows),
        ("F_AV and F_AH are measured at the resolution of the wall.",),
    )


def _drawn(
    context: Context,
    specs: Mapping[float, RunSpec],
    outcomes: Mapping[float, Outcome],
    timed: Mapping[float, Planned],
) -> Picture:
    ids = sorted({i for outcome in outcomes.values() for i in outcome.clusters})
    colours = {stone_id: number for number, stone_id in enumerate(ids, 1)}
    walls = [
        (
            f"scale {scale:g}: {size_of(timed[scale].site)} px, "
            f"{outcome.figures['placed']} stones, F_SF {outcome.figures['F_SF']:.2f}",
            outcome.wall(specs[scale], context.data),
            colours,
        )
        for scale, outcome in outcomes.items()
    ]
    return Picture(
        "fig29", plot_walls(walls, 2),
        "The wall at several resolutions, in px of the source; the same stone has the same colour. "
        "Numbers are the order of placement, wedges are dark red.",
    )  # fmt: skip


def _over_pixels(name: str, timed: Mapping[float, Planned]) -> Figure:
    figure = Figure(figsize=GROWTH_IN)
    plot_pixels(name, timed, figure.add_subplot())
    return figure


ITEM = Item("resolutions .5 to 2", "§6.3", make, needs=(PR.source.name,))
