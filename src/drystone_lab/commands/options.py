"""Options of the commands of the lab."""

import argparse

from drystone.cli.numbers import positive, whole_from
from drystone.cli.parser import Renamed

PUBLIC_OPTIONS = ("policy", "settings", "jobs", "dask", "store", "again", "history", "shake")
"""For public suites, and what other suites say that they go by."""


def add_bench(command: argparse.ArgumentParser) -> None:
    """Add the options of ``bench``."""
    command.add_argument("suite", metavar="SUITE", nargs="?", help="see --list")
    command.add_argument("--suite", dest="named", help=argparse.SUPPRESS)
    command.add_argument("--list", action="store_true", help="name suites and policies, one a line")
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
        help="of each search (search, packing); several: what it has come to after each (search)",
    )  # fmt: skip
    command.add_argument(
        "--seeds", type=whole_from(1), metavar="N",
        help="how many, from --seed on (search, public suites: 5 unless given)",
    )  # fmt: skip
    command.add_argument(
        "--only", action="append", default=[], metavar="NAME",
        help="walls whose names begin so; may be repeated (search, packing, public suites)",
    )  # fmt: skip
    command.add_argument(
        "--runs", metavar="FILE.csv",
        help="add every search to a table; those that it holds are not done again (search)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("--markdown", action="store_true", help="print as Markdown")
    _public(command)


def _public(command: argparse.ArgumentParser) -> None:
    """Add the options of public suites."""
    group = command.add_argument_group("public suites (docs/evidence/benchmark.md)")
    group.add_argument(
        "--policy", nargs="+", action="extend", default=[], metavar="NAME",
        help="methods that build every wall (default: paper random); see --list; for search those "
        "that are compared",
    )  # fmt: skip
    group.add_argument(
        "--settings", metavar="FILE.toml",
        help="parameters that are replaced for all methods (search too)",
    )  # fmt: skip
    group.add_argument(
        "--jobs", type=whole_from(1), metavar="N",
        help="processes; never the results (search too: the time of each is its own)",
    )  # fmt: skip
    group.add_argument(
        "--dask", metavar="ADDRESS", help="of the scheduler of a Dask cluster that does the runs"
    )
    group.add_argument(
        "--store", metavar="DIR", help="keep runs there; those of this version are not done again"
    )
    group.add_argument("--again", action="store_true", help="do runs again that are in the store")
    group.add_argument(
        "--history", action="store_true", help="show the quality by version that a store holds"
    )
    group.add_argument(
        "--shake", action="store_true",
        help="put finished walls on a shaking table in a rigid-body engine too (extra `physics`)",
    )  # fmt: skip


def add_fetch(command: argparse.ArgumentParser) -> None:
    """Add the options of ``fetch``."""
    command.add_argument("sets", metavar="NAME", nargs="*", help="see --list")
    command.add_argument("--list", action="store_true", help="name the sets, one a line")
    command.add_argument(
        "-o", "--output", metavar="DIR",
        help="folder to write to (default: $DRYSTONE_DATA, else a cache of your account)",
    )  # fmt: skip
    command.add_argument("--to", dest="output", action=Renamed, const="-o", help=argparse.SUPPRESS)
    command.add_argument("--json", action="store_true", help="print as JSON")


def add_reproduce(command: argparse.ArgumentParser) -> None:
    """Add the options of ``reproduce``."""
    command.add_argument(
        "names", metavar="NAME", nargs="*", help="table or figure, see --list; or all"
    )
    command.add_argument("--list", action="store_true", help="name them, one a line")
    command.add_argument(
        "-o", "--output", metavar="DIR", help="folder to write to; what is in it is kept and added"
    )
    command.add_argument("--quick", action="store_true", help="a smaller version, in a minute each")
    command.add_argument("--data", metavar="DIR", help="published data (default: $DRYSTONE_DATA)")
    command.add_argument("--seed", type=whole_from(0), default=1, help="the first one (default 1)")
    command.add_argument("--jobs", type=whole_from(1), metavar="N", help="number of processes")
    command.add_argument("--dask", metavar="ADDRESS", help="plan the walls on a Dask cluster")
    command.add_argument(
        "--again", action="store_true",
        help="make again what is finished; finished walls are taken from DIR/runs",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("--quiet", action="store_true", help="no progress")
