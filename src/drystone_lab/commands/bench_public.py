"""`drystone bench` for public suites: options, runs, the history of a store."""

import argparse
import platform
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from drystone.cli.output import make_folder, say
from drystone.cli.settings import read_toml
from drystone.drawing.files import save
from drystone.errors import UsageError
from drystone_lab.public.bench import PublicSettings, run_public
from drystone_lab.public.history import Medians, drawn_history, history_table, medians_of
from drystone_lab.public.store import BenchStore, Stamp
from drystone_lab.public.suites import flat_changes
from drystone_lab.runs.spec import Changes
from drystone_lab.table import Table

DEFAULT_METHODS = ("paper", "random")

RUNS_ALONE = (
    "policy", "settings", "jobs", "dask", "again", "shake", "quick", "seed", "seeds", "only",
    "seconds",
)  # fmt: skip
"""Options that a history has no use for."""

DPI = 150


def public_tables(arguments: argparse.Namespace, suite: str, data: Path | None) -> Sequence[Table]:
    """Run a public suite and return its tables."""
    _refuse_useless(arguments)
    if arguments.store is not None:
        make_folder(Path(arguments.store))
    return run_public(
        PublicSettings(
            suite=suite,
            policies=tuple(dict.fromkeys(arguments.policy or DEFAULT_METHODS)),
            changes=read_changes(arguments.settings),
            stamp=Stamp(
                version=version("drystone"),
                made_at=datetime.now(UTC).isoformat(timespec="seconds"),
                platform=f"{platform.system()} {platform.machine()}",
            ),
            seed=arguments.seed,
            seeds=arguments.seeds,
            data=data,
            store=None if arguments.store is None else Path(arguments.store),
            again=arguments.again,
            only=tuple(arguments.only),
            quick=arguments.quick,
            jobs=arguments.jobs,
            dask=arguments.dask,
            shake=arguments.shake,
            say=say,
        )
    )


def history_tables(arguments: argparse.Namespace, suite: str | None) -> Sequence[Table]:
    """Return what a store holds by version, and draw it with -o."""
    for name in RUNS_ALONE:
        if getattr(arguments, name):
            raise UsageError(
                "E138", "a history shows all that a store holds, and runs nothing.",
                where=f"--{name}", cure="Leave it out, or --history.",
            )  # fmt: skip
    if arguments.store is None:
        raise UsageError(
            "E138", "there is no store to show.", where="--history", cure="Add --store DIR."
        )
    runs = [
        run for run in BenchStore(Path(arguments.store)).runs() if suite in (None, "all", run.suite)
    ]
    if not runs:
        raise UsageError(
            "E138",
            "the store holds no runs" + (f" of {suite!r}." if suite else "."),
            where=arguments.store,
            cure="`drystone bench --suite NAME --store DIR` adds some.",
        )
    medians = medians_of(runs)
    if arguments.output is not None:
        _draw(medians, Path(arguments.output))
    return (history_table(medians),)


def _draw(medians: Sequence[Medians], folder: Path) -> None:
    make_folder(folder)
    for suite in dict.fromkeys(one.suite for one in medians):
        path = folder / f"history-{suite.replace('/', '-')}.png"
        save(drawn_history([one for one in medians if one.suite == suite]), path, DPI)
        say(f"wrote {path}")


def _refuse_useless(arguments: argparse.Namespace) -> None:
    useless = {
        "--seconds": (arguments.seconds, "Public suites build one wall a seed: use --seeds."),
        "--runs": (arguments.runs, "Public suites keep their runs in a --store."),
        "-o": (arguments.output, "Public suites draw nothing but a --history."),
        "--again": (
            arguments.again and arguments.store is None,
            "Nothing is kept without --store, so all runs are done.",
        ),
    }
    for name, (given, cure) in useless.items():
        if given:
            raise UsageError("E138", "it would do nothing here.", where=name, cure=cure)


def read_changes(name: str | None) -> Changes:
    """Return what a file of settings replaces for all methods; nothing without a file."""
    return () if name is None else flat_changes(read_toml(Path(name)), name)
