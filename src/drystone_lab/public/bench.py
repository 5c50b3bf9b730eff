"""Runs of the public benchmark: every method on every wall with every seed."""

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from drystone.contacts.outlines import outlines_of_labels
from drystone.kernels.polygons import Points
from drystone.model.wall import Wall
from drystone.physics.building import ROUNDED
from drystone.physics.scene import Scene
from drystone.physics.shake import shake_once
from drystone.physics.table import load_engine
from drystone_lab.packing import load_packer
from drystone_lab.public.store import NOT_SHAKEN, BenchStore, KeptRun, Stamp, kept_run
from drystone_lab.public.suites import STRIP_SECONDS, BenchMethod, method_named, walls_of
from drystone_lab.public.tables import SHAKE, Result, Results, comparison, pair_tables
from drystone_lab.runs.outcome import Outcome, RunStore
from drystone_lab.runs.runner import Runner, Work, absent_data, one_by_one
from drystone_lab.runs.spec import STRIPS, RunSpec
from drystone_lab.table import BenchSettings, Table
from drystone_lab.walls import Target


def pga_of(spec: RunSpec, outcome: Outcome, data: Path | None) -> float | None:
    """Return the amplitude that a planned wall stands, g."""
    if not outcome.figures["placed"]:
        return None
    wall = outcome.wall(spec, data)
    # Wedges may fall out: the score is about stones.
    stones = frozenset(placement.stone_id for placement in wall.placements)
    scene = Scene(wall_outlines(wall), spec.settings().mu)
    trial = shake_once(scene, ROUNDED, watched=stones)
    return trial.pga_g


def wall_outlines(wall: Wall) -> Mapping[int, Points]:
    """Return the outlines of stones and wedges; of a wall of pixels, sub-pixel ones."""
    if wall.outlines is not None:
        return {block: np.asarray(corners) for block, corners in wall.outlines.blocks}
    return outlines_of_labels(wall.labels)


SEEDS, QUICK_SEEDS = 5, 2
"""How many unless it is said."""

RUNS = "runs"
"""Folder of the plans in a store."""

Task = tuple[Target, BenchMethod, RunSpec]


@dataclass(frozen=True, kw_only=True)
class PublicSettings(BenchSettings):
    """What is run, and by whom; `policies` are the methods, `jobs` None for this process."""

    suite: str  # One of :data:`drystone_lab.public.suites.PUBLIC_SUITES`
    stamp: Stamp  # Version, time and machine
    store: Path | None = None  # Folder of the runs that are kept; None keeps nothing
    again: bool = False  # Do runs again that are kept
    dask: str | None = None  # Address of a scheduler
    shake: bool = False  # Shake the walls too

    @property
    def seed_range(self) -> range:
        """All seeds."""
        count = self.seeds or (QUICK_SEEDS if self.quick else SEEDS)
        return range(self.seed, self.seed + count)


class _NothingKept(RunStore):
    """Keeps what it is given, and finds nothing of before."""

    def get(self, key: str) -> Outcome | None:
        del key
        return None


def run_public(settings: PublicSettings) -> tuple[Table, ...]:
    """Run a suite and compare its methods."""
    methods = [method_named(name, settings.changes) for name in settings.policies]
    asked = walls_of(settings.suite, settings.only, quick=settings.quick)
    walls = [wall for wall in asked if wall.source.is_there(settings.data)]
    if not walls:
        absent = dict.fromkeys(wall.source.name for wall in asked)
        raise absent_data(tuple(absent), known=settings.data is not None)
    for wall in walls:
        wall.source.check(settings.data)  # before an hour of planning, and before a run is kept
    # Methods take turns, so that all have the same day.
    tasks = [
        (wall, method, method.run(wall, seed))
        for wall in walls
        for seed in settings.seed_range
        for method in methods
    ]
    results = _done(tasks, settings)
    first, *others = (*comparison(results), *pair_tables(_planned(results)))
    notes = (*first.notes, *_yardstick(results), *_left_out(asked, walls))
    return (replace(first, notes=notes), *others)


def _planned(results: Results) -> Results:
    """Leave out the yardstick, which builds no walls to be compared."""
    return Results(tuple(result for result in results.all if result.method != STRIPS))


def _yardstick(results: Results) -> tuple[str, ...]:
    """Say what the yardstick is, where there is one."""
    if STRIPS not in results.methods:
        return ()
    return (
        f"{STRIPS} is a yardstick, in no pairs and no ranking: all stones packed into a strip as "
        f"high as the wall, by quarter turns, {STRIP_SECONDS} s each, without gravity, order or "
        "support. Its F_SF is their area over that of the strip, or over that of the wall where "
        "the strip is shorter; it has no other figures. What it finds depends on the machine.",
    )


def _done(tasks: Sequence[Task], settings: PublicSettings) -> Results:
    """Do the runs, keep them, and shake the walls if that is asked for."""
    if settings.shake:
        load_engine()  # what is missing is said before an hour of planning
    if any(method.name == STRIPS for _, method, _ in tasks):
        load_packer()
    store = None if settings.store is None else BenchStore(settings.store)
    kept = {} if store is None else {run.run_key: run for run in store.runs()}
    specs = [spec for _, _, spec in tasks]
    with _folder(settings) as folder, _workers(settings) as work:
        kind = _NothingKept if settings.again else RunStore
        runner = Runner(kind(Path(folder) / RUNS), settings.data, work, settings.say)
        outcomes = runner.run(specs)
    runs = [
        (spec, outcome, Result.of(wall, method.name, spec.seed, outcome))
        for (wall, method, spec), outcome in zip(tasks, outcomes, strict=True)
    ]
    if store is not None:
        new = [run for run in runs if settings.again or run[1].key not in kept]
        store.put(
            [
                kept_run(result, outcome, settings.changes, settings.stamp)
                for _, outcome, result in new
            ]
        )
    results = [result for _, _, result in runs]
    if settings.shake:
        results = _shaken(runs, {} if settings.again else kept, store, settings)
    if store is not None:
        for path in store.export():
            settings.say(f"wrote {path}")
    return Results(tuple(results))


def _shaken(
    runs: Sequence[tuple[RunSpec, Outcome, Result]],
    kept: Mapping[str, KeptRun],
    store: BenchStore | None,
    settings: PublicSettings,
) -> list[Result]:
    """Return the results with their amplitudes; each is kept at once, as it takes long."""
    results = []
    for number, (spec, outcome, result) in enumerate(runs, 1):
        if spec.method == STRIPS:
            results.append(_with_score(result, None))
            continue
        before = kept.get(outcome.key)
        if before is not None and before.shaken != NOT_SHAKEN:
            results.append(_with_score(result, before.pga_g))
            continue
        results.append(_with_score(result, pga_of(spec, outcome, settings.data)))
        if store is not None:
            store.put([kept_run(results[-1], outcome, settings.changes, settings.stamp)])
        settings.say(f"{number} of {len(runs)} walls shaken")
    return results


def _with_score(result: Result, pga_g: float | None) -> Result:
    return replace(result, figures={**result.figures, SHAKE: pga_g})


def _folder(settings: PublicSettings) -> AbstractContextManager[str]:
    if settings.store is None:
        return TemporaryDirectory(prefix="drystone-bench-")
    return nullcontext(str(settings.store))


def _workers(settings: PublicSettings) -> AbstractContextManager[Work]:
    if settings.dask is None and settings.jobs in (None, 1):
        return nullcontext(one_by_one)
    from drystone_lab.runs.workers import work_of  # noqa: PLC0415 - Dask is an extra

    return work_of(settings.jobs, settings.dask)


def _left_out(asked: Sequence[Target], there: Sequence[Target]) -> tuple[str, ...]:
    names = [wall.name for wall in asked if wall not in there]
    if not names:
        return ()
    return (
        f"Left out, as they need the published stone sets (`drystone fetch`, or --data DIR): "
        f"{', '.join(names)}.",
    )
