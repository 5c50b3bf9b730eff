"""Runs of the public benchmark, one type for a run, and the table that keeps them by version."""

import json
import platform
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from importlib.metadata import version
from operator import attrgetter
from pathlib import Path

from drystone.errors import InputError
from drystone.io.folder_lock import locked
from drystone.whole_files import write_whole
from drystone_lab.public.suites import SUITE_VERSION
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.spec import STRIPS, Changes
from drystone_lab.table import Table, figure_in, read_rows
from drystone_lab.walls import Target

CSV = "runs.csv"

NOT_SHAKEN = "no"

PLACED, SHAKE = "placed", "PGA"
"""Figures that are no column: the share of the stones that is placed, and the amplitude, g."""


@dataclass(frozen=True)
class KeptRun:
    """A wall that a method built: a row of the table."""

    run_key: str  # Of the run (:attr:`RunSpec.key`): equal runs of one version have the same
    suite: str
    suite_version: int
    wall: str
    method: str
    settings: str  # JSON of the settings that were replaced for all methods alike; "{}" for none
    seed: int
    version: str
    placed: int  # placed, stones: Stones in the wall, and all
    stones: int
    # F_SF, F_AV, F_AH, F_LR, T_LEVEL, E_FLUSH, wedge_area: Figures of the wall; areas in source px
    F_SF: float | None
    F_AV: float | None
    F_AH: float | None
    F_LR: float | None
    T_LEVEL: float | None
    E_FLUSH: float | None
    wedge_area: float | None
    seconds: float  # From the stones to the last step
    pga_g: float | None  # Amplitude that the wall stands on the shaking table, g
    # "yes"; "no" when it was not asked for; "falls" when nothing was built, or it does not stand at
    # rest there
    shaken: str
    made_at: str  # Date and time, UTC
    platform: str  # System and machine, without names of hosts

    @classmethod
    def of(
        cls, wall: Target, method: str, seed: int, outcome: RunOutcome,
        changes: Changes, made_at: str,
    ) -> "KeptRun":  # fmt: skip
        """Return the row of a run; `changes` replaced settings for all methods alike."""
        figures = outcome.figures
        names = ("F_SF", "F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH", "wedge_area")
        return cls(
            run_key=outcome.key, suite=wall.suite, suite_version=SUITE_VERSION, wall=wall.name,
            method=method, settings=json.dumps(dict(changes), sort_keys=True), seed=seed,
            version=version("drystone"), placed=int(figures["placed"] or 0),
            stones=int(figures["stones"] or 0), **{name: figures[name] for name in names},
            seconds=outcome.times["wall"], pga_g=None, shaken=NOT_SHAKEN, made_at=made_at,
            platform=f"{platform.system()} {platform.machine()}",
        )  # fmt: skip

    def figure(self, name: str) -> float | None:
        """Return a figure that is compared; None where it is not defined."""
        if name == PLACED:
            # The yardstick builds no wall: what is kept as 0 is no share.
            return self.placed / self.stones if self.stones and self.method != STRIPS else None
        value: float | None = self.pga_g if name == SHAKE else getattr(self, name)
        return value


KINDS = {
    field.name: field.type if isinstance(field.type, type) else figure_in
    for field in fields(KeptRun)
}


def kept_runs(folder: Path) -> tuple[KeptRun, ...]:
    """Return the runs of a store, none where there is none; E401 for another table."""
    what = "this is not a table of runs that can be used."
    cure = "Move it away; runs whose plans are kept beside it are not done again."
    refused = InputError("E401", what, cure=cure)
    return tuple(KeptRun(**row) for row in read_rows(folder / CSV, KINDS, refused))


def keep(folder: Path, runs: Iterable[KeptRun]) -> None:
    """Keep runs, each instead of an equal one of the same version."""
    folder.mkdir(parents=True, exist_ok=True)
    with locked(folder):
        found = {run.run_key: run for run in (*kept_runs(folder), *runs)}
        order = attrgetter(
            "suite", "suite_version", "wall", "method", "settings", "seed", "version"
        )
        rows = tuple(astuple(run) for run in sorted(found.values(), key=order))
        write_whole(folder / CSV, Table("", tuple(KINDS), rows).csv().encode())
