"""Suite "search": methods that look for good walls, compared at equal CPU time."""

from collections.abc import Mapping, Sequence

from drystone.errors import UsageError
from drystone.io.published import published_file
from drystone.io.wall_image import read_wall_image
from drystone.metrics.frame import reduce_labels
from drystone.metrics.measure import measure_labels
from drystone.metrics.second import FINER, finer_labels, second_arrangement
from drystone.model.wall import Labels
from drystone.planner.settings import method_settings
from drystone_lab.paired import median_difference, median_of
from drystone_lab.planned_walls import SETS, missing_data
from drystone_lab.runs.spec import Changes, nested, told
from drystone_lab.search_runs import (
    FIGURES,
    NO_COURSES,
    RESTARTS,
    SEARCH,
    WAYS,
    WEDGED,
    SearchResult,
    SearchRun,
    method_name,
    searched,
    searched_walls,
)
from drystone_lab.table import BENCH, BenchSettings, Cell, Table, worded

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
    with_settings = [f"With {told(settings.changes)}."] if settings.changes else []
    notes = (*with_settings, *missing_data(settings))
    for seconds in times:
        compared = [
            (target.name, len(stones), _by_way(target.name, seeds, seconds, settings, results))
            for target, stones in walls
        ]
        medians = [row for one in compared for row in _rows(*one)]
        differences = [row for name, _, found in compared for row in _differences(name, found)]
        of = BENCH["search"]
        tables.append(worded(of["medians"], medians, more=notes, seconds=seconds, seeds=len(seeds)))
        columns = {"<figures>": FIGURES}
        tables.append(worded(of["paired"], differences, columns=columns, seconds=seconds))
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
        medians = [median_of(_values(results, figure)) for figure in FIGURES]
        spent = [median_of(_values(results, name)) for name in ("walls", "CPU s")]
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


def masons_walls(settings: BenchSettings) -> Table:
    """Measure the walls of Almeida et al. (2021) as they were traced, at the working scales."""
    rows = []
    for wall in SETS:
        if settings.data is not None and wall.source.is_there(settings.data):
            labels = read_wall_image(published_file(settings.data, wall.source.name))
            rows.append(masons_row(wall.name, labels, wall.scale))
    return worded(BENCH["search"]["masons"], rows)


def masons_row(name: str, labels: Labels, scale: float) -> tuple[Cell, ...]:
    """Measure one of them."""
    reduced = reduce_labels(labels, scale)
    first = measure_labels(reduced)
    repeated = second_arrangement(finer_labels(reduced))
    sampled = second_arrangement(reduce_labels(labels, FINER * scale))
    height, width = reduced.shape
    return (
        name, f"{width}x{height}", first.stones, first.F_SF, first.F_AV, first.F_AH,
        repeated.F_AV, repeated.F_AH, sampled.F_AV, sampled.F_AH,
    )  # fmt: skip
