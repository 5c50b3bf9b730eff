"""Suite "shear": real shear tests of dry-joint walls, predicted over measured.

Not a pass or a fail: rigid blocks cannot crush, and how the beam on the walls was held is not
fully known.  Nothing is fitted; what is not known is varied, and what it does is shown.  The tests
are those of ``shear_tests.toml``; lengths in m, forces in kN.
"""

import tomllib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from statistics import fmean, stdev
from typing import NamedTuple

import numpy as np

from drystone.contacts.given import model_from_json
from drystone.statics.flow.nonassociative import nonassociative_resistance
from drystone.statics.limit import lateral_resistance
from drystone.statics.loads import Loads, point_load, weight
from drystone.statics.model import RigidBlockModel
from drystone_lab.cells import rounded
from drystone_lab.table import BENCH, BenchSettings, Rows, Table, worded

GRAVITY = 9.81
"""m/s2."""


@dataclass(frozen=True)
class ShearTest:
    """One wall."""

    name: str
    vertical_kn: float  # N
    # Largest V; towards either side for cyclic tests, the first side first
    peaks_kn: tuple[float, ...]

    @property
    def measured_kn(self) -> float:
        """Mean of the peaks: models do not tell the sides apart."""
        return fmean(self.peaks_kn)


@dataclass(frozen=True)
class ShearSeries:
    """Walls of one kind."""

    name: str  # Source, stone, way of loading
    length: float  # length, height, thickness: Of the wall without the beam
    height: float
    thickness: float
    # Height of V above the ground; the beam is modelled from the top of the wall to as far above V
    load_height: float
    block_length: float
    block_height: float
    density_kg_m3: float  # Of the stone; assumed, not measured
    tests: tuple[ShearTest, ...]  # All of the series

    @property
    def course_count(self) -> int:
        """Courses: the height of the wall over that of its blocks."""
        return round(self.height / self.block_height)


_FILE = tomllib.loads(Path(__file__).with_name("shear_tests.toml").read_text("utf-8"))

SERIES = tuple(
    ShearSeries(
        **series
        | {"tests": tuple(ShearTest(name, load, tuple(v)) for name, load, *v in series["tests"])}
    )
    for series in _FILE["series"]
)

FRICTION = 0.62
"""Of sawn stone on stone, and of the beam on it; assumed for both stones."""


class Loading(NamedTuple):
    """What a prediction depends on besides the wall."""

    vertical_kn: float
    level: bool = False
    mu: float = FRICTION
    halves_first: bool = False


def shear_wall(series: ShearSeries, loading: Loading) -> tuple[RigidBlockModel, Loads]:
    """Make a tested wall and its loads.

    Courses of whole blocks alternate with courses that begin and end with half a block.  The beam
    is the last block, as long as the wall, with the friction of the stones below it; its weight
    counts as part of N, which acts down at its middle.

    >>> from drystone.statics.limit import lateral_resistance
    >>> model, loads = shear_wall(SERIES[0], Loading(30.0, level=True))
    >>> len(model.blocks), round(lateral_resistance(model, loads).right.alpha, 6)
    (50, 18.6)
    """
    kn_m2 = series.density_kg_m3 * GRAVITY * series.thickness / 1e3
    boxes = []  # left, bottom, right and top
    for course in range(series.course_count):
        halves = (course % 2 == 0) == loading.halves_first
        first = series.block_length / 2.0 if halves else series.block_length
        inner = np.arange(first, series.length - 1e-9, series.block_length)
        bottom = course * series.block_height
        for left, right in pairwise([0.0, *inner.tolist(), series.length]):
            boxes.append((left, bottom, right, bottom + series.block_height))
    boxes.append((0.0, series.height, series.length, 2.0 * series.load_height - series.height))
    beam = len(boxes)
    blocks = [
        {
            "id": number,
            "polygon": [[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
            "density": kn_m2,
            "held": ["turn"] if loading.level and number == beam else [],
        }
        for number, (x0, y0, x1, y1) in enumerate(boxes, start=1)
    ]
    model = model_from_json({"blocks": blocks, "mu": loading.mu})
    middle = (series.length / 2.0, series.load_height)
    dead = weight(model)
    dead[-1] = 0.0
    dead += point_load(model, beam, middle, (0.0, -loading.vertical_kn))
    return model, Loads(dead, point_load(model, beam, middle, (1.0, 0.0)), "shear test")


FRICTION_BAND = (0.55, 0.62, 0.70)
RESTRAINTS = {False: "beam turns", True: "beam level"}


class ShearForces(NamedTuple):
    """V in kN by both flow rules; None where an answer is not certified."""

    associative: float | None
    without_dilatancy: float | None


ShearModel = Callable[[ShearSeries, Loading], ShearForces]
"""The largest V that a wall carries."""


def predict(series: ShearSeries, loading: Loading) -> ShearForces:
    """Compute the largest V that a wall carries.

    A level beam on which 30 kN stand slides off at mu N.

    >>> predict(SERIES[0], Loading(30.0, level=True, mu=0.5)).associative
    15.0
    """
    model, loads = shear_wall(series, loading)
    associative = lateral_resistance(model, loads).right.alpha
    without = nonassociative_resistance(model, loads=loads).right.alpha
    return ShearForces(rounded(associative, 6), rounded(without, 6))


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Compare the limit analysis with the shear tests."""
    # Tests of one series with the same vertical load have the same prediction, which is made once.
    known = cache(predict)

    def model(series: ShearSeries, loading: Loading) -> ShearForces:
        return known(replace(series, name="", tests=()), loading)

    asked = SERIES
    if settings.quick:
        asked = tuple(replace(series, tests=series.tests[:1]) for series in SERIES)
    about = (
        f"{series.name}: {series.course_count} courses of {series.block_length:g} x "
        f"{series.block_height:g} m, wall {series.length:g} x {series.height:g} x "
        f"{series.thickness:g} m, V at {series.load_height:g} m, "
        f"{series.density_kg_m3:g} kg/m3 (assumed)."
        for series in asked
    )
    named = (*((one.name, (one,)) for one in asked), ("all", asked))
    scatter: Rows = ((name, *_mean_and_deviation(_ratios(model, each))) for name, each in named)
    tables = (
        _worded("predicted", _predicted(model, asked), about),
        _worded("by_test", _by_test(model, asked)),
        _worded("scatter", scatter),
    )
    if settings.quick:
        return tables
    if settings.output is not None:
        _draw(model, settings.output / "shear_tests.png")
    friction: Rows = (
        (one.name, mu, *_mean_and_deviation(_ratios(model, (one,), mu)))
        for one in SERIES
        for mu in FRICTION_BAND
    )
    return (*tables, _worded("friction", friction), _worded("details", _details(model)))


MODELS = tuple(
    f"{restraint}, {rule}"
    for restraint in RESTRAINTS.values()
    for rule in ("associative", "without dilatancy")
)


def _worded(name: str, rows: Rows, notes: Iterable[str] = ()) -> Table:
    return worded(BENCH["shear"][name], rows, columns={"<models>": MODELS}, more=notes)


def _four(
    model: ShearModel, series: ShearSeries, vertical_kn: float, mu: float = FRICTION
) -> list[float | None]:
    """Return V by all `MODELS`."""
    return [v for level in RESTRAINTS for v in model(series, Loading(vertical_kn, level, mu))]


def _ratios(
    model: ShearModel, all_series: Sequence[ShearSeries], mu: float = FRICTION
) -> list[list[float | None]]:
    """Return predicted over measured of every test by all `MODELS`."""
    return [
        [
            None if v is None else v / test.measured_kn
            for v in _four(model, one, test.vertical_kn, mu)
        ]
        for one in all_series
        for test in one.tests
    ]


def _predicted(model: ShearModel, all_series: Sequence[ShearSeries]) -> Rows:
    for series in all_series:
        for vertical in dict.fromkeys(test.vertical_kn for test in series.tests):
            tests = [test for test in series.tests if test.vertical_kn == vertical]
            peaks = [peak for test in tests for peak in test.peaks_kn]
            measured = f"{min(peaks):g} to {max(peaks):g}" if len(peaks) > 1 else f"{peaks[0]:g}"
            values = (rounded(v, 1) for v in _four(model, series, vertical))
            yield series.name, vertical, len(tests), measured, *values


def _by_test(model: ShearModel, all_series: Sequence[ShearSeries]) -> Rows:
    for series in all_series:
        for test, ratios in zip(series.tests, _ratios(model, [series]), strict=True):
            peaks = " / ".join(f"{peak:g}" for peak in test.peaks_kn)
            yield test.name, test.vertical_kn, peaks, *(rounded(ratio, 2) for ratio in ratios)


def _details(model: ShearModel) -> Rows:
    for series in SERIES[:2]:
        loads = sorted({test.vertical_kn for test in series.tests})
        variants = [("as above", series, False), ("half blocks in the lowest course", series, True)]
        variants += [
            (f"{density:g} kg/m3", replace(series, density_kg_m3=density), False)
            # 20 kN/m3, as the database counts the weight of walls, and a heavy stone.
            for density in (2000.0, 2800.0)
        ]
        for vertical in (loads[0], loads[-1]):
            for name, varied, halves in variants:
                loading = Loading(vertical, halves_first=halves)
                values = (rounded(v, 2) for v in model(varied, loading))
                yield series.name, vertical, name, *values


def _mean_and_deviation(ratios: Sequence[Sequence[float | None]]) -> list[str]:
    """Return mean and standard deviation of every column, of the answers that there are."""
    columns = ([v for v in column if v is not None] for column in zip(*ratios, strict=True))
    return [f"{fmean(v):.2f} ± {stdev(v):.2f}" if len(v) > 1 else "-" for v in columns]


def _draw(model: ShearModel, path: Path) -> None:
    """Draw predicted against measured, associative, with the band of friction."""
    from drystone.drawing.canvas import save  # noqa: PLC0415 - Matplotlib takes long to import
    from drystone_lab.pictures import Prediction, plot_predictions  # noqa: PLC0415

    points = []
    for level, restraint in RESTRAINTS.items():
        for series in SERIES:
            for test in series.tests:
                loads = [Loading(test.vertical_kn, level, mu) for mu in FRICTION_BAND]
                band = [model(series, loading).associative for loading in loads]
                found = [v for v in band if v is not None]
                if len(found) == len(band):
                    points.append(Prediction(series.name, restraint, test.measured_kn, *found))
    words = f"friction {FRICTION_BAND[0]:.2f} to {FRICTION_BAND[-1]:.2f}"
    save(plot_predictions(points, words).figure, path, dpi=170)
