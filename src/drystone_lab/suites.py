"""The suites of `drystone bench`, by name, and what can be asked of each."""

from importlib import import_module
from typing import NamedTuple, cast

from drystone_lab.table import BenchSettings, Table


class Suite(NamedTuple):
    """What a suite is about, the module of this package whose `run` does it, and its options."""

    about: str
    module: str
    options: tuple[str, ...] = ()


SUITES = {
    "statics": Suite("published and closed-form cases of the limit analysis", "statics_cases"),
    "pixels": Suite("the same cases from pixels, and tilted joints at 40 to 320 px", "pixels"),
    "walls": Suite(
        "planned walls: agreement of solvers and certificates at every step", "planned_walls"
    ),
    "shear": Suite(
        "shear tests of dry-joint walls, predicted over measured", "shear", ("output",)
    ),
    "tilt": Suite("walls tilted in a rigid-body engine beside the limit analysis", "tilt"),
    "engine": Suite(
        "walls planned on outlines, built up and tilted in a rigid-body engine", "engine"
    ),
    "search": Suite(
        "methods that look for good walls, compared at equal CPU time", "search",
        ("seconds", "seeds", "only", "policy", "settings", "jobs", "runs"),
    ),
    "photos": Suite(
        "stones found in rendered and in real photographs, beside the truth", "photos"
    ),
    "packing": Suite(
        "strips packed without gravity beside planned walls (extra `bench`)", "packing",
        ("seconds", "only"),
    ),
}  # fmt: skip

PUBLIC, HISTORY = "the public suites", "--history"

GOES_BY = {name: ("quick", "seed", *suite.options) for name, suite in SUITES.items()} | {
    PUBLIC: (
        "quick", "seed", "seeds", "only", "policy", "settings", "jobs", "dask", "store", "again",
        "shake",
    ),
    HISTORY: ("store", "output"),
}  # fmt: skip
"""Who goes by which options; all of them by the data and by how tables are printed."""


def run_suite(name: str, settings: BenchSettings) -> tuple[Table, ...]:
    """Run one suite; see `SUITES` for the names."""
    module = import_module(f"drystone_lab.{SUITES[name].module}")
    return cast("tuple[Table, ...]", module.run(settings))
