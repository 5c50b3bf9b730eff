"""What methods came to on walls: tables that compare them, and quality by version."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, compress, groupby, zip_longest
from math import fsum, sqrt
from statistics import fmean, stdev
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import rankdata, wilcoxon

from drystone.drawing.canvas import name_axes
from drystone_lab.cells import LEVEL, LOWER_IS_BETTER, differences, interval_of, median_of
from drystone_lab.pictures import LOOKS, panel_sheet
from drystone_lab.public.store import NOT_SHAKEN, PLACED, SHAKE, KeptRun
from drystone_lab.table import BENCH, Cell, Table, worded

FIGURES = (PLACED, "F_SF", "F_AV", "F_AH", "F_LR")
"""The figures that are compared: share of the stones that is placed, and the paper's four; where
walls were shaken the amplitude that they stand on a shaking table too."""

NAMES = {PLACED: "placed share", SHAKE: "PGA, g", "seconds": "wall, s"}
"""What figures are called; others have names that say enough."""

SHOWN = {NAMES.get(figure, figure): figure for figure in (*FIGURES, SHAKE, "seconds")}
"""Of a history: what each is called, and which it is."""

DECIMALS = 9
"""Values that agree so far are equal: they differ by rounding errors of sums."""


@dataclass(frozen=True, eq=False)
class BenchResults:
    """Results of every method on every wall with every seed."""

    all: tuple[KeptRun, ...]  # Of each method for the same walls and seeds, in the same order

    @property
    def walls(self) -> tuple[str, ...]:
        """Walls, in order."""
        return tuple(dict.fromkeys(result.wall for result in self.all))

    @property
    def methods(self) -> tuple[str, ...]:
        """Methods, in order."""
        return tuple(dict.fromkeys(result.method for result in self.all))

    @property
    def figures(self) -> tuple[str, ...]:
        """Figures that walls have."""
        shaken = any(result.shaken != NOT_SHAKEN for result in self.all)
        return (*FIGURES, SHAKE) if shaken else FIGURES

    def of(self, method: str, wall: str | None = None) -> tuple[KeptRun, ...]:
        """Return the results of a method on a wall or on all."""
        return tuple(r for r in self.all if r.method == method and wall in (None, r.wall))

    def values(self, method: str, figure: str) -> tuple[float | None, ...]:
        """Return a figure of the results of a method, as :meth:`of` orders them."""
        return tuple(result.figure(figure) for result in self.of(method))

    def counting(self, one: str, other: str) -> tuple[bool, ...]:
        """Say which results of two methods, as :meth:`of` orders them, count as pairs.

        On a wall where neither method depends on the seed all pairs are copies of one, which
        counts once: they are no more evidence than it.
        """
        counts: list[bool] = []
        pairs = zip(self.of(one), self.of(other), strict=True)
        for _, group in groupby(pairs, key=lambda pair: pair[0].wall):
            figures = [(_comparable(first), _comparable(second)) for first, second in group]
            copies = len(set(figures)) == 1
            counts += [number == 0 or not copies for number in range(len(figures))]
        return tuple(counts)


def _comparable(result: KeptRun) -> tuple[float | None, ...]:
    """Return the figures without the rounding errors of sums."""
    figures = (result.figure(name) for name in (*FIGURES, SHAKE))
    return tuple(None if value is None else round(value, DECIMALS) for value in figures)


def comparison(results: BenchResults) -> tuple[Table, ...]:
    """Return the figures of every method on every wall, on all walls, and the times."""
    figures, words = results.figures, BENCH["public"]
    titles = [t for one in figures for t in (NAMES.get(one, one), f"±{one}", f"best {one}")]
    columns = {"<figures>": titles}
    each = {
        (wall, method): results.of(method, wall)
        for wall in results.walls
        for method in results.methods
    }
    walls = [(*key, len(runs), *_cells(figures, [runs])) for key, runs in each.items()]
    everything = (
        (method, len(results.of(method)),
         *_cells(figures, [each[wall, method] for wall in results.walls]))
        for method in results.methods
    )  # fmt: skip
    times: list[tuple[Cell, ...]] = []
    for key, runs in each.items():
        seconds = [run.seconds for run in runs]
        spread = _rounded(stdev(seconds), 3) if len(seconds) > 1 else None
        times.append((*key, _rounded(fmean(seconds), 3), spread, _rounded(min(seconds), 3)))
    return (
        worded(words["walls"], walls, columns=columns, more=_undefined(results)),
        worded(words["everything"], everything, columns=columns),
        worded(words["times"], times),
    )


def _cells(figures: Sequence[str], walls: Sequence[Sequence[KeptRun]]) -> tuple[Cell, ...]:
    """Return mean, spread and best of every figure; None where no wall of the method has it."""
    cells: list[Cell] = []
    for figure in figures:
        defined = [
            [value for result in each if (value := result.figure(figure)) is not None]
            for each in walls
        ]
        found = [values for values in defined if values]
        spreads = [stdev(values) for values in found if len(values) > 1]
        best = min if figure in LOWER_IS_BETTER else max
        cells += [
            _rounded(fmean(fmean(values) for values in found)) if found else None,
            _rounded(sqrt(fsum(s * s for s in spreads) / len(spreads))) if spreads else None,
            _rounded(fmean(best(values) for values in found)) if found else None,
        ]
    return tuple(cells)


def _undefined(results: BenchResults) -> Iterator[str]:
    """Say how many walls have no value of a figure, which is left out of means and never 0."""
    for figure in results.figures:
        said = ", ".join(
            f"{method} {count} of {len(results.of(method))}"
            for method in results.methods
            if (count := results.values(method, figure).count(None))
        )
        why = "nothing was built, or it does not stand at rest in the engine; "
        why = why if figure == SHAKE else ""
        if said:
            yield f"{figure} is not defined for walls of {said}: {why}left out of means, never 0."


def _rounded(value: float, digits: int = 4) -> float:
    return float(f"{value:.{digits}g}")


@dataclass(frozen=True)
class MethodPair:
    """What one method has more than another, of one figure."""

    pairs: int  # Walls, each with a seed that counts, for which both have a value
    left_out: int  # Those for which one or both have none
    mean: float  # Of the differences, first minus second
    low: float  # low, high: Ends of the percentile bootstrap interval of the mean
    high: float
    won: float  # Share of the pairs in which the first is better; of equal ones half
    p: float  # Of Wilcoxon's signed-rank test, two-sided, not corrected

    @property
    def holds_zero(self) -> bool:
        """Nothing is shown: 0 is in the interval."""
        return self.low <= 0 <= self.high


def compared(
    first: Sequence[float | None], second: Sequence[float | None], *, higher: bool = True
) -> MethodPair | None:
    """Compare two methods by one figure.

    >>> found = compared([3.0, 4.0, 9.0, None], [1.0, 2.0, 7.0, 1.0])
    >>> found.mean, found.low, found.high, found.won, found.p, found.left_out
    (2.0, 2.0, 2.0, 1.0, 0.25, 1)
    """
    found = np.array([round(each, DECIMALS) for each in differences(first, second)])
    if not found.size:
        return None
    low, high = interval_of(found, np.mean)
    better = found if higher else -found
    won = float(np.mean((better > 0) + 0.5 * (better == 0)))
    left_out = len(first) - found.size
    mean = float(found.mean())
    return MethodPair(found.size, left_out, mean, low, high, won, _signed_rank(found))


def holm(p_values: Sequence[float]) -> list[float]:
    """Correct p values for how many they are (Holm 1979).

    >>> holm([0.01, 0.04, 0.03])
    [0.03, 0.06, 0.06]
    """
    order = np.argsort(p_values)
    times = np.arange(len(p_values), 0, -1) * np.asarray(p_values)[order]
    corrected = np.empty(len(p_values))
    corrected[order] = np.minimum(1.0, np.maximum.accumulate(times))
    return corrected.tolist()


PairKey = tuple[str, str, str]
"""Figure, first method, second method."""


def pair_tables(results: BenchResults) -> tuple[Table, ...]:
    """Return the differences of all pairs of methods, a table a figure, and the ranking."""
    if len(results.methods) < 2:
        return ()
    counting = {pair: results.counting(*pair) for pair in combinations(results.methods, 2)}
    found: dict[PairKey, MethodPair] = {}
    for figure in results.figures:
        for pair, counts in counting.items():
            values = (list(compress(results.values(name, figure), counts)) for name in pair)
            one = compared(*values, higher=figure not in LOWER_IS_BETTER)
            if one is not None:
                found[figure, *pair] = one
    corrected = holm([one.p for one in found.values()])
    known = {key: replace(one, p=p) for (key, one), p in zip(found.items(), corrected, strict=True)}
    copies = not all(map(all, counting.values()))
    tables = [_pairs_table(figure, known, copies=copies) for figure in results.figures]
    return (*tables, _ranking(results, known))


def _pairs_table(figure: str, known: Mapping[PairKey, MethodPair], *, copies: bool) -> Table:
    rows: list[tuple[Cell, ...]] = []
    pairs = {key[1:]: pair for key, pair in known.items() if key[0] == figure}
    for (first, second), pair in pairs.items():
        cells = (_rounded(value, 3) for value in (pair.mean, pair.low, pair.high, pair.won))
        better = second if (pair.mean > 0) == (figure in LOWER_IS_BETTER) else first
        shown = "nothing" if pair.holds_zero else better if pair.p < LEVEL else f"{better}?"
        rows.append((first, second, pair.pairs, *cells, _rounded(pair.p, 2), shown))
    less = sum(pair.left_out for pair in pairs.values())
    more = [f"{less} pairs lack a value of one or both and are left out."] if less else []
    if copies:
        more.append(
            "Walls on which two methods do not depend on the seed count once for these two."
        )
    # No p of so few pairs may reach the level of significance.
    most = max((pair.pairs for pair in pairs.values()), default=0)
    least = min(1.0, len(known) * 2.0 ** (1 - most)) if most else 1.0
    if least >= LEVEL:
        cure = "walls, or --seeds where they change something" if copies else "--seeds"
        tests = f"With {most} pairs and {len(known)} tests"
        more.append(f"{tests} no p can be below {least:.2g}: use more {cure}.")
    return worded(BENCH["public"]["pairs"], rows, more=more, figure=figure, tests=len(known))


def _ranking(results: BenchResults, known: Mapping[PairKey, MethodPair]) -> Table:
    """Rank the methods by their mean rank over figures, walls and seeds."""
    ranks: dict[str, list[float]] = {method: [] for method in results.methods}
    for figure in results.figures:
        sign = 1.0 if figure in LOWER_IS_BETTER else -1.0
        values = [
            [np.inf if value is None else sign * round(value, DECIMALS)
             for value in results.values(method, figure)]
            for method in results.methods
        ]  # fmt: skip
        for method, rank in zip(ranks, rankdata(values, axis=0).mean(axis=1), strict=True):
            ranks[method].append(float(rank))
    shown = {key for key, pair in known.items() if not pair.holds_zero and pair.p < LEVEL}
    order = sorted(ranks, key=lambda method: fmean(ranks[method]))
    rows: list[tuple[Cell, ...]] = []
    for place, (method, other) in enumerate(zip_longest(order, order[1:]), 1):
        # Figures in which it is not told apart from the next.
        same = [
            figure
            for figure in results.figures
            if not {(figure, method, other), (figure, other, method)} & shown
        ]
        alike = None if other is None else ", ".join(same) or "none"
        cells = (round(each, 3) for each in (fmean(ranks[method]), *ranks[method]))
        rows.append((place, method, *cells, alike))
    columns = {"<figures>": results.figures}
    return worded(BENCH["public"]["ranking"], rows, columns=columns)


def _signed_rank(differences: np.ndarray) -> float:
    """Return p of Wilcoxon's signed-rank test; 1 where all pairs are equal.

    Equal pairs are left out.  Figures such as the placed share are often equal and often tied:
    the normal distribution then gives too small a p for the few pairs that are left.
    """
    moved = differences[differences != 0]
    if not moved.size:
        return 1.0
    if moved.size > 50:  # their distribution is not counted out
        return float(wilcoxon(moved).pvalue)
    # Shared ranks are halves: doubled they are whole.
    doubled = np.rint(2 * rankdata(np.abs(moved))).astype(int)
    chances = np.zeros(int(doubled.sum()) + 1)
    chances[0] = 1.0
    for rank in doubled.tolist():
        chances /= 2
        chances[rank:] = chances[rank:] + chances[:-rank]
    above, below = doubled[moved > 0].sum(), doubled[moved < 0].sum()
    return min(1.0, 2 * float(chances[: min(above, below) + 1].sum()))


class Medians(NamedTuple):
    """What a method came to in a version."""

    suite: str  # Suite and its version, such as ``"masons/1"``
    method: str  # Its name, with settings that were replaced
    version: str
    runs: tuple[tuple[str, int], ...]  # Walls and seeds
    values: dict[str, float | None]  # Median of each figure over its runs; None where no run has it


def medians_of(runs: Sequence[KeptRun]) -> tuple[Medians, ...]:
    """Return medians by suite, method and version, oldest version first."""
    groups: dict[tuple[str, str, str], list[KeptRun]] = {}
    for run in runs:
        suite = f"{run.suite}/{run.suite_version}"
        method = run.method if run.settings == "{}" else f"{run.method} {run.settings}"
        groups.setdefault((suite, method, run.version), []).append(run)
    found = [
        Medians(
            *key,
            tuple(sorted((run.wall, run.seed) for run in group)),
            {name: median_of([run.figure(of) for run in group]) for name, of in SHOWN.items()},
        )
        for key, group in groups.items()
    ]
    return tuple(sorted(found, key=lambda m: (m.suite, m.method, version_order(m.version))))


def history_table(medians: Sequence[Medians]) -> Table:
    """Return the medians as a table."""
    rows: list[tuple[Cell, ...]] = [
        (one.suite, one.method, one.version, len(one.runs),
         *(None if value is None else float(f"{value:.4g}") for value in one.values.values()))
        for one in medians
    ]  # fmt: skip
    runs: dict[str, set[tuple[tuple[str, int], ...]]] = {}
    for one in medians:
        runs.setdefault(f"{one.suite} {one.method}", set()).add(one.runs)
    differing = ", ".join(sorted(name for name, of in runs.items() if len(of) > 1))
    other = "Versions have runs of different walls or seeds, so their medians cannot be compared"
    notes = [f"{other}: {differing}."] if differing else []
    words = BENCH["public"]["history"]
    return worded(words, rows, columns={"<figures>": tuple(SHOWN)}, more=notes)


def drawn_history(medians: Sequence[Medians]) -> Figure:
    """Draw the medians of one suite over versions: a panel a figure that any method has.

    A line a method, with one legend; lines are dashed where colours come round again.
    """
    versions = sorted({one.version for one in medians}, key=version_order)
    methods = dict.fromkeys(one.method for one in medians)
    values = {(one.method, one.version): one.values for one in medians}
    known = [name for name in SHOWN if any(one.values[name] is not None for one in medians)]
    title = f"suite {medians[0].suite}: medians over walls and seeds (F_AH: lower is better)"
    sheet, panels = panel_sheet(len(known), 3, (3.4, 2.4), title)
    for ax, figure in zip(panels, known, strict=True):
        for number, method in enumerate(methods):
            turn, place = divmod(number, len(LOOKS))
            colour, marker = LOOKS[place]
            found = [values.get((method, version), {}).get(figure) for version in versions]
            points = [(x, value) for x, value in enumerate(found) if value is not None]
            ax.plot(
                [x for x, _ in points], [value for _, value in points], color=colour,
                marker=marker, markersize=4.5, linewidth=1, linestyle="--" if turn else "-",
                label=method,
            )  # fmt: skip
        ax.set_xticks(range(len(versions)), versions)
        ax.set_xlim(-0.4, len(versions) - 0.6)
        name_axes(ax, "version", figure)
    sheet.legend(
        *panels[0].get_legend_handles_labels(), fontsize=7, edgecolor="none",
        loc="outside lower center", ncols=min(len(methods), 8),
    )  # fmt: skip
    return sheet


def version_order(version: str) -> tuple[tuple[int, int, str], ...]:
    """Return what sorts versions, pre-releases before their release.

    >>> sorted(["0.10.0", "0.9.1", "0.10.0rc1", "0.9"], key=version_order)
    ['0.9', '0.9.1', '0.10.0rc1', '0.10.0']
    """
    parts = re.findall(r"\d+|[a-z]+", version.lower())
    # Letters come before the end, and the end before numbers and post-releases.
    marked = [(2, int(part), "") if part.isdigit() else (2 * (part == "post"), 0, part)
              for part in parts]  # fmt: skip
    return (*marked, (1, 0, ""))
