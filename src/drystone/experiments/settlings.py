"""Suite "settling": how long it takes, and what becomes of the proposals of a planner."""

import os
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np

from drystone.experiments.exact_walls import Target, one_pass, targets
from drystone.experiments.planned_walls import missing_data
from drystone.experiments.table import BenchSettings, Cell, Table
from drystone.kernels.settling import Settling, settle
from drystone.model.landscape import Landscape
from drystone.model.placement import Side
from drystone.model.site import Site
from drystone.model.stone import StoneSet
from drystone.planner.build import Build
from drystone.planner.planner import Planner
from drystone.planner.profile import Part
from drystone.planner.proposing import Trial, one_by_one
from drystone.planner.settling import ExactProposer
from drystone.settle.rest import Scene, Turned, ways
from drystone.settle.settings import SettleSettings

SIDES: tuple[Side, ...] = ("left", "right")

EVERY = 3
"""Steps between those whose proposals are looked at."""

SAMPLE = 400
"""Settlings that are timed one by one."""

REPEATS = 5
"""Each is timed so often, and its least time counts."""


@dataclass(frozen=True, eq=False)
class Attempted:
    """A settling that a planner asked for.

    Parameters
    ----------
    stone : Turned
        As the scene sees it.
    scene : Scene
        What was there.
    start : (float, float)
        Where it was let go.
    """

    stone: Turned
    scene: Scene
    start: tuple[float, float]


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Time settlings of planned walls, and whole walls."""
    chosen = targets(settings, 4)
    found = [(t, stones) for t in chosen if (stones := t.stones(settings)) is not None]
    return (
        Table(
            "Milliseconds of a settling, and what becomes of proposals",
            (
                "wall", "settlings", "median", "95 %", "99 %", "longest",
                "steps", "rest %", "fall %", "too far %", "other %",
            ),
            tuple(_settlings(target, stones, settings) for target, stones in found),
            (
                "Every proposal of one pass, let go as the planner lets it go (the least of five "
                "times each). Rest, fall, too far: of the first way of settling that is tried.",
                *missing_data(settings),
            ),
        ),
        Table(
            "Seconds of a whole pass, and where they go (one thread)",
            ("wall", "stones", "poses tried", "1 thread", f"{os.cpu_count() or 1} threads",
             "placement", "stabilisation", "contacts", "limit analysis", "indices"),
            tuple(_whole(target, stones) for target, stones in found),
        ),
    )  # fmt: skip


def _settlings(target: Target, stones: StoneSet, settings: BenchSettings) -> tuple[Cell, ...]:
    attempts = _attempts(target, stones)
    rng = np.random.default_rng(settings.seed)
    size = min(len(attempts), 20 if settings.quick else SAMPLE)
    sample = [attempts[k] for k in rng.choice(len(attempts), size, replace=False)]
    outcomes = [_settled(one) for one in sample]
    times = np.array([_least_ms(one) for one in sample])
    ended = Counter(outcome.status.name for outcome in outcomes)
    shares = {name: 100.0 * count / size for name, count in ended.items()}
    known = ("RESTS", "FALLS", "FAR")
    return (
        target.name,
        len(attempts),
        float(np.median(times)),
        *(float(np.percentile(times, share)) for share in (95, 99, 100)),
        float(np.median([outcome.steps for outcome in outcomes])),
        *(shares.get(name, 0.0) for name in known),
        sum(share for name, share in shares.items() if name not in known),
    )


def _attempts(target: Target, stones: StoneSet) -> list[Attempted]:
    """Plan a wall and note what its planner lets go in every few steps."""
    planner = _planner(target, stones)
    builds = [planner.build, *(step.build for step in planner.steps())]
    return [one for build in builds[:-1:EVERY] for one in _let_go(planner, build)]


def _let_go(planner: Planner, build: Build) -> Iterator[Attempted]:
    workshop = planner.workshop
    proposer = ExactProposer(workshop, planner.settings, build, planner.profile)
    trials = [
        Trial((posed,), Landscape.of(build.wall, side), workshop.rest(build))
        for side in SIDES
        for stone_id in workshop.remaining(build)
        for posed in workshop.poses(stone_id)
    ]
    for drop in next(proposer.batches(trials, one_by_one), []):
        posed, side = drop.trial.poses[0], drop.trial.landscape.side
        hung = workshop.outlines.hung(posed.stone, posed.angle_deg, side)
        yield Attempted(hung.turned, proposer.view(side)[0], drop.start)


def _settled(one: Attempted) -> Settling:
    stone, scene = one.stone, one.scene
    rules = ways(stone, scene, SettleSettings())[0]
    start = (*one.start, 0.0)
    return settle(stone.corners, stone.edges, start, scene.polygons, scene.width_px, rules)


def _least_ms(one: Attempted) -> float:
    times = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        _settled(one)
        times.append(time.perf_counter() - started)
    return 1e3 * min(times)


def _whole(target: Target, stones: StoneSet) -> tuple[Cell, ...]:
    seconds, planner = [], _planner(target, stones)
    for threads in (1, os.cpu_count() or 1):
        with ThreadPoolExecutor(threads) if threads > 1 else nullcontext() as executor:
            planner = _planner(target, stones, executor)
            started = time.perf_counter()
            stones_placed = len(list(planner.steps()))
            seconds.append(time.perf_counter() - started)
            if threads == 1:
                alone = planner
    parts: tuple[Part, ...] = (
        "placement", "stabilisation", "contacts", "limit analysis", "indices",
    )  # fmt: skip
    return (
        target.name,
        stones_placed,
        sum(step.candidates for step in alone.profile.steps),
        *seconds,
        *(alone.profile.total(part) for part in parts),
    )


def _planner(target: Target, stones: StoneSet, executor: Executor | None = None) -> Planner:
    site = Site.from_source(*target.size(stones), target.scale)
    return Planner(stones, site, settings=one_pass("exact"), executor=executor)
