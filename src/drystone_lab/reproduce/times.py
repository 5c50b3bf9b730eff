"""Items by the clock: Fig. 28, a step by part; Fig. 29, resolution; §6.2, stones and clusters."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import fmean

from matplotlib.figure import Figure

from drystone.clusters import cluster_stones
from drystone.planner.profile import Part, StepTime
from drystone.planner.settings import method_settings
from drystone.poses import PoseBook
from drystone.selection.sampling import Sampling
from drystone_lab.pictures.growth import GROWTH_IN, Series, plot_growth
from drystone_lab.pictures.walls import plot_walls
from drystone_lab.reproduce.cells import METRICS, ClaimCheck, findings_table, metric_cells, trend
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.reproduce.study import ONE_WAY, StudyWalls, built
from drystone_lab.table import Cell, Table
from drystone_lab.timed_walls import (
    PAPER_STEP_S,
    PAPER_WALL_S,
    SAMPLINGS,
    TimedWall,
    exponent,
    fitted,
    pixels_table,
    planned,
    plot_pixels,
    rubble,
    size_of,
    steps_figure,
    steps_table,
    three_digits,
)
from drystone_lab.walls import PR, Target

REPEATS = 3
"""Of each wall; the quickest of every step counts."""

HOW_TIMED = (
    "Times are of one process with one thread and differ from machine to machine; where the paper "
    "gives times, they are of several processes on an i7-10700 of 2.9 GHz. Each wall of the full "
    f"version is planned {REPEATS} times, and the quickest of a step counts."
)


def timed(context: Context, wall: Target, changes: Mapping[str, object]) -> TimedWall:
    """Plan a wall by the paper's method and the clock."""
    settings = method_settings("paper").updated(changes)
    repeats = 1 if context.quick else REPEATS
    return planned(wall, context.data, settings, seed=context.seed, repeats=repeats)


BySampling = Mapping[Sampling, TimedWall]
ProcedureShares = Mapping[str, float]

PROCEDURES: Mapping[str, tuple[Part, ...]] = {
    "placement": ("placement",),
    "stabilisation": ("stabilisation",),
    "selection": ("contacts", "limit analysis", "indices"),
}
"""The paper's, by our parts."""

NEGLIGIBLE = 0.05
"""Share of the three procedures below which one is called negligible."""

STABLE = 1.5
"""A step takes about as long at the end when it takes less than so many times as long."""


def by_sampling(context: Context, wall: Target = PR) -> BySampling:
    """Plan a wall by the clock with either sampling."""
    return {sampling: timed(context, wall, {"sampling": sampling}) for sampling in SAMPLINGS}


def shares(steps: Sequence[StepTime]) -> dict[str, float]:
    """Return the share of each of the paper's procedures in the time of all three."""
    seconds = {
        name: sum(step.parts.get(part, 0.0) for step in steps for part in parts)
        for name, parts in PROCEDURES.items()
    }
    whole = sum(seconds.values()) or 1.0
    return {name: value / whole for name, value in seconds.items()}


def late_over_early(seconds: Sequence[float]) -> float:
    """Return the mean of the last quarter over that of the first; at least one value a quarter."""
    quarter = max(1, len(seconds) // 4)
    return fmean(seconds[-quarter:]) / fmean(seconds[:quarter])


def step_findings(walls: BySampling) -> tuple[ClaimCheck, ...]:
    """Compare measured steps with what §6.1 says of them."""
    variant, full = walls["variant"].steps, walls["full"].steps
    each = [shares(wall.steps) for wall in walls.values()]
    selection = [sum(s.parts.get(part, 0.0) for part in PROCEDURES["selection"]) for s in variant]
    stable = late_over_early([step.seconds for step in variant])
    grows = late_over_early(selection) if min(selection) > 0 else None
    falls = late_over_early([step.seconds for step in full])
    over = {
        "a candidate": trend([(s.stones, t / s.candidates) for s, t in zip(variant, selection,
                                                                           strict=True)]),
        "a step": trend([(step.stones, step.seconds) for step in full]),
    }  # fmt: skip
    words = {what: "" if found is None else f", {found.words()}" for what, found in over.items()}
    told = "; ".join(
        f"{SAMPLINGS[name]}: "
        + ", ".join(f"{procedure} {100 * share:.0f} %" for procedure, share in one.items())
        for name, one in zip(walls, each, strict=True)
    )
    return (
        ClaimCheck(
            "Placement takes most of the time, selection is second.",
            f"{told} of the three procedures.",
            all(o["placement"] > 0.5 and o["selection"] > o["stabilisation"] for o in each),
        ),
        ClaimCheck(
            "The time of stabilisation is negligible.",
            f"{max(one['stabilisation'] for one in each):.1%} of the three procedures at most.",
            all(one["stabilisation"] < NEGLIGIBLE for one in each),
        ),
        ClaimCheck(
            "A step of variant sampling is almost stable.",
            f"a step of the last quarter takes {stable:.2f} times as long as one of the first.",
            1 / STABLE < stable < STABLE,
        ),
        ClaimCheck(
            "Selection grows slightly as stones are placed (variant sampling).",
            f"in the last quarter it takes {grows or 0.0:.2f} times as long as in the first; of a "
            f"candidate over the stones placed{words['a candidate']}.",
            None if grows is None else grows > 1,
        ),
        ClaimCheck(
            "A step of the full batch gets shorter as the candidates get fewer.",
            f"a step of the last quarter takes {falls:.2f} times as long as one of the first, with "
            f"{late_over_early([float(step.candidates) for step in full]):.2f} times the "
            f"candidates{words['a step']}.",
            falls < 1,
        ),
    )


def _candidates(walls: BySampling) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (sampling, number, step.stones, step.candidates)
        for sampling, wall in walls.items()
        for number, step in enumerate(wall.steps, 1)
    ]
    columns = ("sampling", "step", "stones placed", "candidates")
    return Table("Candidates of every step", columns, tuple(rows))


def _procedures(walls: BySampling) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for sampling, wall in walls.items():
        share = shares(wall.steps)
        rows.append((sampling, round(wall.seconds, 3), *(round(share[p], 3) for p in PROCEDURES)))
    columns = ("sampling", "wall, s", *(f"{name}, share" for name in PROCEDURES))
    return Table("Shares of the paper's procedures in their time", columns, tuple(rows))


STEPS = PaperItem(**paper("fig28"),
    study=by_sampling,
    tables={"candidates": _candidates},
    times={
        "claims": lambda walls: findings_table(
            "The paper's claims about steps", step_findings(walls)
        ),
        "procedures": _procedures,
        "steps": lambda walls: steps_table(PR.name, walls),
    },
    pictures=lambda walls: (
        ItemPicture(
            "fig28", steps_figure(walls),
            "The time of every step by part. Contacts, limit analysis and indices are the paper's "
            "selection; the rest is sampling and keeping books.",
        ),
    ),
    needs=(PR.source.name,),
)  # fmt: skip

SCALES = (0.5, 1.0, 1.5, 2.0)
"""Of the paper's size, 280 x 80 px."""

QUADRATIC, TOLERANCE = 2.0, 0.5
"""Exponent over the scale that the paper finds, and how far another one is from it at most."""


@dataclass(frozen=True, eq=False)
class ScaledWalls:
    """A wall at several resolutions, built to be drawn and timed, by scale."""

    built: StudyWalls
    timed: Mapping[float, TimedWall]


def by_scale(context: Context, wall: Target = PR, scales: Sequence[float] = SCALES) -> ScaledWalls:
    """Plan a wall at several resolutions."""
    walls = {scale: replace(wall, scale=scale * wall.scale) for scale in scales}
    found = built(context, tuple(walls.values()), ONE_WAY, (context.seed,))
    return ScaledWalls(found, {scale: timed(context, one, {}) for scale, one in walls.items()})


def scale_findings(walls: Mapping[float, TimedWall]) -> Iterator[ClaimCheck]:
    """Compare times with what §6.3 says of them."""
    measures: tuple[tuple[str, Callable[[TimedWall], float], Mapping[int, float]], ...] = (
        ("whole wall", lambda wall: wall.seconds, PAPER_WALL_S),
        ("longest step", lambda wall: wall.longest, PAPER_STEP_S),
    )
    for what, seconds, _ in measures:
        claim = f"The time of the {what} is quadratic in the scale."
        power = exponent([(scale, seconds(wall)) for scale, wall in walls.items()])
        words = "too few scales." if power is None else f"exponent over the scale {power:.2f}."
        near = None if power is None else abs(power - QUADRATIC) <= TOLERANCE
        yield ClaimCheck(claim, words, near)
    for wall in walls.values():
        for what, seconds, papers in measures:
            if (said := papers.get(wall.pixels)) is not None:
                claim = f"At {size_of(wall.site)} px the {what} takes {said:.3g} s or less."
                words = f"{seconds(wall):.3g} s in one process."
                yield ClaimCheck(claim, words, seconds(wall) <= said)


def _scales_table(found: ScaledWalls) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for (scale, wall), one in zip(found.timed.items(), found.built, strict=True):
        outcome = one.outcomes[0]
        placed, stones = outcome.figures["placed"], outcome.figures["stones"]
        rows.append((scale, size_of(wall.site), placed, stones, *metric_cells(outcome)))
    return Table(
        "The wall at several resolutions",
        ("scale", "wall, px", "placed", "of", *METRICS),
        tuple(rows),
        ("F_AV and F_AH are measured at the resolution of the wall.",),
    )


def _scales_pictures(found: ScaledWalls) -> Iterator[ItemPicture]:
    ids = sorted({i for one in found.built for i in one.outcomes[0].clusters})
    colours = {stone_id: number for number, stone_id in enumerate(ids, 1)}
    walls = []
    for (scale, wall), one in zip(found.timed.items(), found.built, strict=True):
        figures = one.outcomes[0].figures
        title = f"scale {scale:g}: {size_of(wall.site)} px, {figures['placed']} stones, "
        title += f"F_SF {figures['F_SF']:.2f}"
        walls.append((title, found.built.wall(one), colours))
    yield ItemPicture(
        "fig29", plot_walls(walls, 2),
        "The wall at several resolutions, in px of the source; the same stone has the same colour. "
        "Numbers are the order of placement, wedges are dark red.",
    )  # fmt: skip
    figure = Figure(figsize=GROWTH_IN)
    plot_pixels(found.built.name, found.timed, figure.add_subplot())
    yield ItemPicture(
        "fig29-time", figure,
        "Time of the whole wall and of its longest step over the pixels of the wall, with "
        "the power laws fitted to them; exponents over the scale are twice as large.",
    )  # fmt: skip


RESOLUTION = PaperItem(
    **paper("fig29"),
    study=by_scale,
    tables={"walls": _scales_table},
    times={
        "claims": lambda found: findings_table(
            "The paper's claims about resolution", tuple(scale_findings(found.timed))
        ),
        "pixels": lambda found: pixels_table(found.built.name, found.timed),
    },
    pictures=lambda found: tuple(_scales_pictures(found)),
    needs=(PR.source.name,),
)

WALL_PX = (420, 120)
"""Of every wall; more stones are smaller ones, so that a candidate always has as many pixels."""

LIMIT = 0.25
"""How far an exponent may be from the paper's."""


@dataclass(frozen=True)
class Sizes:
    """Numbers of stones Q; and thresholds of the clusters K, with the largest Q."""

    counts: tuple[int, ...] = (16, 32, 64, 128)
    distances: tuple[float, ...] = (0.05, 0.1, 0.4, 1.0)


QUICK = Sizes((8, 16, 32), (0.1, 0.4))


@dataclass(frozen=True)
class GrowthWall:
    """A wall, with the numbers of stones and clusters that its time should depend on."""

    sampling: Sampling
    distance: float
    Q: int
    K: int
    planned: TimedWall

    @property
    def candidates(self) -> int:
        """Evaluated in all steps."""
        return sum(step.candidates for step in self.planned.steps)

    @property
    def stepping(self) -> float:
        """Seconds of all steps."""
        return sum(step.seconds for step in self.planned.steps)


Grew = Sequence[GrowthWall]


def by_stones(context: Context, sizes: Sizes | None = None) -> tuple[GrowthWall, ...]:
    """Plan walls: variant and full over the stones, then variant over the clusters."""
    sizes = sizes or (QUICK if context.quick else Sizes())
    usual = method_settings("paper").clusters.distance
    asked: list[tuple[Sampling, float, int]] = [
        (sampling, usual, count) for sampling in SAMPLINGS for count in sizes.counts
    ]
    asked += [("variant", distance, sizes.counts[-1]) for distance in sizes.distances]
    return tuple(_grown(context, *one) for one in asked)


def _grown(context: Context, sampling: Sampling, distance: float, count: int) -> GrowthWall:
    wall = rubble(count, context.seed, WALL_PX)
    changes = {"sampling": sampling, "clusters": {"distance": distance}}
    settings = method_settings("paper").updated(changes).clusters
    clusters = cluster_stones(wall.source.stones(None), PoseBook(), settings)
    return GrowthWall(
        sampling, distance, count, len({*clusters.values()}), timed(context, wall, changes)
    )


def _of(walls: Grew, sampling: Sampling) -> list[GrowthWall]:
    return [wall for wall in walls if wall.sampling == sampling]


def counts(walls: Grew) -> tuple[ClaimCheck, ...]:
    """Compare numbers of candidates with §6.2."""
    variant, full = _of(walls, "variant"), _of(walls, "full")
    return (
        _power("Variant sampling is O(Q K).", "candidates of all walls over Q K",
               [(w.Q * w.K, w.candidates) for w in variant], 1.0),
        _power("Full batch sampling is O(Q^2).", "candidates over Q",
               [(w.Q, w.candidates) for w in full], 2.0),
    )  # fmt: skip


def seconds(walls: Grew) -> tuple[ClaimCheck, ...]:
    """Compare times with §6.2."""
    variant, full = _of(walls, "variant"), _of(walls, "full")
    return (
        _power("Variant sampling is O(Q K).", "time of all steps over Q K",
               [(w.Q * w.K, w.stepping) for w in variant], 1.0),
        _power("Full batch sampling is O(Q^2).", "time of all steps over Q",
               [(w.Q, w.stepping) for w in full], 2.0),
        _power("A candidate costs the same whatever Q is.", "time of a candidate over Q",
               [(w.Q, w.stepping / w.candidates) for w in full], 0.0),
        _power("Rotation and clustering are O(Q) and O(Q^2 log Q).",
               "time of preparation over Q, where rotation prevails",
               [(w.Q, w.planned.preparation) for w in full], 1.0, bound=True),
    )  # fmt: skip


def _power(
    claim: str,
    what: str,
    points: Sequence[tuple[float, float]],
    expected: float,
    *,
    bound: bool = False,
) -> ClaimCheck:
    """Compare an exponent with an expected one; a smaller one agrees too for a `bound`."""
    power = exponent(points)
    if power is None:
        return ClaimCheck(claim, f"{what}: too few sizes.", None)
    words = f"exponent of the {what}: {power:.2f}, of {len(points)} walls (expected {expected:g})."
    off = power - expected
    return ClaimCheck(claim, words, off <= LIMIT if bound else abs(off) <= LIMIT)


def _counted(walls: Grew) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (w.sampling, w.distance, w.Q, w.K, len(w.planned.steps), w.candidates,
         round(w.candidates / len(w.planned.steps), 2))
        for w in walls
    ]  # fmt: skip
    return Table(
        "Stones Q, clusters K and candidates",
        ("sampling", "cluster distance", "Q", "K", "placed", "candidates", "candidates a step"),
        tuple(rows),
    )


def _timed(walls: Grew) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (w.sampling, w.Q, w.K, w.stepping, 1e3 * w.stepping / w.candidates, w.planned.preparation)
        for w in walls
    ]
    return Table(
        "Time against stones Q and clusters K",
        ("sampling", "Q", "K", "all steps, s", "ms a candidate", "preparation, s"),
        three_digits(rows),
    )


def _growth_picture(walls: Grew) -> ItemPicture:
    figure = Figure(figsize=(8.4, 3.4), layout="constrained")
    axes = figure.subplots(1, 2, squeeze=False)[0]
    variant = tuple((float(w.Q * w.K), w.stepping) for w in _of(walls, "variant"))
    full = tuple((float(w.Q), w.stepping) for w in _of(walls, "full"))
    plot_growth(
        (Series("variant sampling", variant, fitted(variant)),),
        ax=axes[0], size="stones Q x clusters K",
    )  # fmt: skip
    plot_growth((Series("full batch sampling", full, fitted(full)),), ax=axes[1], size="stones Q")
    return ItemPicture(
        "growth", figure,
        "Time of all steps of a wall: with variant sampling over Q K, with the full batch over Q, "
        "with the power laws fitted to them. The paper derives exponents of 1 and 2.",
    )  # fmt: skip


GROWTH = PaperItem(
    **paper("growth"),
    study=by_stones,
    claims=counts,
    tables={"walls": _counted},
    times={
        "time-claims": lambda walls: findings_table(
            "The paper's claims in seconds", seconds(walls)
        ),
        "seconds": _timed,
    },
    pictures=lambda walls: (_growth_picture(walls),),
)
