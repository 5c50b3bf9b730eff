"""`drystone bench`: how good the numbers are, and how good methods are."""

import argparse
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import groupby
from operator import itemgetter
from pathlib import Path
from pkgutil import resolve_name

from drystone.cli.output import make_folder, print_json
from drystone.cli.progress import busy
from drystone.cli.settings import read_toml
from drystone.errors import ExitCode, UsageError
from drystone.io.published import published_folder
from drystone_lab.commands import say
from drystone_lab.public.suites import PUBLIC_SUITES, flat_changes, known_methods
from drystone_lab.table import BENCH, BenchSettings, Table

# What draws or counts is loaded where it is run: --list and a misspelt suite do not wait for it.

SUITES = {name: words for name, words in BENCH.items() if "made" in words}
"""Of the lab's own, by name; public ones have walls and methods in common."""

PUBLIC, HISTORY = "the public suites", "--history"

GOES_BY = {
    **{
        name: ("quick", "seed", *words.get("options", ()))
        for name, words in {**SUITES, PUBLIC: BENCH["public"]}.items()
    },
    HISTORY: ("store", "output"),
}
"""Who goes by which options; all of them by the data and by how tables are printed."""

WHY = {
    PUBLIC: "it would do nothing here.",
    HISTORY: "a history shows all that a store holds, and runs nothing.",
}


def run(arguments: argparse.Namespace) -> ExitCode:
    """Run a suite and print its tables."""
    if arguments.list:
        for name, words in SUITES.items():
            print(f"{name}: {words['about']}")
        for name, text in PUBLIC_SUITES.items():
            print(f"{name}: public suite: {text}")
        for text, methods in groupby(known_methods().items(), key=itemgetter(1)):
            names = ", ".join(name for name, _ in methods)
            print(f"{names}: --policy of public suites: {text}")
        return ExitCode.DONE
    suite = _suite(arguments)
    tables = _history(arguments, suite) if arguments.history else _tables(arguments, str(suite))
    if arguments.json:
        print_json({table.title: table.records() for table in tables})
    else:
        for table in tables:
            print(table.markdown() if arguments.markdown else table.text(), end="\n\n")
    missed = any("miss" in row for table in tables for row in table.rows)
    return ExitCode.CHECK_FAILED if missed else ExitCode.DONE


def _useless(what: str, where: str, cure: str) -> UsageError:
    return UsageError("E138", what, where=where, cure=cure)


def _suite(arguments: argparse.Namespace) -> str | None:
    """Return the suite that is named; None for the history of all (E138 for any other)."""
    if arguments.suite and arguments.named and arguments.suite != arguments.named:
        what = f"two suites are named: {arguments.suite!r} and {arguments.named!r}."
        raise _useless(what, "--suite", "Name one; `all` has the walls of every public suite.")
    suite: str | None = arguments.named or arguments.suite
    known = (*PUBLIC_SUITES,) if arguments.history else (*SUITES, *PUBLIC_SUITES)
    if suite in known or (suite is None and arguments.history):
        return suite
    raise _useless(
        f"there is no suite {suite!r}." if suite else "no suite is named.",
        "bench",
        f"Name one of {', '.join(known)}; `drystone bench --list` explains them.",
    )


def _tables(arguments: argparse.Namespace, suite: str) -> Sequence[Table]:
    # The option, DRYSTONE_DATA, the cache, or none
    data = published_folder(arguments.data)
    if data is not None and not data.is_dir():
        say(f"drystone: there is no folder {data}; rows that need it are left out")
        data = None
    public = suite in PUBLIC_SUITES
    _refuse(arguments, PUBLIC if public else suite)
    if arguments.again and arguments.store is None:
        cure = "Nothing is kept without --store, so all runs are done."
        raise _useless("it would do nothing here.", "--again", cure)
    output, runs, store = (
        None if given is None else Path(given)
        for given in (arguments.output, arguments.runs, arguments.store)
    )
    for folder in filter(None, (output, store)):
        make_folder(folder)
    policies = arguments.policy or (("paper", "random") if public else ())
    file = arguments.settings
    changes = () if file is None else flat_changes(read_toml(Path(file)), file)
    settings = BenchSettings(
        data=data, output=output, seed=arguments.seed, quick=arguments.quick,
        seconds=tuple(arguments.seconds), seeds=arguments.seeds, only=tuple(arguments.only),
        policies=tuple(dict.fromkeys(policies)), changes=changes, jobs=arguments.jobs,
        dask=arguments.dask, runs=runs, store=store, again=arguments.again, shake=arguments.shake,
        say=say,
    )  # fmt: skip
    if not public:
        made = SUITES[suite]["made"]
        with busy(suite, quiet=arguments.json, after_s=2.0):
            tables: Sequence[Table] = resolve_name(f"drystone_lab.{made}")(settings)
            return tables
    from drystone_lab.public.bench import run_public  # noqa: PLC0415 - see above

    return run_public(suite, settings, datetime.now(UTC).isoformat(timespec="seconds"))


def _refuse(arguments: argparse.Namespace, who: str) -> None:
    """Refuse options that a suite, the public ones or a history does not go by (E138)."""
    for name in dict.fromkeys(name for names in GOES_BY.values() for name in names):
        if getattr(arguments, name) and name not in GOES_BY[who]:
            known = [other for other, names in GOES_BY.items() if name in names]
            lacks = "draws no pictures" if name == "output" else "does not go by it"
            what = WHY.get(who, f"the suite {who!r} {lacks}.")
            instead = ", or --history" if who == HISTORY else f"; it is for {' and '.join(known)}"
            cure = f"Leave it out{instead}."
            raise _useless(what, "-o" if name == "output" else f"--{name}", cure)


def _history(arguments: argparse.Namespace, suite: str | None) -> Sequence[Table]:
    """Return what a store holds by version, and draw it with -o; E138 for other options."""
    from drystone_lab.public import tables  # noqa: PLC0415 - see above
    from drystone_lab.public.store import kept_runs  # noqa: PLC0415

    _refuse(arguments, HISTORY)
    if arguments.store is None:
        raise _useless("there is no store to show.", "--history", "Add --store DIR.")
    runs = [run for run in kept_runs(Path(arguments.store)) if suite in (None, "all", run.suite)]
    if not runs:
        what = "the store holds no runs" + (f" of {suite!r}." if suite else ".")
        cure = "`drystone bench --suite NAME --store DIR` adds some."
        raise _useless(what, arguments.store, cure)
    medians = tables.medians_of(runs)
    if arguments.output is not None:
        from drystone.drawing.canvas import save  # noqa: PLC0415 - see above

        make_folder(Path(arguments.output))
        for each in dict.fromkeys(one.suite for one in medians):
            path = Path(arguments.output) / f"history-{each.replace('/', '-')}.png"
            save(tables.drawn_history([one for one in medians if one.suite == each]), path, 150)
            say(f"wrote {path}")
    return (tables.history_table(medians),)
