"""The suites of `drystone bench`, by name."""

from importlib import import_module
from typing import cast

from drystone_lab.table import BenchSettings, Table

SUITES = {
    "statics": ("published and closed-form cases of the limit analysis", "published"),
    "pixels": ("the same cases from pixels, and tilted joints at 40 to 320 px", "pixels"),
    "walls": ("planned walls: agreement of solvers and certificates at every step", "agreement"),
    "shear": ("shear tests of dry-joint walls, predicted over measured", "shear"),
    "tilt": ("walls tilted in a rigid-body engine beside the limit analysis", "tilt"),
    "engine": ("walls planned on outlines, built up and tilted in a rigid-body engine", "engine"),
    "search": ("methods that look for good walls, compared at equal CPU time", "search"),
    "photos": ("stones found in rendered and in real photographs, beside the truth", "photos"),
    "packing": ("strips packed without gravity beside planned walls (extra `bench`)", "packing"),
}
"""What each one is about, and the module of this package whose `run` does it."""

SEARCHES = {
    "search": ("seconds", "seeds", "only", "policy", "settings", "jobs", "runs"),
    "packing": ("seconds", "only"),
}
"""Those that search, and what can be asked of them."""


PICTURED = ("shear",)
"""Those that draw pictures."""


def run_suite(name: str, settings: BenchSettings) -> tuple[Table, ...]:
    """Run one suite; see `SUITES` for the names."""
    module = import_module(f"drystone_lab.{SUITES[name][1]}")
    return cast("tuple[Table, ...]", module.run(settings))
