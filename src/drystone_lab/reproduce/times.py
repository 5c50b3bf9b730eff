"""Items by the clock: Fig. 28, a step by part; Fig. 29, resolution; §6.2, stones and clusters."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from drystone.clusters import cluster_stones
from drystone.planner.profile import Part, StepTime
from drystone.planner.settings import method_settings
from drystone.poses import PoseBook
from drystone.selection.sampling import Sampling
from drystone_lab.pictures.growth import GROWTH_IN
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

REPEATS = 5
"""Of each wall; the median of every step counts."""


def timed(context: Context, wall: Target, changes: Mapping[str, object]) -> TimedWall:
    """Plan a wall by the paper's method and the clock."""
    settings = method_settings("paper").updated(changes)
    repeats = 1 if context.quick else REPEATS
    return planned(wall, context.data, settings, seed=context.seed, repeats=repeats)


BySampling = Mapping[Sampling, TimedWall]


class StepWalls(NamedTuple):
    """Walls by sampling, and the folder that may have the times of the paper's authors."""

    walls: BySampling
    data: Path | None


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


def by_sampling(context: Context, wall: Target = PR) -> StepWalls:
    """Plan a wall by the clock with either sampling."""
    walls = {sampling: timed(context, wall, {"sampling": sampling}) for sampling in SAMPLINGS}
    return StepWalls(walls, context.data)


RELEASED: Mapping[str, str] = {
    "variant": "PR_filter.txt", "full": "PR_filter_full.txt",
    "0.5": "PR_filter_reso025_image_conv.txt", "1.0": "PR_filter.txt",
    "1.5": "PR_filter_reso075_image_conv.txt", "2.0": "PR_filter_reso1_image_conv.txt",
}  # fmt: skip
"""Times of the authors by sampling or scale, as they released them: a row a candidate."""


Times = tuple[int, int, dict[str, float], int | None]
"""Steps, candidates, worker seconds by procedure, and the most places on the empty ground."""


def released(data: Path | None, name: str) -> Times | None:
    """Return the times of the authors; None without the file."""
    path = None if data is None else data / "times" / RELEASED[name]
    if path is None or not path.is_file():
        return None
    rows = np.loadtxt(path, delimiter=";", skiprows=1)
    placement, typology, stabilisation, kinematics = rows[:, 2:6].sum(axis=0).tolist()
    seconds = {"placement": placement, "stabilisation": stabilisation}
    seconds |= {"selection": typology + kinematics}
    return len(np.unique(rows[:, 0])), len(rows), seconds, int(rows[rows[:, 0] == 1, 1].max())


def _released_table(data: Path | None, ours: Mapping[str, TimedWall]) -> Table:
    """Return the times of the authors beside ours."""
    rows: list[tuple[Cell, ...]] = []
    for name, wall in ours.items():
        candidates = sum(step.candidates for step in wall.steps)
        seconds = {
            what: sum(step.parts.get(part, 0.0) for step in wall.steps for part in parts)
            for what, parts in PROCEDURES.items()
        }
        ours_too = len(wall.steps), candidates, seconds, None
        found: dict[str, Times | None] = {"authors": released(data, name), "ours": ours_too}
        for who, times in found.items():
            if times is None:
                rows.append((name, f"{who}: not in the data folder", *[None] * 7))
                continue
            whole = sum(times[2].values())
            shares_of = (float(times[2][what] / whole) for what in PROCEDURES)
            rows.append((name, who, *times[:2], whole, *shares_of, times[3]))
    return Table(
        "The authors' released times beside ours",
        ("wall", "whose", "steps", "candidates", "worker seconds",
         *(f"{what}, share" for what in PROCEDURES), "most places in step 1"),
        three_digits(rows),
        ("Sums over all candidates: of several processes of an i7-10700, and of one here.",
         "A stone has one place on the empty ground for every px that the wall is wider than it, "
         "and one more. The narrowest pose of PR is 12 px wide: 287 places are a wall of 298 px."),
    )  # fmt: skip


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


STEPS = PaperItem(**paper("fig28"),
    study=by_sampling,
    tables={"candidates": lambda found: _candidates(found.walls)},
    times={
        "claims": lambda found: findings_table(
            "The paper's claims about steps", step_findings(found.walls)
        ),
        "released": lambda found: _released_table(found.data, found.walls),
        "steps": lambda found: steps_table(PR.name, found.walls),
    },
    pictures=lambda found: (
        ItemPicture(
            "fig28", steps_figure(found.walls),
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
        "released": lambda found: _released_table(
            found.built.context.data, {str(scale): wall for scale, wall in found.timed.items()}
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
    found = planned(wall, None, method_settings("paper").updated(changes), seed=context.seed,
                    repeats=1)  # fmt: skip
    return GrowthWall(sampling, distance, count, len({*clusters.values()}), found)


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


def _power(
    claim: str, what: str, points: Sequence[tuple[float, float]], expected: float
) -> ClaimCheck:
    """Compare an exponent with an expected one."""
    power = exponent(points)
    if power is None:
        return ClaimCheck(claim, f"{what}: too few sizes.", None)
    words = f"exponent of the {what}: {power:.2f}, of {len(points)} walls (expected {expected:g})."
    return ClaimCheck(claim, words, abs(power - expected) <= LIMIT)


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


GROWTH = PaperItem(
    **paper("growth"),
    study=by_stones,
    claims=counts,
    tables={"walls": _counted},
)
