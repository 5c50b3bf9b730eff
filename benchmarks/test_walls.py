"""Whole walls: time, time by part, memory."""

import json
import subprocess
import sys
import time
from itertools import islice
from pathlib import Path

import pytest
from tests.naive.planner import SlowPlanner

from benchmarks.conftest import Row, Timer
from benchmarks.scenes import Stock
from benchmarks.sizes import Sizes
from drystone.planner.planner import Planner
from drystone.planner.profile import PARTS, Profile
from drystone.search.plan_wall import plan_wall

SCALE = 0.5
SEED = 1
JOBS = "wall, paper, full batch, elapsed"
MEMORY = "peak memory of a plan"


def size_of(stones: Stock) -> str:
    """Say which wall is built."""
    site = stones.site(SCALE)
    return f"{stones.name}, {site.width_px} x {site.height_px}"


@pytest.mark.parametrize("method", ["paper", "paper, full batch", "best"])
def test_plan(timer: Timer, stones: Stock, sizes: Sizes, method: str) -> None:
    """Plan a wall, from stones to plan."""
    settings = sizes.settings(method)
    runs: list[tuple[float, Profile]] = []

    def call() -> None:
        started = time.perf_counter()
        result = plan_wall(
            stones.stones, *stones.wall_px, seed=SEED, scale=SCALE, settings=settings
        )
        runs.append((time.perf_counter() - started, result.profile))

    # Short ones are interrupted by other programs in most runs, but not in all.
    rounds = sizes.repeats if method == "best" else 4 * sizes.repeats
    timer.times(rounds, Row(f"wall, {method}", size_of(stones), 0.0), call)
    elapsed, profile = min(runs, key=lambda run: run[0])
    timer.note(
        parts={part: profile.total(part) for part in PARTS},
        elapsed=elapsed,
        steps=len(profile.steps),
        candidates=sum(step.candidates for step in profile.steps),
    )


@pytest.mark.benchmark(timer=time.perf_counter)
@pytest.mark.parametrize("jobs", [1, 2])
def test_jobs(timer: Timer, stones: Stock, sizes: Sizes, jobs: int) -> None:
    """Plan a wall with one and two threads, by the clock on the wall."""
    settings = sizes.settings("paper, full batch")

    def call() -> None:
        plan_wall(
            stones.stones, *stones.wall_px, seed=SEED, scale=SCALE, settings=settings, n_jobs=jobs
        )

    timer.times(4 * sizes.repeats, Row(JOBS, f"threads: {jobs}", 0.0), call)


def steps_row(stones: Stock, sizes: Sizes, twin: str | None = None) -> Row:
    """Describe the wall that the slow planner builds as well."""
    what = "wall, paper" if sizes.steps is None else f"wall, paper, {sizes.steps} steps"
    return Row(what, size_of(stones), 0.0, twin)


def test_steps(timer: Timer, stones: Stock, sizes: Sizes) -> None:
    """Take as many steps of the paper's method as the slow planner does."""
    if sizes.steps is None:
        pytest.skip("measured as a whole wall")

    def call() -> None:
        settings = sizes.settings("paper")
        planner = Planner(stones.stones, stones.site(SCALE), seed=SEED, settings=settings)
        for _ in islice(planner.steps(), sizes.steps):
            pass

    timer.times(sizes.repeats, steps_row(stones, sizes), call)


@pytest.mark.slow
def test_steps_slowly(timer: Timer, stones: Stock, sizes: Sizes) -> None:
    """Take the same steps by convolutions, painted images and fresh programs."""

    def call() -> None:
        SlowPlanner(stones.stones, stones.site(SCALE), SEED).plan(sizes.steps)

    timer.times(1, steps_row(stones, sizes, "slow planner"), call)


@pytest.mark.parametrize("method", ["paper", "best"])
def test_memory(timer: Timer, request: pytest.FixtureRequest, sizes: Sizes, method: str) -> None:
    """Plan in a process of its own and ask for its peaks."""
    if method not in sizes.traced:
        pytest.skip("takes too long here")
    found: list[dict[str, object]] = []

    def call() -> None:
        done = subprocess.run(  # noqa: S603 - our own code
            [
                sys.executable,
                "-m",
                "benchmarks.memory",
                method,
                request.config.getoption("--sizes"),
            ],
            stdout=subprocess.PIPE,
            check=True,
            cwd=Path(__file__).parents[1],
        )
        found.append(json.loads(done.stdout))

    timer.times(1, Row(MEMORY, method, 0.0), call)
    timer.note(memory=found[-1])
