"""Sizes, and what every measurement says of itself."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import scipy
from pytest_benchmark.fixture import BenchmarkFixture

from benchmarks.scenes import Scene, Stock, large_scene, planned_scene, stock
from benchmarks.sizes import SCALES, SIZES, Sizes
from drystone.kernels.backend import describe


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the choice of sizes."""
    parser.addoption("--sizes", choices=list(SIZES), default="quick", help="how much is timed")


def pytest_configure(config: pytest.Config) -> None:
    """Register the mark of the twins, which are left out when other kernels are timed."""
    config.addinivalue_line("markers", "slow: a slow twin, the same with any kernels")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run what takes a scene or a number of stones with all that are asked for."""
    sizes = SIZES[metafunc.config.getoption("--sizes")]
    if "scene" in metafunc.fixturenames:
        metafunc.parametrize("scene", sizes.scenes, indirect=True)
    if "count" in metafunc.fixturenames:
        metafunc.parametrize("count", sizes.counts)


def pytest_benchmark_update_machine_info(
    config: pytest.Config, machine_info: dict[str, Any]
) -> None:
    """Say which kernels run, and what NumPy they stand beside."""
    del config
    machine_info["kernels"] = describe()
    machine_info["numpy"] = f"NumPy {np.__version__}, SciPy {scipy.__version__}"


@pytest.fixture
def sizes(request: pytest.FixtureRequest) -> Sizes:
    """Return how much is timed."""
    return SIZES[request.config.getoption("--sizes")]


@pytest.fixture
def stones(sizes: Sizes) -> Stock:
    """Return the stones of the whole walls."""
    return stock(sizes.generated)


@pytest.fixture
def scene(request: pytest.FixtureRequest, stones: Stock) -> Scene:
    """Return a wall half built."""
    if request.param == "large":
        return large_scene()
    return planned_scene(stones, SCALES[request.param])


@dataclass(frozen=True)
class Row:
    """What a measurement is of."""

    what: str  # The function; twins have the same
    size: str  # In words
    grows: float  # The same as a number, over which growth is fitted
    twin: str | None = None  # What the slow twin does; None for the function of the package
    count: int = 1  # How many times a call does it; times are told for one
    # What one cannot do without touching, so many of them; 0 when that is not told
    items: float = 0.0
    item: str = ""  # What these are


class Timer:
    """Measures a function and keeps what it is with the times."""

    def __init__(self, benchmark: BenchmarkFixture) -> None:
        self._benchmark = benchmark

    def often(self, row: Row, call: Callable[[], object]) -> None:
        """Measure in as many rounds as there is time for."""
        self._tell(row)
        self._benchmark(call)

    def times(
        self,
        rounds: int,
        row: Row,
        call: Callable[..., object],
        prepare: Callable[[], tuple[object, ...]] = tuple,
    ) -> None:
        """Measure some rounds, on arguments that are made anew for each."""
        self._tell(row)
        self._benchmark.pedantic(call, setup=lambda: (prepare(), {}), rounds=rounds)

    def note(self, **facts: object) -> None:
        """Keep more with the times."""
        self._benchmark.extra_info.update(facts)

    def _tell(self, row: Row) -> None:
        self._benchmark.group = f"{row.what}, {row.size}"
        self.note(**row.__dict__)


@pytest.fixture
def timer(benchmark: BenchmarkFixture) -> Timer:
    """Return what measures."""
    return Timer(benchmark)
