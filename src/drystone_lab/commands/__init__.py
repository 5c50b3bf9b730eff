"""Commands of the lab for the command line of drystone, with their options.

Each is imported when it is run.
"""

import argparse
import sys

from drystone.cli.numbers import positive, whole_from
from drystone.cli.parser import Command, run_of


def add_bench(command: argparse.ArgumentParser) -> None:
    """Add the options of ``bench``."""
    option = command.add_argument
    option("suite", metavar="SUITE", nargs="?", help="see --list")
    option("--suite", dest="named", help=argparse.SUPPRESS)
    option("--list", action="store_true", help="list suites and policies")
    option("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    option("-o", "--output", metavar="DIR", help="draw pictures into a folder")
    seed = "of the random choices, or the first of several (default 0)"
    option("--seed", type=whole_from(0), default=0, help=seed)
    option("--quick", action="store_true", help="a smaller version")
    seconds = "time of each search (search, packing); several show its progress (search)"
    option("--seconds", type=positive, nargs="+", action="extend", default=[], metavar="S",
           help=seconds)  # fmt: skip
    seeds = "number of seeds, from --seed on (default 5; search, public suites)"
    option("--seeds", type=whole_from(1), metavar="N", help=seeds)
    only = "only walls whose names begin with this; repeatable (search, packing, public suites)"
    option("--only", action="append", default=[], metavar="NAME", help=only)
    runs = "table of searches: new ones are added, those in it are not repeated (search)"
    option("--runs", metavar="FILE.csv", help=runs)
    option("--json", action="store_true", help="print as JSON")
    option("--markdown", action="store_true", help="print as Markdown")
    public = command.add_argument_group("public suites (docs/evidence/benchmark.md)").add_argument
    public(
        "--policy", nargs="+", action="extend", default=[], metavar="NAME",
        help="methods that build every wall, see --list (default: paper random); with search, "
        "those to compare",
    )  # fmt: skip
    settings = "settings that replace those of all methods (search too)"
    public("--settings", metavar="FILE.toml", help=settings)
    jobs = "number of processes, which does not change the results (search too)"
    public("--jobs", type=whole_from(1), metavar="N", help=jobs)
    public("--dask", metavar="ADDRESS", help="address of a Dask scheduler that runs the walls")
    public("--store", metavar="DIR", help="folder of runs; those of this version are not repeated")
    public("--again", action="store_true", help="repeat the runs that are in the store")
    public("--history", action="store_true", help="show the quality by version from a store")
    shake = "put finished walls on a shaking table in a rigid-body engine too (extra `physics`)"
    public("--shake", action="store_true", help=shake)


def add_fetch(command: argparse.ArgumentParser) -> None:
    """Add the options of ``fetch``."""
    option = command.add_argument
    option("sets", metavar="NAME", nargs="*", help="see --list")
    option("--list", action="store_true", help="list the sets")
    output = "folder to write to (default: $DRYSTONE_DATA, else a cache of your account)"
    option("-o", "--output", metavar="DIR", help=output)
    option("--json", action="store_true", help="print as JSON")


def add_reproduce(command: argparse.ArgumentParser) -> None:
    """Add the options of ``reproduce``."""
    option = command.add_argument
    option("names", metavar="NAME", nargs="*", help="table or figure, see --list; or all")
    option("--list", action="store_true", help="list them")
    option("-o", "--output", metavar="DIR", help="folder to write to; files in it are kept")
    option("--quick", action="store_true", help="a smaller version, in a minute each")
    option("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    option("--seed", type=whole_from(0), default=1, help="first seed (default 1)")
    option("--jobs", type=whole_from(1), metavar="N", help="number of processes")
    option("--dask", metavar="ADDRESS", help="plan the walls on a Dask cluster")
    again = "make finished items again, from the walls in DIR/runs"
    option("--again", action="store_true", help=again)
    option("--json", action="store_true", help="print as JSON")
    option("--quiet", action="store_true", help="no progress")


def say(text: str) -> None:
    """Print a result as it comes, where it does not get in the way of the tables."""
    print(text, file=sys.stderr, flush=True)


BENCH, REPRODUCE, FETCH = (
    Command(about, options, run_of(f"drystone_lab.commands.{name}"))
    for name, options, about in (
        ("bench", add_bench, "Test the numbers, and compare ways of choosing stones."),
        ("reproduce", add_reproduce, "Make the tables and figures of the paper again."),
        ("fetch", add_fetch, "Download published stone sets, with licence and citation."),
    )
)
