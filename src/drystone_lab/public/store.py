"""Results by version, in an SQLite file, with exports as CSV and Parquet."""

import json
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, astuple, dataclass, fields
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from drystone.errors import DrystoneError, InputError, UsageError, not_written
from drystone.whole_files import write_whole
from drystone_lab.public.suites import SUITE_VERSION
from drystone_lab.public.tables import SHAKE, BenchResult
from drystone_lab.runs.outcome import RunOutcome
from drystone_lab.runs.spec import Changes
from drystone_lab.table import Table

DATABASE = "bench.sqlite"
CSV = "runs.csv"
PARQUET = "runs.parquet"

NOT_SHAKEN = "no"
"""Value of `shaken`."""


@dataclass(frozen=True)
class KeptRun:
    """A row of the table `runs`."""

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


COLUMNS = tuple(field.name for field in fields(KeptRun))
_TYPES = {int: "INTEGER NOT NULL", str: "TEXT NOT NULL", float: "REAL NOT NULL"}


@dataclass(frozen=True)
class Stamp:
    """What runs that are kept together have in common."""

    version: str
    made_at: str
    platform: str


def kept_run(result: BenchResult, outcome: RunOutcome, changes: Changes, stamp: Stamp) -> KeptRun:
    """Return the row of a run; `changes` replaced settings for all methods alike."""
    figures, wall = outcome.figures, result.wall
    names = ("F_SF", "F_AV", "F_AH", "F_LR", "T_LEVEL", "E_FLUSH", "wedge_area")
    pga_g = result.figures.get(SHAKE)
    shaken = NOT_SHAKEN if SHAKE not in result.figures else "falls" if pga_g is None else "yes"
    return KeptRun(
        run_key=outcome.key, suite=wall.suite, suite_version=SUITE_VERSION, wall=wall.name,
        method=result.method, settings=json.dumps(dict(changes), sort_keys=True),
        seed=result.seed, version=stamp.version, placed=int(figures["placed"] or 0),
        stones=int(figures["stones"] or 0), **{name: figures[name] for name in names},
        seconds=result.seconds, pga_g=pga_g, shaken=shaken, made_at=stamp.made_at,
        platform=stamp.platform,
    )  # fmt: skip


class BenchStore:
    """Runs of the benchmark in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    @property
    def database(self) -> Path:
        """The SQLite file."""
        return self.folder / DATABASE

    def runs(self) -> tuple[KeptRun, ...]:
        """Return all runs, in the order of suite, wall, method, seed, version."""
        if not self.database.is_file():
            return ()
        order = "suite, suite_version, wall, method, settings, seed, version"
        with self._open() as connection:
            rows = connection.execute(
                f"SELECT {', '.join(COLUMNS)} FROM runs ORDER BY {order}"  # noqa: S608 - our names
            ).fetchall()
        return tuple(KeptRun(*row) for row in rows)

    def put(self, runs: Sequence[KeptRun]) -> None:
        """Keep runs, each instead of an equal one of the same version."""
        self.folder.mkdir(parents=True, exist_ok=True)
        marks = ", ".join("?" * len(COLUMNS))
        with self._open() as connection:
            connection.executemany(
                f"INSERT OR REPLACE INTO runs ({', '.join(COLUMNS)}) VALUES ({marks})",  # noqa: S608
                [astuple(run) for run in runs],
            )

    def export(self) -> tuple[Path, ...]:
        """Write all runs as CSV, and as Parquet where pyarrow is installed; return the files."""
        runs = self.runs()
        table = Table("", COLUMNS, tuple(astuple(run) for run in runs))
        write_whole(self.folder / CSV, table.csv().encode())
        if find_spec("pyarrow") is None:
            return (self.folder / CSV,)
        write_whole(self.folder / PARQUET, _parquet(runs))
        return (self.folder / CSV, self.folder / PARQUET)

    @contextmanager
    def _open(self) -> Iterator[sqlite3.Connection]:
        """Open the database, with its table, for one transaction."""
        try:
            with closing(sqlite3.connect(self.database)) as connection, connection:
                connection.execute(_TABLE)
                yield connection
        except sqlite3.DatabaseError as error:
            raise self._told(error) from error

    def _told(self, error: sqlite3.DatabaseError) -> DrystoneError:
        """Say what is wrong with the database, its disk, or who has it."""
        code = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_ERROR) & 0xFF
        if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            return UsageError(
                "E149",
                "another run of drystone writes there.",
                where=str(self.database),
                cure="Give the same command again when it has ended: plans that are kept beside "
                "it are not done again.",
            )
        if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR, sqlite3.SQLITE_READONLY):
            return not_written(OSError(0, str(error), str(self.database)))
        return InputError(
            "E401",
            f"this is not a database of runs that can be used: {error}.",
            where=str(self.database),
            cure="Move it away; runs whose plans are kept beside it are not done again.",
        )


def _column(name: str, kind: object) -> str:
    declared = _TYPES.get(kind, "REAL") if isinstance(kind, type) else "REAL"
    return f"{name} {declared}" + (" PRIMARY KEY" if name == "run_key" else "")


_TABLE = (
    "CREATE TABLE IF NOT EXISTS runs ("
    + ", ".join(_column(field.name, field.type) for field in fields(KeptRun))
    + ")"
)


def _parquet(runs: Sequence[KeptRun]) -> bytes:
    import pyarrow as pa  # noqa: PLC0415 - extra `bench`
    from pyarrow import parquet  # noqa: PLC0415

    kinds: dict[object, Any] = {int: pa.int64(), str: pa.string()}
    schema = pa.schema(
        [(field.name, kinds.get(field.type, pa.float64())) for field in fields(KeptRun)]
    )
    written = pa.BufferOutputStream()
    parquet.write_table(pa.Table.from_pylist([asdict(run) for run in runs], schema), written)
    return bytes(written.getvalue())
