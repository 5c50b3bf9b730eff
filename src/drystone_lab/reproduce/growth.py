"""§6.2: how the time of a wall grows with the stones Q and the clusters K."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from drystone.clusters import cluster_stones
from drystone.generate import RubbleSettings, rubble_stones
from drystone.planner.settings import method_settings
from drystone.poses import PoseBook
from drystone.selection.sampling import Sampling
from drystone_lab.pictures.growth import Series, plot_growth
from drystone_lab.reproduce.findings import Finding, findings_table
from drystone_lab.reproduce.item import Context, Item, Output, Picture
from drystone_lab.reproduce.timing import how_timed, repeats
from drystone_lab.table import Cell, Table
from drystone_lab.timed_walls import (
    LEAST_STONES,
    Planned,
    Task,
    exponent,
    fitted,
    planned,
    three_digits,
)

WALL_PX = (420, 120)
"""Of every wall; more stones are smaller ones, so that a candidate always has as many pixels."""

COURSES = 4
"""Of 32 stones."""

LIMIT = 0.25
"""How far an exponent may be from the paper's."""

PAPER = (
    "§6.2: initial rotation is O(Q) in the number of stones Q, clustering O(Q^2 log Q); placement, "
    "stabilisation and selection of a step are O(K) in the number of clusters K with variant "
    "sampling and O(Q) with the full batch. 'For the entire wall construction, the time complexity "
    "using variant sampling is O(QK), and using full batch sampling is O(Q^2).' It is derived, not "
    "measured, and takes the cost of a candidate as constant.",
)


@dataclass(frozen=True)
class Sizes:
    """Which walls are planned.

    Parameters
    ----------
    counts : tuple of int
        Stones Q, with variant sampling and the full batch.
    distances : tuple of float
        Thresholds of the clusters, which make K large or small, with the largest Q and variant
        sampling.
    """

    counts: tuple[int, ...] = (16, 32, 64, 128)
    distances: tuple[float, ...] = (0.05, 0.1, 0.4, 1.0)


QUICK = Sizes((8, 16, 32), (0.1, 0.4))


@dataclass(frozen=True)
class Grown:
    """A wall, with the numbers that its time should depend on.

    Parameters
    ----------
    sampling : {"variant", "full"}
        Of the candidates.
    distance : float
        Threshold of the clusters.
    Q, K : int
        Stones and clusters of the set.
    planned : Planned
        Its steps and times.
    """

    sampling: Sampling
    distance: float
    Q: int
    K: int
    planned: Planned

    @property
    def candidates(self) -> int:
        """Evaluated in all steps."""
        return sum(step.candidates for step in self.planned.steps)

    @property
    def stepping(self) -> float:
        """Seconds of all steps."""
        return sum(step.seconds for step in self.planned.steps)


def make(context: Context, sizes: Sizes | None = None) -> Output:
    """Plan walls of several numbers of stones and clusters by the clock.

    Parameters
    ----------
    context : Context
        `quick` for small ones.
    sizes : Sizes, optional
        Which walls.
    """
    sizes = sizes or (QUICK if context.quick else Sizes())
    walls = planned_walls(sizes, context.seed, repeats(context))
    counted = (
        ("claims", findings_table("The paper's claims in numbers of candidates", counts(walls))),
    )
    return Output(
        paper=PAPER,
        ours=(
            f"Generated rubble for a wall of {WALL_PX[0]} x {WALL_PX[1]} px, smaller stones the "
            "more there are. A count of candidates is the same on every machine: what the paper "
            "derives is that count.",
            *(f"{one.claim} Here: {one.found}" for one in counts(walls)),
            how_timed(context),
        ),
        tables=(*counted, ("walls", _counted(walls))),
        times=(
            ("time-claims", findings_table("The paper's claims in seconds", times(walls))),
            ("seconds", _timed(walls)),
        ),
        pictures=(_picture(walls),),
    )


def planned_walls(sizes: Sizes, seed: int, often: int) -> tuple[Grown, ...]:
    """Plan the walls: variant and full over the stones, then variant over the clusters.

    Parameters
    ----------
    sizes : Sizes
        Which.
    seed : int
        Of stones and plans.
    often : int
        How often each is planned; the quickest repetition of a step counts.
    """
    usual = method_settings("paper").clusters.distance
    samplings: tuple[Sampling, ...] = ("variant", "full")
    asked = [(sampling, usual, count) for sampling in samplings for count in sizes.counts]
    asked += [("variant", distance, sizes.counts[-1]) for distance in sizes.distances]
    return tuple(_grown(sampling, distance, count, seed, often)
                 for sampling, distance, count in asked)  # fmt: skip


def counts(walls: Sequence[Grown]) -> tuple[Finding, ...]:
    """Compare numbers of candidates with §6.2."""
    variant, full = _of(walls, "variant"), _of(walls, "full")
    return (
        _power("Variant sampling is O(Q K).", "candidates of all walls over Q K",
               [(w.Q * w.K, w.candidates) for w in variant], 1.0),
        _power("Full batch sampling is O(Q^2).", "candidates over Q",
               [(w.Q, w.candidates) for w in full], 2.0),
    )  # fmt: skip


def times(walls: Sequence[Grown]) -> tuple[Finding, ...]:
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
) -> Finding:
    """Compare an exponent with an expected one; a smaller one agrees too for a `bound`."""
    power = exponent(points)
    if power is None:
        return Finding(claim, f"{what}: too few sizes.", None)
    words = f"exponent of the {what}: {power:.2f}, of {len(points)} walls (expected {expected:g})."
    off = power - expected
    return Finding(claim, words, off <= LIMIT if bound else abs(off) <= LIMIT)


def _grown(sampling: Sampling, distance: float, count: int, seed: int, often: int) -> Grown:
    task = rubble(count, seed)
    changes = {"sampling": sampling, "clusters": {"distance": distance}}
    settings = method_settings("paper").updated(changes)
    clusters = cluster_stones(task.stones, PoseBook(), settings.clusters)
    wall = planned(task, 1.0, settings, seed=seed, repeats=often)
    return Grown(sampling, distance, count, len({*clusters.values()}), wall)


def rubble(count: int, seed: int) -> Task:
    """Return generated stones for a wall of :data:`WALL_PX`."""
    width, height = WALL_PX
    size = RubbleSettings(
        count=count, width_px=width, height_px=height,
        courses=max(1, round(COURSES * (count / LEAST_STONES) ** 0.5)),
    )  # fmt: skip
    stones = rubble_stones(size, np.random.default_rng(seed))
    return Task(f"{count} generated stones", stones, WALL_PX)


def _of(walls: Sequence[Grown], sampling: Sampling) -> list[Grown]:
    return [wall for wall in walls if wall.sampling == sampling]


def _counted(walls: Sequence[Grown]) -> Table:
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


def _timed(walls: Sequence[Grown]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (w.sampling, w.Q, w.K, w.stepping, 1e3 * w.stepping / w.candidates, w.planned.preparation)
        for w in walls
    ]
    return Table(
        "Time against stones Q and clusters K",
        ("sampling", "Q", "K", "all steps, s", "ms a candidate", "preparation, s"),
        three_digits(rows),
    )


def _picture(walls: Sequence[Grown]) -> Picture:
    variant, full = _of(walls, "variant"), _of(walls, "full")
    over_product = tuple((float(w.Q * w.K), w.stepping) for w in variant)
    over_stones = tuple((float(w.Q), w.stepping) for w in full)
    figure = Figure(figsize=(8.4, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, squeeze=False)[0]
    series = Series("variant sampling", over_product, fitted(over_product))
    plot_growth((series,), ax=left, size="stones Q x clusters K")
    series = Series("full batch sampling", over_stones, fitted(over_stones))
    plot_growth((series,), ax=right, size="stones Q")
    return Picture(
        "growth", figure,
        "Time of all steps of a wall: with variant sampling over Q K, with the full batch over Q, "
        "with the power laws fitted to them. The paper derives exponents of 1 and 2.",
    )  # fmt: skip


ITEM = Item("time against stones and clusters", "§6.2", make)
