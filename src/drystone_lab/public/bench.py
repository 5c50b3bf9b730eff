"""Runs of the public benchmark: every method on every wall with every seed."""

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from drystone.contacts.outlines import outlines_of_labels
from drystone.physics.building import ROUNDED
from drystone.physics.scene import EngineScene
from drystone.physics.shake import shake_once
from drystone.physics.table import load_engine
from drystone_lab.packing import load_packer
from drystone_lab.public.store import CSV, NOT_SHAKEN, KeptRun, keep, kept_runs
from drystone_lab.public.suites import STRIP_SECONDS, method_named, walls_of
from drystone_lab.public.tables import BenchResults, comparison, pair_tables
from drystone_lab.runs.outcome import Runner, RunOutcome, absent_data
from drystone_lab.runs.spec import STRIPS, RunSpec
from drystone_lab.runs.workers import work_of
from drystone_lab.table import BENCH, BenchSettings, Table
from drystone_lab.walls import Target


def pga_of(spec: RunSpec, outcome: RunOutcome, data: Path | None) -> float | None:
    """Return the amplitude that a planned wall stands, g."""
    if not outcome.figures["placed"]:
        return None
    wall = outcome.wall(spec, data)
    exact = wall.outlines
    outlines = outlines_of_labels(wall.labels) if exact is None else dict(exact.blocks)
    # Wedges may fall out: the score is about stones.
    stones = frozenset(placement.stone_id for placement in wall.placements)
    return shake_once(EngineScene(outlines, spec.settings().mu), ROUNDED, watched=stones)


def run_public(suite: str, settings: BenchSettings, made_at: str) -> tuple[Table, ...]:
    """Run a suite and compare its methods.

    The tables are walls, all walls, and seconds; then the differences of two methods or more, and
    their ranking.
    """
    methods = {name: method_named(name, settings.changes) for name in settings.policies}
    asked = walls_of(suite, settings.only, quick=settings.quick)
    walls = [wall for wall in asked if wall.source.is_there(settings.data)]
    if not walls:
        absent = dict.fromkeys(wall.source.name for wall in asked)
        raise absent_data(tuple(absent), known=settings.data is not None)
    for wall in walls:
        wall.source.check(settings.data)  # before an hour of planning, and before a run is kept
    count = settings.seeds or (2 if settings.quick else 5)
    # Methods take turns, so that all have the same day.
    tasks = [
        (wall, name, wall.run(seed, *changes, method=method))
        for wall in walls
        for seed in range(settings.seed, settings.seed + count)
        for name, (method, changes) in methods.items()
    ]
    results = _done(tasks, settings, made_at)
    # The yardstick builds no walls to be compared.
    planned = BenchResults(tuple(result for result in results.all if result.method != STRIPS))
    first, *others = (*comparison(results), *pair_tables(planned))
    notes = [*first.notes]
    if STRIPS in results.methods:
        words = BENCH["public"]["yardstick"]
        notes.append(words.format(method=STRIPS, seconds=STRIP_SECONDS))
    if left_out := ", ".join(wall.name for wall in asked if wall not in walls):
        needed = "as they need the published stone sets (`drystone fetch`, or --data DIR)"
        notes.append(f"Left out, {needed}: {left_out}.")
    return (replace(first, notes=tuple(notes)), *others)


def _done(
    tasks: Sequence[tuple[Target, str, RunSpec]], settings: BenchSettings, made_at: str
) -> BenchResults:
    """Do the runs, keep them, and shake the walls if that is asked for."""
    if settings.shake:
        load_engine()  # what is missing is said before an hour of planning
    if any(spec.method == STRIPS for *_, spec in tasks):
        load_packer()
    store = settings.store
    kept = {} if store is None else {run.run_key: run for run in kept_runs(store)}
    with (
        TemporaryDirectory(prefix="drystone-bench-") if store is None else nullcontext(store) as at,
        work_of(settings.jobs, settings.dask) as work,
    ):
        runner = Runner(Path(at) / "runs", settings.data, work, settings.say, again=settings.again)
        outcomes = runner.run([spec for *_, spec in tasks])
    runs = [
        KeptRun.of(wall, method, spec.seed, outcome, settings.changes, made_at)
        for (wall, method, spec), outcome in zip(tasks, outcomes, strict=True)
    ]
    if store is not None:
        keep(store, [run for run in runs if settings.again or run.run_key not in kept])
    for k, (run, outcome) in enumerate(zip(runs, outcomes, strict=True) if settings.shake else ()):
        before = None if settings.again else kept.get(run.run_key)
        shakes = run.method != STRIPS and (before is None or before.shaken == NOT_SHAKEN)
        pga_g = None if before is None else before.pga_g
        if shakes:
            pga_g = pga_of(tasks[k][-1], outcome, settings.data)
        runs[k] = replace(run, pga_g=pga_g, shaken="falls" if pga_g is None else "yes")
        if shakes:
            if store is not None:  # at once, as it takes long
                keep(store, [runs[k]])
            settings.say(f"{k + 1} of {len(runs)} walls shaken")
    if store is not None:
        settings.say(f"wrote {store / CSV}")
    return BenchResults(tuple(runs))
