"""Suite "solvers": ms a candidate of every solver beside a fresh linprog, and how that grows."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import log
from statistics import median
from time import process_time

import numpy as np

from drystone.experiments.benchmark_walls import coursed_labels, irregular_labels
from drystone.experiments.fresh_linprog import TOLERANCE, fresh_linprog
from drystone.experiments.growing_walls import Pattern, built_up
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.kernels.certificate import figures
from drystone.kernels.simplex import MAX_PIVOTS, OPTIMAL, Added, Tilt
from drystone.kernels.simplex_growth import solve_added_numpy
from drystone.model.wall import Labels
from drystone.statics import growing_highs
from drystone.statics.appending import units_of
from drystone.statics.asking import Solver
from drystone.statics.ends import optimum
from drystone.statics.growing import GrowingAnalysis, growing
from drystone.statics.growing_simplex import MANY_BLOCKS, SimplexGrowth
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Block, RigidBlockModel
from drystone.statics.result import LateralResistance

COUNTS = (10, 30, 60, 100, 300, 1000)
QUICK_COUNTS = (10, 30)

CANDIDATES = {300: 3, 1000: 1}
"""From so many stones on the slow methods are given so many candidates."""

MANY = 8
"""Candidates of the methods that are fast with any number of stones."""

KERNEL_UP_TO = 300
"""Stones of the largest wall whose inverses are kept here; the planner's own limit is lower."""

EXPONENT_FROM = 30
"""Exponents are fitted from so many stones on."""

LINPROG, SIMPLEX, IPM, CLARABEL, WARM, NUMPY, KERNEL, GROWING = (
    "linprog",
    "HiGHS simplex",
    "HiGHS ipm",
    "Clarabel",
    "HiGHS warm",
    "kernel, NumPy",
    "kernel",
    "growing",
)
METHODS = (LINPROG, SIMPLEX, IPM, CLARABEL, WARM, NUMPY, KERNEL, GROWING)
SLOW = (LINPROG, SIMPLEX)
"""What takes half a minute a candidate at 1000 stones."""

REPEATS, ENOUGH_S = 9, 0.02
"""What is quick is timed so often, or for so long."""

Alphas = tuple[float, float] | None
"""To the left and to the right; None without a certified answer, or for a wall that falls."""

Found = tuple[Alphas, bool]
"""What a method says, and whether it had to start anew."""

Method = Callable[[RigidBlockModel], Found]


@dataclass(frozen=True, eq=False)
class Standing:
    """A wall that stands, in the hands of several methods, and stones that may come next.

    Parameters
    ----------
    pattern : Pattern
        Where stones lie.
    analyses : mapping of str to GrowingAnalysis
        Of the wall, by the name of the method.
    candidates : tuple of Block
        All stand on the wall.
    """

    pattern: Pattern
    analyses: Mapping[str, GrowingAnalysis]
    candidates: tuple[Block, ...]


@dataclass(frozen=True)
class Timing:
    """One method on the candidates of one wall.

    Parameters
    ----------
    milliseconds : float
        Median of CPU time over the candidates, both tilts.
    candidates : int
        How many it was given.
    unanswered : int
        Candidates that it had no certified answer for.
    cold : int
        Candidates that it had to solve from the start.
    difference : float or None
        The largest of alpha from linprog; None where both were not asked.
    """

    milliseconds: float
    candidates: int
    unanswered: int
    cold: int
    difference: float | None


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Time every method on the same candidates in the same process.

    Parameters
    ----------
    settings : BenchSettings
        `seed` of the walls; `quick` for 10 and 30 stones on coursed walls only.
    """
    makers: dict[str, Callable[[np.random.Generator, int], Labels]] = {"coursed": coursed_labels}
    if not settings.quick:
        makers["irregular"] = irregular_labels
    counts = QUICK_COUNTS if settings.quick else COUNTS
    timings = {
        (name, count): _timed(_standing(make(np.random.default_rng(settings.seed), count), count))
        for name, make in makers.items()
        for count in counts
    }
    return _times(timings), _answers(timings)


def _standing(labels: Labels, count: int) -> Standing:
    """Build with the stones of a wall from below, leaving out those that fall."""
    pattern = Pattern.of(labels)
    nothing, units = RigidBlockModel((), (), pattern.whole.mu), units_of(pattern.whole)
    starts: dict[str, GrowingAnalysis] = {
        GROWING: growing(nothing, units),
        WARM: growing_highs.begun(nothing, units),
    }
    if count <= KERNEL_UP_TO:
        starts[KERNEL] = SimplexGrowth.empty(nothing.mu, units, KERNEL_UP_TO)
    chosen = [
        analysis.model.blocks[-1]
        for analysis, _ in zip(built_up(pattern, starts[GROWING]), range(count), strict=False)
    ]
    analyses = {name: _with(pattern, start, chosen) for name, start in starts.items()}
    wall = analyses[GROWING]
    others = [stone for stone in pattern.stones if stone not in chosen]
    standing = (stone for stone in others if _stands(pattern, wall, stone))
    candidates = tuple(stone for stone, _ in zip(standing, range(MANY), strict=False))
    return Standing(pattern, analyses, candidates)


def _with(pattern: Pattern, analysis: GrowingAnalysis, stones: list[Block]) -> GrowingAnalysis:
    for stone in stones:
        analysis = analysis.extended(pattern.with_stones(analysis.model, (stone,)))
    return analysis


def _stands(pattern: Pattern, wall: GrowingAnalysis, stone: Block) -> bool:
    model = pattern.with_stones(wall.model, (stone,))
    return wall.resistance_with(model).resistance.stable


def _timed(wall: Standing) -> dict[str, Timing]:
    few = CANDIDATES.get(len(wall.analyses[GROWING].model.blocks), MANY)
    measured = {}
    for name, (method, analysis) in _methods(wall).items():
        stones = wall.candidates[:few] if name in SLOW else wall.candidates
        models = [wall.pattern.with_stones(analysis.model, (stone,)) for stone in stones]
        measured[name] = list(_measured(method, models))
    expected = [alphas for _, (alphas, _) in measured[LINPROG]]
    return {name: _timing(found, expected) for name, found in measured.items()}


def _timing(found: list[tuple[float, Found]], expected: list[Alphas]) -> Timing:
    differences = [
        abs(alpha - beta)
        for (_, (alphas, _)), betas in zip(found, expected, strict=False)
        for alpha, beta in zip(alphas or (), betas or (), strict=False)
    ]
    return Timing(
        milliseconds=median(milliseconds for milliseconds, _ in found),
        candidates=len(found),
        unanswered=sum(alphas is None for _, (alphas, _) in found),
        cold=sum(cold for _, (_, cold) in found),
        difference=max(differences, default=None),
    )


def _measured(method: Method, models: list[RigidBlockModel]) -> Iterator[tuple[float, Found]]:
    for model in models:
        times: list[float] = []
        while len(times) < REPEATS and sum(times) < ENOUGH_S:
            before = process_time()
            found = method(model)
            times.append(process_time() - before)
        yield 1e3 * median(times), found


def _methods(wall: Standing) -> dict[str, tuple[Method, GrowingAnalysis]]:
    """Return all methods that can do it, and the analysis whose candidates they take."""

    def asking(solver: Solver) -> Method:
        return lambda model: (_alphas(lateral_resistance(model, solver=solver)), False)

    def of(analysis: GrowingAnalysis) -> Method:
        def method(model: RigidBlockModel) -> Found:
            grown = analysis.resistance_with(model)
            return _alphas(grown.resistance), grown.solved_cold

        return method

    analyses = wall.analyses
    any_analysis = analyses[GROWING]
    methods: dict[str, tuple[Method, GrowingAnalysis]] = {
        LINPROG: (_linprog, any_analysis),
        SIMPLEX: (asking("highs"), any_analysis),
        IPM: (asking("highs-ipm"), any_analysis),
        CLARABEL: (asking("clarabel"), any_analysis),
        WARM: (of(analyses[WARM]), analyses[WARM]),
        GROWING: (of(any_analysis), any_analysis),
    }
    kernel = analyses.get(KERNEL)
    if isinstance(kernel, SimplexGrowth):
        methods[NUMPY] = (_in_numpy(kernel), kernel)
        methods[KERNEL] = (of(kernel), kernel)
    return methods


def _alphas(resistance: LateralResistance) -> Alphas:
    left, right = resistance.left.alpha, resistance.right.alpha
    return None if left is None or right is None else (left, right)


def _linprog(model: RigidBlockModel) -> Found:
    ends = fresh_linprog(model)
    return (None if ends is None or not ends[0] <= 0.0 <= ends[1] else (-ends[0], ends[1])), False


def _in_numpy(analysis: SimplexGrowth) -> Method:
    """Return what the kernels in NumPy do for a candidate, without making its columns."""
    program = analysis.program

    def end(tilt: Tilt, added: Added) -> float | None:
        answer = solve_added_numpy(tilt, added, MAX_PIVOTS)
        if answer.status != OPTIMAL:
            return None
        found = figures(
            program.cones, program.weights, added, answer.alpha, answer.forces, answer.velocity
        )
        certified = optimum(found, answer.alpha, tilt.sign, NUMPY)
        return None if certified is None or certified.falls else tilt.sign * certified.alpha

    def method(model: RigidBlockModel) -> Found:
        assert model.added is not None  # noqa: S101 - candidates are made by adding
        added = program.columns_of(model.added, model.mu)
        assert added is not None  # noqa: S101 - they are loose stones
        left, right = end(analysis.least, added), end(analysis.greatest, added)
        return (None if left is None or right is None else (left, right)), False

    return method


Timings = Mapping[tuple[str, int], Mapping[str, Timing]]


def _times(timings: Timings) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for kind in dict.fromkeys(kind for kind, _ in timings):
        of_kind = {count: found for (name, count), found in timings.items() if name == kind}
        for count, found in of_kind.items():
            times = [found[name].milliseconds if name in found else None for name in METHODS]
            ratio = found[LINPROG].milliseconds / found[GROWING].milliseconds
            rows.append((kind, str(count), *times, ratio))
        exponents = [
            _exponent(
                {
                    count: found[name].milliseconds
                    for count, found in of_kind.items()
                    if name in found
                }
            )
            for name in METHODS
        ]
        rows.append((kind, "exponent", *exponents, None))
    return Table(
        "Limit analysis of a candidate, both tilts: ms of CPU time",
        ("wall", "stones", *METHODS, "linprog / growing"),
        tuple(rows),
        (
            "Medians over the same candidates, stones that stand on top of the wall; every method"
            " but linprog certifies its answers, and all times include setting up.",
            f"Up to 100 stones {MANY} candidates; {LINPROG} and {SIMPLEX} get"
            f" {CANDIDATES[300]} at 300 and {CANDIDATES[1000]} at 1000, the others {MANY}.",
            f"{GROWING} is what a planner uses: the compiled kernel, if there is one, up to"
            f" {MANY_BLOCKS} stones, and then the neighbourhood of a stone, else {WARM}.",
            f"Exponents of growth are fitted from {EXPONENT_FROM} stones on.",
        ),
    )


def _exponent(milliseconds: Mapping[int, float]) -> float | None:
    """Fit log ms over log n; None with less than two points."""
    points = [(log(n), log(ms)) for n, ms in milliseconds.items() if n >= EXPONENT_FROM]
    if len(points) < 2:
        return None
    x, y = zip(*points, strict=True)
    return float(np.polyfit(x, y, 1)[0])


def _answers(timings: Timings) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (kind, str(count), name, of.candidates, of.unanswered, of.cold, of.difference)
        for (kind, count), found in timings.items()
        for name, of in ((name, found[name]) for name in METHODS if name in found)
    ]
    return Table(
        f"Answers, and the largest difference of alpha from {LINPROG}",
        ("wall", "stones", "method", "candidates", "uncertified", "solved cold", "difference"),
        tuple(rows),
        (
            f"{LINPROG} runs with tolerances of {TOLERANCE:g}; it is asked about the first"
            " candidates, and certifies nothing.",
            "Solved cold: a warm answer had no certificate, and all was solved from the start.",
        ),
    )
