"""`drystone bench`: how good the numbers are."""

import argparse
import os
import sys
from pathlib import Path

from drystone.cli.output import make_folder, print_json
from drystone.errors import ExitCode, UsageError
from drystone.experiments.suites import SEARCHES, SUITES, run_suite
from drystone.experiments.table import BenchSettings


def run(arguments: argparse.Namespace) -> ExitCode:
    """Run a suite and print its tables."""
    if arguments.list:
        for name, (text, _) in SUITES.items():
            print(f"{name}: {text}")
        return ExitCode.DONE
    if arguments.suite not in SUITES:
        raise UsageError(
            "E138",
            f"there is no suite {arguments.suite!r}." if arguments.suite else "no suite is named.",
            where="bench",
            cure=f"Name one of {', '.join(SUITES)}; `drystone bench --list` explains them.",
        )
    settings = _settings(arguments)
    if settings.output is not None:
        make_folder(settings.output)
    tables = run_suite(arguments.suite, settings)
    if arguments.json:
        print_json({table.title: table.records() for table in tables})
    else:
        for table in tables:
            print(table.markdown() if arguments.markdown else table.text(), end="\n\n")
    missed = any("miss" in row for table in tables for row in table.rows)
    return ExitCode.CHECK_FAILED if missed else ExitCode.DONE


def _settings(arguments: argparse.Namespace) -> BenchSettings:
    """Return what a suite is run with; E138 for options that it does not go by."""
    for name in ("seconds", "seeds", "only"):
        if getattr(arguments, name) and name not in SEARCHES.get(arguments.suite, ()):
            known = [suite for suite, names in SEARCHES.items() if name in names]
            raise UsageError(
                "E138",
                f"the suite {arguments.suite!r} does not go by it.",
                where=f"--{name}",
                cure=f"Leave it out; it is for {' and '.join(known)}.",
            )
    return BenchSettings(
        data=_data(arguments.data),
        output=None if arguments.output is None else Path(arguments.output),
        seed=arguments.seed,
        quick=arguments.quick,
        seconds=arguments.seconds,
        seeds=arguments.seeds,
        only=tuple(arguments.only),
        say=_say,
    )


def _say(text: str) -> None:
    """Print a result as it comes, where it does not get in the way of the tables."""
    print(text, file=sys.stderr, flush=True)


def _data(given: str | None) -> Path | None:
    """Return the folder of published data: the option, DRYSTONE_DATA, or none."""
    named = given or os.environ.get("DRYSTONE_DATA")
    if named is None:
        return None
    folder = Path(named)
    if not folder.is_dir():
        print(
            f"drystone: there is no folder {named}; rows that need it are left out", file=sys.stderr
        )
        return None
    return folder
