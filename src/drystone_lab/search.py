"""Suite "search": methods that look for good walls, compared at equal CPU time."""

from collections.abc import Mapping, Sequence
from statistics import median

from drystone.errors import UsageError
from drystone.planner.settings import method_settings
from drystone_lab.masons import masons_walls
from drystone_lab.paired import median_difference
from drystone_lab.planned_walls import missing_data
from drystone_lab.runs.spec import Changes, nested, told
from drystone_lab.search_runs import (
    FIGURES,
    SearchResult,
    SearchRun,
    method_name,
    searched,
    searched_walls,
)
from drystone_lab.search_ways import NO_COURSES, RESTARTS, SEARCH, WAYS, WEDGED
from drystone_lab.table import BenchSettings, Cell, Table

SECONDS, SEEDS = 20.0, 6
QUICK_SECONDS, QUICK_SEEDS = 0.1, 2

PAIRS = ((SEARCH, RESTARTS), (SEARCH, WEDGED), (SEARCH, NO_COURSES))
"""Methods that are compared: what the first has more than the second."""


ByWay = Mapping[str, Sequence[SearchResult]]
"""Results on one wall, seed after seed, by method."""


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Let every method look for every wall with every seed."""
    _check(settings.changes)
    times, seeds = _effort(settings)
    walls = [
        (target, stones)
        for target in searched_walls(settings)
        if (stones := target.stones(settings.data)) is not None
    ]
    results = searched(walls, seeds, times, settings)
    tables = []
    for seconds in times:
        compared = [
            (target.name, len(stones), _by_way(target.name, seeds, seconds, settings, results))
            for target, stones in walls
        ]
        medians = [row for one in compared for row in _rows(*one)]
        differences = [row for name, _, found in compared for row in _differences(name, found)]
        tables.append(_medians(medians, seconds, len(seeds), settings))
        tables.append(_paired(differences, seconds))
    return (*tables, masons_walls(settings))


def _check(changes: Changes) -> None:
    """Refuse settings that there are not (E123), and what walls and times say themselves (E138)."""
    own = [name for name, _ in changes if name in ("geometry", "search.budget")]
    if own:
        raise UsageError(
            "E138",
            f"{own[0]} cannot be replaced: walls are searched on outlines, for a time.",
            where="--settings",
            cure="Leave it out; see --only and --seconds.",
        )
    method_settings("best").updated(nested(changes))


def _medians(
    rows: Sequence[tuple[Cell, ...]], seconds: float, seeds: int, settings: BenchSettings
) -> Table:
    return Table(
        f"Best walls after {seconds:g} s of CPU time, medians of {seeds} seeds",
        ("wall", "method", "range", *FIGURES[:2], "possible F_SF", *FIGURES[2:], "walls", "s"),
        tuple(rows),
        (
            "Restarts: single passes from seed to seed, the best by the merit that the search "
            "goes by; with wedges: small ones are put into the gaps of the good ones, as in "
            "the search. Without courses: ruin and recreate alone.",
            "CPU time of one process, from the stones on; the last wall is begun in time and "
            "finished, where a longer time follows what is finished counts. No F_SF can be above "
            "the possible one: the area of all stones over that of the wall.",
            "2nd: by a definition that no search goes by (drystone.metrics.second).",
            *([f"With {told(settings.changes)}."] if settings.changes else []),
            *missing_data(settings),
        ),
    )


def _paired(rows: Sequence[tuple[Cell, ...]], seconds: float) -> Table:
    return Table(
        f"What the search has more after {seconds:g} s, medians of the pairs of one seed "
        "(95 % intervals)",
        ("wall", "more than", "merit higher", *FIGURES),
        tuple(rows),
        (
            "Percentile bootstrap over the seeds with fixed random numbers. It cannot be wider "
            "than the differences that were seen. They hold the median of all with "
            "1 - 0.5^(n - 1) where there are n.",
            "Fewer is better for F_AH, T_LEVEL and E_FLUSH.",
        ),
    )


def _effort(settings: BenchSettings) -> tuple[tuple[float, ...], range]:
    """Return after which times methods are asked, and the seeds."""
    usual = (QUICK_SECONDS, QUICK_SEEDS) if settings.quick else (SECONDS, SEEDS)
    times = tuple(sorted(set(settings.seconds))) or (usual[0],)
    return times, range(settings.seed, settings.seed + (settings.seeds or usual[1]))


def _by_way(
    wall: str,
    seeds: Sequence[int],
    seconds: float,
    settings: BenchSettings,
    results: Mapping[SearchRun, SearchResult],
) -> ByWay:
    """Sort the results of a wall after a time by methods."""
    found = {}
    for way in WAYS:
        method = method_name(way.name, settings.changes)
        runs = [SearchRun(wall, method, seed, seconds) for seed in seeds]
        if runs[0] in results:
            found[way.name] = [results[run] for run in runs]
    return found


def _rows(wall: str, stones: int, by_way: ByWay) -> list[tuple[Cell, ...]]:
    rows: list[tuple[Cell, ...]] = []
    for way, results in by_way.items():
        placed = [count for count in _values(results, "placed") if count is not None]
        medians = [_median(_values(results, figure)) for figure in FIGURES]
        spent = [_median(_values(results, name)) for name in ("walls", "CPU s")]
        words = f"{min(placed)}-{max(placed)} of {stones}"
        possible = results[0]["possible F_SF"]
        rows.append((wall, way, words, *medians[:2], possible, *medians[2:], *spent))
    return rows


def _differences(wall: str, by_way: ByWay) -> list[tuple[Cell, ...]]:
    rows: list[tuple[Cell, ...]] = []
    for pair in PAIRS:
        if not by_way.keys() >= set(pair):
            continue
        first, second = (by_way[way] for way in pair)
        merits = zip(_values(first, "merit"), _values(second, "merit"), strict=True)
        better = [a is not None and b is not None and a > b for a, b in merits]
        cells = [
            median_difference(_values(first, figure), _values(second, figure)) for figure in FIGURES
        ]
        told = [None if cell is None else cell.text() for cell in cells]
        rows.append((wall, pair[1], f"{sum(better)} of {len(better)}", *told))
    return rows


def _values(results: Sequence[SearchResult], figure: str) -> list[float | None]:
    return [result[figure] for result in results]


def _median(values: Sequence[float | None]) -> float | None:
    found = [value for value in values if value is not None]
    return median(found) if found else None
