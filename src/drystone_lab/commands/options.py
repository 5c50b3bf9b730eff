"""Options of the commands of the lab."""

import argparse
import sys

from drystone.cli.numbers import positive, whole_from


def add_bench(command: argparse.ArgumentParser) -> None:
    """Add the options of ``bench``."""
    command.add_argument("suite", metavar="SUITE", nargs="?", help="see --list")
    command.add_argument("--suite", dest="named", help=argparse.SUPPRESS)
    command.add_argument("--list", action="store_true", help="list suites and policies")
    command.add_argument("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    command.add_argument("-o", "--output", metavar="DIR", help="draw pictures into a folder")
    command.add_argument(
        "--seed",
        type=whole_from(0),
        default=0,
        help="of the random choices, or the first of several (default 0)",
    )
    command.add_argument("--quick", action="store_true", help="a smaller version")
    command.add_argument(
        "--seconds", type=positive, nargs="+", action="extend", default=[], metavar="S",
        help="time of each search (search, packing); several show its progress (search)",
    )  # fmt: skip
    command.add_argument(
        "--seeds", type=whole_from(1), metavar="N",
        help="number of seeds, from --seed on (default 5; search, public suites)",
    )  # fmt: skip
    command.add_argument(
        "--only", action="append", default=[], metavar="NAME",
        help="only walls whose names begin with this; repeatable (search, packing, public suites)",
    )  # fmt: skip
    command.add_argument(
        "--runs", metavar="FILE.csv",
        help="table of searches: new ones are added, those in it are not repeated (search)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("--markdown", action="store_true", help="print as Markdown")
    group = command.add_argument_group("public suites (docs/evidence/benchmark.md)")
    group.add_argument(
        "--policy", nargs="+", action="extend", default=[], metavar="NAME",
        help="methods that build every wall, see --list (default: paper random); with search, "
        "those to compare",
    )  # fmt: skip
    group.add_argument(
        "--settings", metavar="FILE.toml",
        help="settings that replace those of all methods (search too)",
    )  # fmt: skip
    group.add_argument(
        "--jobs", type=whole_from(1), metavar="N",
        help="number of processes, which does not change the results (search too)",
    )  # fmt: skip
    group.add_argument(
        "--dask", metavar="ADDRESS", help="address of a Dask scheduler that runs the walls"
    )
    group.add_argument(
        "--store", metavar="DIR", help="folder of runs; those of this version are not repeated"
    )
    group.add_argument("--again", action="store_true", help="repeat the runs that are in the store")
    group.add_argument(
        "--history", action="store_true", help="show the quality by version from a store"
    )
    group.add_argument(
        "--shake", action="store_true",
        help="put finished walls on a shaking table in a rigid-body engine too (extra `physics`)",
    )  # fmt: skip


def add_fetch(command: argparse.ArgumentParser) -> None:
    """Add the options of ``fetch``."""
    command.add_argument("sets", metavar="NAME", nargs="*", help="see --list")
    command.add_argument("--list", action="store_true", help="list the sets")
    command.add_argument(
        "-o", "--output", metavar="DIR",
        help="folder to write to (default: $DRYSTONE_DATA, else a cache of your account)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")


def add_reproduce(command: argparse.ArgumentParser) -> None:
    """Add the options of ``reproduce``."""
    command.add_argument(
        "names", metavar="NAME", nargs="*", help="table or figure, see --list; or all"
    )
    command.add_argument("--list", action="store_true", help="list them")
    command.add_argument(
        "-o", "--output", metavar="DIR", help="folder to write to; files in it are kept"
    )
    command.add_argument("--quick", action="store_true", help="a smaller version, in a minute each")
    command.add_argument("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    command.add_argument("--seed", type=whole_from(0), default=1, help="first seed (default 1)")
    command.add_argument("--jobs", type=whole_from(1), metavar="N", help="number of processes")
    command.add_argument("--dask", metavar="ADDRESS", help="plan the walls on a Dask cluster")
    command.add_argument(
        "--again", action="store_true",
        help="make finished items again, from the walls in DIR/runs",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("--quiet", action="store_true", help="no progress")


def say(text: str) -> None:
    """Print a result as it comes, where it does not get in the way of the tables."""
    print(text, file=sys.stderr, flush=True)
