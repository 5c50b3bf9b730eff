"""Items that are timed: Fig. 28, a step by part; Fig. 29, resolution; §6.2, stones and clusters."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
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
from drystone_lab import timed_walls
from drystone_lab.cells import metric_cells, placed_of, trend
from drystone_lab.pictures import plot_growth, sheet_of, step_time_panels, wall_panel
from drystone_lab.reproduce.item import Claimed, Context, ItemFigure, PaperItem, StudyWalls
from drystone_lab.table import Rows
from drystone_lab.timed_walls import SAMPLINGS, TimedWall, fitted, parts_ms, three_digits
from drystone_lab.walls import PR, Target


def timed(context: Context, wall: Target, changes: Mapping[str, object]) -> TimedWall:
    """Plan a wall by the paper's method, and time it; the median of five counts for every step."""
    settings = method_settings("paper").updated(changes)
    repeats = 1 if context.quick else 5
    return timed_walls.planned(wall, context.data, settings, seed=context.seed, repeats=repeats)


class StepWalls(NamedTuple):
    """Walls by sampling, and the folder that may have the times of the authors."""

    walls: Mapping[Sampling, TimedWall]
    data: Path | None


PROCEDURES: Mapping[str, tuple[Part, ...]] = {
    "placement": ("placement",),
    "stabilisation": ("stabilisation",),
    "selection": ("contacts", "limit analysis", "indices"),
}
"""The paper's, by our parts."""

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
    if data is None or not (path := data / "times" / RELEASED[name]).is_file():
        return None
    rows = np.loadtxt(path, delimiter=";", skiprows=1)
    placement, typology, stabilisation, kinematics = rows[:, 2:6].sum(axis=0).tolist()
    seconds = {"placement": placement, "stabilisation": stabilisation}
    seconds |= {"selection": typology + kinematics}
    return len(np.unique(rows[:, 0])), len(rows), seconds, int(rows[rows[:, 0] == 1, 1].max())


def released_rows(data: Path | None, ours: Mapping[str, TimedWall]) -> Rows:
    """Return the times of the authors beside ours."""
    for name, wall in ours.items():
        mine = len(wall.steps), wall.candidates, procedure_seconds(wall.steps), None
        found: dict[str, Times | None] = {"authors": released(data, name), "ours": mine}
        for who, times in found.items():
            if times is None:
                yield name, f"{who}: not in the data folder", *[None] * 7
                continue
            whole, parts = sum(times[2].values()), shares(times[2])
            yield three_digits((name, who, *times[:2], whole, *parts.values(), times[3]))


def procedure_seconds(steps: Sequence[StepTime]) -> dict[str, float]:
    """Return the seconds of each of the paper's procedures."""
    return {
        name: sum(step.parts.get(part, 0.0) for step in steps for part in parts)
        for name, parts in PROCEDURES.items()
    }


def shares(seconds: Mapping[str, float]) -> dict[str, float]:
    """Return the share of each of the paper's procedures in the time of all three."""
    whole = sum(seconds.values()) or 1.0
    return {name: value / whole for name, value in seconds.items()}


def late_over_early(seconds: Sequence[float]) -> float:
    """Return the mean of the last quarter over that of the first; at least one value a quarter."""
    quarter = max(1, len(seconds) // 4)
    return fmean(seconds[-quarter:]) / fmean(seconds[:quarter])


def step_findings(walls: Mapping[Sampling, TimedWall]) -> Iterator[Claimed]:
    """Compare measured steps with what §6.1 says of them."""
    variant, full = walls["variant"].steps, walls["full"].steps
    each = {SAMPLINGS[name]: shares(procedure_seconds(wall.steps)) for name, wall in walls.items()}
    told = "; ".join(
        f"{name}: " + ", ".join(f"{what} {100 * share:.0f} %" for what, share in one.items())
        for name, one in each.items()
    )
    most = all(o["placement"] > 0.5 and o["selection"] > o["stabilisation"] for o in each.values())
    yield Claimed("placement", most, told=told)
    stabilisation = max(one["stabilisation"] for one in each.values())
    yield Claimed("stabilisation", stabilisation < 0.05, most=stabilisation)
    stable = late_over_early([step.seconds for step in variant])
    # About as long at the end as at the start.
    yield Claimed("stable", 1 / 1.5 < stable < 1.5, stable=stable)
    selection = [procedure_seconds([step])["selection"] for step in variant]
    grows = late_over_early(selection) if min(selection) > 0 else None
    each_ms = [(s.stones, t / s.candidates) for s, t in zip(variant, selection, strict=True)]
    holds = None if grows is None else grows > 1
    yield Claimed("grows", holds, grows=grows or 0.0, words=_trend_words(each_ms))
    falls = late_over_early([step.seconds for step in full])
    candidates = late_over_early([float(step.candidates) for step in full])
    words = _trend_words([(step.stones, step.seconds) for step in full])
    yield Claimed("falls", falls < 1, falls=falls, candidates=candidates, words=words)


def _trend_words(pairs: Sequence[tuple[float, float | None]]) -> str:
    found = trend(pairs)
    return "" if found is None else f", {found.words()}"


def step_rows(walls: Mapping[Sampling, TimedWall]) -> Rows:
    """Return the times of steps by eight stones placed, and how those of a candidate grow."""
    for sampling, wall in walls.items():
        for first in range(0, len(wall.steps), 8):
            steps = wall.steps[first : first + 8]
            candidates = fmean(step.candidates for step in steps)
            parts = parts_ms(steps)
            stones = f"{first} to {first + len(steps) - 1}"
            yield three_digits((sampling, stones, candidates, *parts, parts[-1] / candidates))
        # Growth is fitted from the fourth stone on.
        late = [step for step in wall.steps if step.stones >= 4]
        each = [[ms / step.candidates for ms in parts_ms([step])] for step in late]
        growth = timed_walls.exponents([float(step.stones) for step in late], each)
        yield three_digits((sampling, "exponent a candidate", None, *growth, None))


def _candidates(found: StepWalls) -> Rows:
    for sampling, wall in found.walls.items():
        for number, step in enumerate(wall.steps, 1):
            yield sampling, number, step.stones, step.candidates


STEPS = PaperItem(
    study=lambda context: StepWalls(
        {name: timed(context, PR, {"sampling": name}) for name in SAMPLINGS}, context.data
    ),
    claims=lambda found: step_findings(found.walls),
    tables={"candidates": _candidates},
    times={
        "released": lambda found: released_rows(found.data, found.walls),
        "steps": lambda found: step_rows(found.walls),
    },
    pictures=lambda found: [
        ItemFigure(
            "fig28", step_time_panels({SAMPLINGS[k]: w.steps for k, w in found.walls.items()})
        )
    ],
)

PAPER_S = {"whole wall": {140 * 40: 0.18 * 60}, "longest step": {560 * 160: 25.0}}
"""By pixels.  §6.3: 32 stones in .18 minutes at 140 x 40 px; at the highest resolution no step
takes longer."""


class ScaledWalls(NamedTuple):
    """A wall at several resolutions, built to be drawn and timed, by scale."""

    built: StudyWalls
    timed: Mapping[float, TimedWall]


def by_scale(
    context: Context, wall: Target = PR, scales: Sequence[float] = (0.5, 1.0, 1.5, 2.0)
) -> ScaledWalls:
    """Plan a wall at several resolutions."""
    walls = {scale: replace(wall, scale=scale * wall.scale) for scale in scales}
    found = StudyWalls.built(context, tuple(walls.values()), {"variant": ()}, (context.seed,))
    return ScaledWalls(found, {scale: timed(context, one, {}) for scale, one in walls.items()})


def scale_findings(walls: Mapping[float, TimedWall]) -> Iterator[Claimed]:
    """Compare times with what §6.3 says of them."""
    measures = {
        "whole wall": {scale: wall.seconds for scale, wall in walls.items()},
        "longest step": {scale: wall.longest for scale, wall in walls.items()},
    }
    for what, seconds in measures.items():
        if (law := fitted(list(seconds.items()))) is None:
            yield Claimed("few", None, what=what)
        else:
            # The paper finds an exponent of 2 over the scale.
            near = abs(law.exponent - 2.0) <= 0.5
            yield Claimed("quadratic", near, what=what, power=law.exponent)
    for scale, wall in walls.items():
        for what, seconds in measures.items():
            if (said := PAPER_S[what].get(wall.pixels)) is not None:
                took = seconds[scale]
                holds = took <= said
                yield Claimed("seconds", holds, size=wall.size, what=what, said=said, seconds=took)


def pixel_rows(by_scale: Mapping[float, TimedWall]) -> Rows:
    """Return the times of walls of several resolutions, the paper's beside, and their exponents."""
    walls = by_scale.values()
    for wall in walls:
        said = [seconds.get(wall.pixels) for seconds in PAPER_S.values()]
        candidates = fmean(step.candidates for step in wall.steps)
        yield three_digits(
            (wall.size, len(wall.steps), candidates, *parts_ms(wall.steps), wall.seconds, said[0],
             wall.longest, said[1])
        )  # fmt: skip
    measured = [(*parts_ms(wall.steps), wall.seconds, wall.longest) for wall in walls]
    pixels = [float(wall.pixels) for wall in walls]
    *steps, whole, longest = timed_walls.exponents(pixels, measured)
    yield three_digits(("exponent over pixels", None, None, *steps, whole, None, longest, None))


def _scales_pictures(found: ScaledWalls) -> Iterator[ItemFigure]:
    ids = sorted({i for one in found.built for i in one.outcomes[0].clusters})
    colours = {stone_id: number for number, stone_id in enumerate(ids, 1)}
    walls = []
    for (scale, wall), one in zip(found.timed.items(), found.built, strict=True):
        figures = one.outcomes[0].figures
        title = f"scale {scale:g}: {wall.size} px, {figures['placed']} stones, "
        title += f"F_SF {figures['F_SF']:.2f}"
        walls.append(wall_panel(title, one.built(), colours))
    yield ItemFigure("fig29", sheet_of(walls, 2))
    figure = Figure(figsize=(6.4, 4.0))
    series = {
        "whole wall": [(float(wall.pixels), wall.seconds) for wall in found.timed.values()],
        "longest step": [(float(wall.pixels), wall.longest) for wall in found.timed.values()],
    }
    claims = []
    for what, marker, how in (("whole wall", "x", ""), ("longest step", "v", ", below")):
        claims += [(f"paper: {what}{how}", marker, px, s) for px, s in PAPER_S[what].items()]
    plot_growth(figure.add_subplot(), series, claims)
    yield ItemFigure("fig29-time", figure)


RESOLUTION = PaperItem(
    study=by_scale,
    claims=lambda found: scale_findings(found.timed),
    tables={
        "walls": lambda found: [
            (scale, wall.size, *placed_of(one.outcomes[0]), *metric_cells(one.outcomes[0].figures))
            for (scale, wall), one in zip(found.timed.items(), found.built, strict=True)
        ]
    },
    times={
        "released": lambda found: released_rows(
            found.built[0].data, {str(scale): wall for scale, wall in found.timed.items()}
        ),
        "pixels": lambda found: pixel_rows(found.timed),
    },
    pictures=_scales_pictures,
)

SIZES = (16, 32, 64, 128), (0.05, 0.1, 0.4, 1.0)
QUICK_SIZES = (8, 16, 32), (0.1, 0.4)
"""Numbers of stones Q; and thresholds of the clusters K, with the largest Q."""


class GrowthWall(NamedTuple):
    """A wall, with the numbers of stones and clusters that its time should depend on."""

    sampling: Sampling
    distance: float
    Q: int
    K: int
    planned: TimedWall


def by_stones(
    context: Context, sizes: tuple[Sequence[int], Sequence[float]] | None = None
) -> tuple[GrowthWall, ...]:
    """Plan walls: variant and full over the stones, then variant over the clusters."""
    numbers, distances = sizes or (QUICK_SIZES if context.quick else SIZES)
    usual = method_settings("paper").clusters.distance
    asked: list[tuple[Sampling, float, int]] = [
        (sampling, usual, count) for sampling in SAMPLINGS for count in numbers
    ]
    asked += [("variant", distance, numbers[-1]) for distance in distances]
    walls = []
    for sampling, distance, count in asked:
        # More stones are smaller ones, so that a candidate always has as many pixels.
        wall = timed_walls.rubble(count, context.seed, (420, 120))
        changes = {"sampling": sampling, "clusters": {"distance": distance}}
        settings = method_settings("paper").updated(changes)
        clusters = cluster_stones(wall.source.stones(None), PoseBook(), settings.clusters)
        found = timed_walls.planned(wall, None, settings, seed=context.seed, repeats=1)
        walls.append(GrowthWall(sampling, distance, count, len({*clusters.values()}), found))
    return tuple(walls)


def counts(walls: Sequence[GrowthWall]) -> Iterator[Claimed]:
    """Compare numbers of candidates with §6.2."""
    points = {
        "variant": [(w.Q * w.K, w.planned.candidates) for w in walls if w.sampling == "variant"],
        "full": [(w.Q, w.planned.candidates) for w in walls if w.sampling == "full"],
    }
    for (sampling, each), expected in zip(points.items(), (1.0, 2.0), strict=True):
        law = fitted(each)
        if law is None:
            raise ValueError("too few sizes")
        near = abs(law.exponent - expected) <= 0.25
        yield Claimed(sampling, near, power=law.exponent, count=len(each))


GROWTH = PaperItem(
    study=by_stones,
    claims=counts,
    tables={
        "walls": lambda walls: [
            (w.sampling, w.distance, w.Q, w.K, len(w.planned.steps), w.planned.candidates,
             round(w.planned.candidates / len(w.planned.steps), 2))
            for w in walls
        ]
    },
)  # fmt: skip
