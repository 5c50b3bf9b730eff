"""Suite "solvers": ms a candidate of every solver beside a fresh linprog, and how that grows."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import log
from statistics import median
from time import process_time

import numpy as np
from scipy.optimize import linprog

from drystone.experiments.benchmark_walls import coursed_labels, irregular_labels
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.model.wall import Labels
from drystone.statics.appending import units_of
from drystone.statics.asking import Solver
from drystone.statics.contacts.blocks import model_from_labels
from drystone.statics.growing import GrowingAnalysis, growing
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import GROUND, Block, RigidBlockModel
from drystone.statics.program import assemble
from drystone.statics.result import LateralResistance

COUNTS = (10, 30, 60, 300, 1000)
QUICK_COUNTS = (10, 30)

CANDIDATES = {10: 8, 30: 8, 60: 8, 300: 3, 1000: 1}
"""At so many stones the slow methods are given so many candidates."""

MANY = 8
"""Candidates of the methods that are fast with any number of stones."""

EXPONENT_FROM = 30
"""Exponents are fitted from so many stones on."""

LINPROG, SIMPLEX, IPM, CLARABEL, GROWING = (
    "linprog",
    "HiGHS simplex",
    "HiGHS ipm",
    "Clarabel",
    "growing",
)
METHODS = (LINPROG, SIMPLEX, IPM, CLARABEL, GROWING)
SLOW = (LINPROG, SIMPLEX)
"""What takes half a minute a candidate at 1000 stones."""

Alphas = tuple[float, float] | None
"""To the left and to the right; None without a certified answer, or for a wall that falls."""

Method = Callable[[RigidBlockModel], Alphas]


@dataclass(frozen=True, eq=False)
class Standing:
    """A wall that stands, and stones that may come next.

    Parameters
    ----------
    analysis : GrowingAnalysis
        Of the wall.
    candidates : tuple of RigidBlockModel
        The wall with one more stone each; all stand.
    """

    analysis: GrowingAnalysis
    candidates: tuple[RigidBlockModel, ...]


@dataclass(frozen=True)
class Timing:
    """CPU time of one method.

    Parameters
    ----------
    milliseconds : float
        Median over the candidates, both tilts.
    difference : float or None
        The largest of alpha from HiGHS simplex; None when there is none.
    unanswered : int
        Candidates that it had no certified answer for.
    """

    milliseconds: float
    difference: float | None
    unanswered: int


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
    return _times(timings), _differences(timings)


def _standing(labels: Labels, count: int) -> Standing:
    """Build with the stones of a wall from below, leaving out those that fall."""
    whole = model_from_labels(labels).model
    stones = sorted(whole.blocks, key=lambda block: (block.centroid[1], block.centroid[0]))
    analysis = growing(RigidBlockModel((), (), whole.mu), units_of(whole))
    candidates = []
    for stone in stones:
        model = _with_stone(analysis.model, stone, whole)
        extended = analysis.extended(model)
        if not extended.grown.resistance.stable:
            continue
        if len(analysis.model.blocks) < count:
            analysis = extended
        else:
            candidates.append(model)
            if len(candidates) == MANY:
                break
    return Standing(analysis, tuple(candidates))


def _with_stone(built: RigidBlockModel, stone: Block, whole: RigidBlockModel) -> RigidBlockModel:
    there = {GROUND, stone.id, *(block.id for block in built.blocks)}
    new = [i for i in whole.interfaces if stone.id in (i.block, i.other)]
    touching = (i for i in new if i.block in there and i.other in there)
    return built.with_added((stone,), tuple(touching))


def _timed(wall: Standing) -> dict[str, Timing]:
    few = wall.candidates[: CANDIDATES[len(wall.analysis.model.blocks)]]
    measured = {
        name: list(_measured(method, few if name in SLOW else wall.candidates))
        for name, method in _methods(wall.analysis).items()
    }
    expected = [alphas for _, alphas in measured[SIMPLEX]]
    return {name: _timing(found, expected) for name, found in measured.items()}


def _timing(found: list[tuple[float, Alphas]], expected: list[Alphas]) -> Timing:
    differences = [
        abs(alpha - beta)
        for (_, alphas), betas in zip(found, expected, strict=False)
        for alpha, beta in zip(alphas or (), betas or (), strict=False)
    ]
    return Timing(
        milliseconds=median(milliseconds for milliseconds, _ in found),
        difference=max(differences, default=None),
        unanswered=sum(alphas is None for _, alphas in found),
    )


def _measured(
    method: Method, candidates: tuple[RigidBlockModel, ...]
) -> Iterator[tuple[float, Alphas]]:
    for candidate in candidates:
        before = process_time()
        alphas = method(candidate)
        yield 1e3 * (process_time() - before), alphas


def _methods(analysis: GrowingAnalysis) -> dict[str, Method]:
    def asking(solver: Solver) -> Method:
        return lambda model: _alphas(lateral_resistance(model, solver=solver))

    return {
        LINPROG: _linprog,
        SIMPLEX: asking("highs"),
        IPM: asking("highs-ipm"),
        CLARABEL: asking("clarabel"),
        GROWING: lambda model: _alphas(analysis.resistance_with(model).resistance),
    }


def _alphas(resistance: LateralResistance) -> Alphas:
    left, right = resistance.left.alpha, resistance.right.alpha
    return None if left is None or right is None else (left, right)


def _linprog(model: RigidBlockModel) -> Alphas:
    """Solve both tilts by SciPy's defaults, each from the start."""
    program = assemble(model)
    bounds = np.zeros((program.column_count, 2))
    bounds[:, 1] = np.inf
    bounds[0, 0] = -np.inf
    costs = np.zeros(program.column_count)
    ends = []
    for sign in (-1.0, 1.0):
        costs[0] = -sign
        answer = linprog(costs, A_eq=program.matrix, b_eq=program.rhs, bounds=bounds)
        if answer.status != 0:
            return None
        ends.append(-answer.fun)
    return ends[0], ends[1]


Timings = Mapping[tuple[str, int], Mapping[str, Timing]]


def _times(timings: Timings) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for kind in dict.fromkeys(kind for kind, _ in timings):
        of_kind = {count: found for (name, count), found in timings.items() if name == kind}
        for count, found in of_kind.items():
            times = [found[name].milliseconds for name in METHODS]
            rows.append((kind, str(count), *times, times[0] / times[-1]))
        exponents = [
            _exponent({count: found[name].milliseconds for count, found in of_kind.items()})
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
            f"Up to 60 stones {MANY} candidates; {LINPROG} and {SIMPLEX} get"
            f" {CANDIDATES[300]} at 300 and {CANDIDATES[1000]} at 1000, the others {MANY}.",
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


def _differences(timings: Timings) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (kind, str(count), *(found[name].difference for name in METHODS))
        for (kind, count), found in timings.items()
    ]
    return Table(
        f"Largest difference of alpha from {SIMPLEX}",
        ("wall", "stones", *METHODS),
        tuple(rows),
        (
            f"{LINPROG} runs with its own tolerances, 1e-7; the others with 1e-9 and less.",
            *_unanswered(timings),
        ),
    )


def _unanswered(timings: Timings) -> list[str]:
    """Say which methods, asked alone, had no certified answer."""
    return [
        f"{name} had no certified answer for {timing.unanswered} candidates of the {kind} wall of"
        f" {count} stones."
        for (kind, count), found in timings.items()
        for name, timing in found.items()
        if timing.unanswered
    ]
