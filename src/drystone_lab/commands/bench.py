"""`drystone bench`: how good the numbers are, and how good methods are."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.output import make_folder, print_json, say
from drystone.errors import ExitCode, UsageError
from drystone.io.published import published_folder
from drystone_lab.commands.options import PUBLIC_OPTIONS
from drystone_lab.public.suites import PUBLIC_SUITES
from drystone_lab.suites import PICTURED, SEARCHES, SUITES, run_suite
from drystone_lab.table import BenchSettings, Table


def run(arguments: argparse.Namespace) -> ExitCode:
    """Run a suite and print its tables."""
    if arguments.list:
        _print_list()
        return ExitCode.DONE
    suite = _suite(arguments)
    tables = _tables(arguments, suite)
    if arguments.json:
        print_json({table.title: table.records() for table in tables})
    else:
        for table in tables:
            print(table.markdown() if arguments.markdown else table.text(), end="\n\n")
    missed = any("miss" in row for table in tables for row in table.rows)
    return ExitCode.CHECK_FAILED if missed else ExitCode.DONE


def _print_list() -> None:
    """Print suites and policies, one a line."""
    from drystone_lab.public.suites import known_methods  # noqa: PLC0415 - see _tables

    for name, (text, _) in SUITES.items():
        print(f"{name}: {text}")
    for name, text in PUBLIC_SUITES.items():
        print(f"{name}: public suite: {text}")
    for name, text in known_methods().items():
        print(f"{name}: policy of public suites: {text}")


def _suite(arguments: argparse.Namespace) -> str | None:
    """Return the suite that is named; None for the history of all (E138 for any other)."""
    if arguments.suite and arguments.named and arguments.suite != arguments.named:
        raise UsageError(
            "E138",
            f"two suites are named: {arguments.suite!r} and {arguments.named!r}.",
            where="--suite",
            cure="Name one; `all` has the walls of every public suite.",
        )
    suite: str | None = arguments.named or arguments.suite
    known = (*PUBLIC_SUITES,) if arguments.history else (*SUITES, *PUBLIC_SUITES)
    if suite in known or (suite is None and arguments.history):
        return suite
    raise UsageError(
        "E138",
        f"there is no suite {suite!r}." if suite else "no suite is named.",
        where="bench",
        cure=f"Name one of {', '.join(known)}; `drystone bench --list` explains them.",
    )


def _tables(arguments: argparse.Namespace, suite: str | None) -> Sequence[Table]:
    # Loaded when it is run: --list and a misspelt suite do not wait for SciPy and Matplotlib.
    from drystone_lab.commands.bench_public import history_tables, public_tables  # noqa: PLC0415

    if arguments.history:
        return history_tables(arguments, suite)
    if suite is not None and suite in PUBLIC_SUITES:
        return public_tables(arguments, suite, _data(arguments.data))
    return run_suite(str(suite), _settings(arguments, str(suite)))


def _settings(arguments: argparse.Namespace, suite: str) -> BenchSettings:
    """Return what a suite is run with; E138 for options that it does not go by."""
    for name in ("seconds", "seeds", "only", "runs", *PUBLIC_OPTIONS):
        if getattr(arguments, name) and name not in SEARCHES.get(suite, ()):
            known = [other for other, names in SEARCHES.items() if name in names]
            if name not in ("seconds", "runs"):
                known.append("the public suites")
            raise UsageError(
                "E138",
                f"the suite {suite!r} does not go by it.",
                where=f"--{name}",
                cure=f"Leave it out; it is for {' and '.join(known)}.",
            )
    from drystone_lab.commands.bench_public import read_changes  # noqa: PLC0415 - see _tables

    output = None if arguments.output is None else Path(arguments.output)
    if output is not None and suite not in PICTURED:
        raise UsageError(
            "E138",
            f"the suite {suite!r} draws no pictures.",
            where="-o",
            cure=f"Leave it out; it is for {' and '.join(PICTURED)}.",
        )
    if output is not None:
        make_folder(output)
    return BenchSettings(
        data=_data(arguments.data),
        output=output,
        seed=arguments.seed,
        quick=arguments.quick,
        seconds=tuple(arguments.seconds),
        seeds=arguments.seeds,
        only=tuple(arguments.only),
        policies=tuple(arguments.policy),
        changes=read_changes(arguments.settings),
        jobs=arguments.jobs,
        runs=None if arguments.runs is None else Path(arguments.runs),
        say=say,
    )


def _data(given: str | None) -> Path | None:
    """Return the folder of published data: the option, DRYSTONE_DATA, the cache, or none."""
    folder = published_folder(given)
    if folder is None:
        return None
    if not folder.is_dir():
        print(
            f"drystone: there is no folder {folder}; rows that need it are left out",
            file=sys.stderr,
        )
        return None
    return folder
