"""Suite "shear": real shear tests of dry-joint walls, predicted over measured.

Not a pass or a fail: rigid blocks cannot crush, and how the beam on the walls was held is not
fully known.  Nothing is fitted; what is not known is varied, and what it does is shown.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from statistics import fmean, stdev

from drystone.statics.flow.nonassociative import nonassociative_load
from drystone.statics.limit import lateral_resistance
from drystone_lab.shear_walls import SERIES, ShearSeries, shear_wall
from drystone_lab.table import BenchSettings, Cell, Table

FRICTION = 0.62
"""Of sawn stone on stone, and of the beam on it; assumed for both stones."""

FRICTION_BAND = (0.55, 0.62, 0.70)
DENSITIES_KG_M3 = (2000.0, 2800.0)
"""20 kN/m3, as the database counts the weight of walls, and a heavy stone."""

RESTRAINTS = {False: "beam turns", True: "beam level"}

ShearModel = Callable[["ShearSeries", "Loading"], "ShearForces"]
"""The largest V that a wall carries."""

PICTURE, DPI = "shear_tests.png", 170


@dataclass(frozen=True)
class ShearForces:
    """V in kN by both flow rules; None where an answer is not certified."""

    associative: float | None
    without_dilatancy: float | None


@dataclass(frozen=True)
class Loading:
    """What a prediction depends on besides the wall."""

    vertical_kn: float
    level: bool
    mu: float = FRICTION
    halves_first: bool = False


def predict(series: ShearSeries, loading: Loading) -> ShearForces:
    """Compute the largest V that a wall carries.

    A level beam on which 30 kN stand slides off at mu N.

    >>> predict(SERIES[0], Loading(30.0, level=True, mu=0.5)).associative
    15.0
    """
    model, loads = shear_wall(
        series,
        loading.vertical_kn,
        loading.mu,
        level=loading.level,
        halves_first=loading.halves_first,
    )
    associative = lateral_resistance(model, loads).right.alpha
    without = nonassociative_load(model, "right", loads=loads).alpha
    return ShearForces(*(None if v is None else round(v, 6) for v in (associative, without)))


def run(settings: BenchSettings) -> tuple[Table, ...]:
    """Compare the limit analysis with the shear tests."""
    # Tests of one series with the same vertical load have the same prediction, which is made once.
    known = cache(predict)
    if settings.quick:
        few = tuple(replace(series, tests=series.tests[:1]) for series in SERIES)
        return _predicted(known, few), _by_test(known, few), _scatter(known, few)
    if settings.output is not None:
        _draw(known, settings.output / PICTURE)
    return (
        _predicted(known, SERIES),
        _by_test(known, SERIES),
        _scatter(known, SERIES),
        _friction(known),
        _details(known),
    )


def _v(known: ShearModel, series: ShearSeries, loading: Loading) -> ShearForces:
    return known(replace(series, name="", tests=()), loading)


MODELS = tuple(
    f"{restraint}, {rule}"
    for restraint in RESTRAINTS.values()
    for rule in ("associative", "without dilatancy")
)


def _four(
    known: ShearModel, series: ShearSeries, vertical_kn: float, mu: float = FRICTION
) -> list[float | None]:
    """Return V by all `MODELS`."""
    both = [_v(known, series, Loading(vertical_kn, level, mu)) for level in RESTRAINTS]
    return [v for p in both for v in (p.associative, p.without_dilatancy)]


def _ratios(
    known: ShearModel, all_series: Sequence[ShearSeries], mu: float = FRICTION
) -> list[list[float | None]]:
    """Return predicted over measured of every test by all `MODELS`."""
    return [
        [
            None if v is None else v / test.measured_kn
            for v in _four(known, one, test.vertical_kn, mu)
        ]
        for one in all_series
        for test in one.tests
    ]


def _predicted(known: ShearModel, all_series: Sequence[ShearSeries]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for series in all_series:
        for vertical in dict.fromkeys(test.vertical_kn for test in series.tests):
            tests = [test for test in series.tests if test.vertical_kn == vertical]
            peaks = [peak for test in tests for peak in test.peaks_kn]
            measured = f"{min(peaks):g} to {max(peaks):g}" if len(peaks) > 1 else f"{peaks[0]:g}"
            values = [_rounded(v, 1) for v in _four(known, series, vertical)]
            rows.append((series.name, vertical, len(tests), measured, *values))
    return Table(
        f"Shear tests: largest V in kN, predicted with friction {FRICTION:g}",
        ("series", "N kN", "tests", "measured", *MODELS),
        tuple(rows),
        (
            *(
                f"{series.name}: {series.course_count} courses of {series.block_length:g} x "
                f"{series.block_height:g} m, wall {series.length:g} x {series.height:g} x "
                f"{series.thickness:g} m, V at {series.load_height:g} m, "
                f"{series.density_kg_m3:g} kg/m3 (assumed)."
                for series in all_series
            ),
        ),
    )


def _by_test(known: ShearModel, all_series: Sequence[ShearSeries]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for series in all_series:
        for test, ratios in zip(series.tests, _ratios(known, [series]), strict=True):
            peaks = " / ".join(f"{peak:g}" for peak in test.peaks_kn)
            values = [_rounded(ratio, 2) for ratio in ratios]
            rows.append((test.name, test.vertical_kn, peaks, *values))
    return Table(
        f"Shear tests: predicted over measured, friction {FRICTION:g}",
        ("test", "N kN", "measured kN", *MODELS),
        tuple(rows),
        ("Cyclic tests have a peak on either side; predictions are over the mean of both.",),
    )


def _scatter(known: ShearModel, all_series: Sequence[ShearSeries]) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (name, *_mean_and_deviation(_ratios(known, series)))
        for name, series in (*((one.name, (one,)) for one in all_series), ("all", all_series))
    ]
    return Table(
        f"Shear tests: predicted over measured, mean and standard deviation, friction {FRICTION:g}",
        ("series", *MODELS),
        tuple(rows),
    )


def _friction(known: ShearModel) -> Table:
    rows: list[tuple[Cell, ...]] = [
        (one.name, mu, *_mean_and_deviation(_ratios(known, (one,), mu)))
        for one in SERIES
        for mu in FRICTION_BAND
    ]
    return Table(
        "Shear tests: what friction changes, predicted over measured, mean and standard deviation",
        ("series", "mu", *MODELS),
        tuple(rows),
    )


def _details(known: ShearModel) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for series in SERIES[:2]:
        loads = sorted({test.vertical_kn for test in series.tests})
        variants = [("as above", series, False), ("half blocks in the lowest course", series, True)]
        variants += [
            (f"{density:g} kg/m3", replace(series, density_kg_m3=density), False)
            for density in DENSITIES_KG_M3
        ]
        for vertical in (loads[0], loads[-1]):
            for name, varied, halves in variants:
                loading = Loading(vertical, level=False, halves_first=halves)
                v = _v(known, varied, loading)
                values = (_rounded(v.associative, 2), _rounded(v.without_dilatancy, 2))
                rows.append((series.name, vertical, name, *values))
    return Table(
        f"Shear tests: what density and bond change, V in kN, friction {FRICTION:g}, beam turns",
        ("series", "N kN", "wall", "associative", "without dilatancy"),
        tuple(rows),
        ("With the beam level V is mu N whatever the wall weighs: the beam slides on it.",),
    )


def _mean_and_deviation(ratios: Sequence[Sequence[float | None]]) -> list[str]:
    """Return mean and standard deviation of every column, of the answers that there are."""
    columns = [[v for v in column if v is not None] for column in zip(*ratios, strict=True)]
    return [f"{fmean(v):.2f} ± {stdev(v):.2f}" if len(v) > 1 else "-" for v in columns]


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None else round(value, digits)


def _draw(known: ShearModel, path: Path) -> None:
    """Draw predicted against measured, associative, with the band of friction."""
    from drystone.drawing.files import save  # noqa: PLC0415 - Matplotlib takes long to import
    from drystone_lab.pictures.validation import Prediction, plot_predictions  # noqa: PLC0415

    points = []
    for level, restraint in RESTRAINTS.items():
        for series in SERIES:
            for test in series.tests:
                loads = [Loading(test.vertical_kn, level, mu) for mu in FRICTION_BAND]
                band = [_v(known, series, loading).associative for loading in loads]
                found = [v for v in band if v is not None]
                if len(found) == len(band):
                    points.append(Prediction(series.name, restraint, test.measured_kn, *found))
    words = f"friction {FRICTION_BAND[0]:.2f} to {FRICTION_BAND[-1]:.2f}"
    save(plot_predictions(points, band=words).figure, path, dpi=DPI)
