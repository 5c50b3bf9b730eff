"""Options of `drystone plan` and `drystone demo`."""

import argparse

from drystone.cli.numbers import positive, share, whole_from
from drystone.cli.reading import STONES, add_reading
from drystone.cli.scale import add_scale
from drystone.planner.search_settings import AIMS

_seed, _count = whole_from(0), whole_from(1)


def add_plan(command: argparse.ArgumentParser) -> None:
    """Add what `drystone plan` takes."""
    command.add_argument("stones", metavar="STONES", help=STONES)
    command.add_argument(
        "--wall", required=True, metavar="WxH",
        help="size in px of the source image, or 1.4mx0.4m with --px-per-m",
    )  # fmt: skip
    command.add_argument("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    built = command.add_mutually_exclusive_group()
    built.add_argument(
        "--resume", action="store_true", help="go on from the partial plan in the output folder"
    )
    built.add_argument(
        "--from", dest="begin", metavar="PLAN",
        help="begin the search with the wall of a plan of these stones (its file or folder)",
    )  # fmt: skip
    add_reading(command)
    add_scale(command)
    _planning(command)
    _choosing(command)
    _writing(command)


def add_demo(command: argparse.ArgumentParser) -> None:
    """Add what `drystone demo` takes."""
    command.add_argument(
        "-o", "--output", default="drystone-demo", metavar="DIR", help="folder to write to"
    )
    add_scale(command)
    _planning(command)
    _writing(command)


def _planning(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("method")
    group.add_argument("--method", default="best", metavar="NAME", help="best (default) or paper")
    group.add_argument(
        "--settings", metavar="FILE.toml", help="parameters that replace the method's"
    )
    group.add_argument("--seed", type=_seed, default=0, help="of the random choices (default 0)")
    group.add_argument(
        "--scale", type=share, metavar="S", help="plan on images reduced by S, 0 to 1"
    )
    group.add_argument(
        "--policy", metavar="NAME",
        help="who chooses the stones of a single pass: paper, random, lowest, scalarised, filter, "
        "towers, learned, or one that is installed (docs/policies.md)",
    )  # fmt: skip
    group.add_argument(
        "--sampling", choices=["variant", "uniform", "twofold", "full"],
        help="stones that are tried in a step: one of each cluster, as many at random, one of "
        "each and then all of the winner's cluster, or all",
    )  # fmt: skip
    group.add_argument("--placement", choices=["snug", "eq12", "lowest"])
    group.add_argument("--reach", choices=["any", "above"], help="where a stone may be inserted")
    group.add_argument(
        "--two-sided", action=argparse.BooleanOptionalAction, default=None, dest="two_sided",
        help="build from both ends",
    )  # fmt: skip
    group.add_argument(
        "--one-sided", action="store_false", dest="two_sided", help="same as --no-two-sided"
    )
    group.add_argument("--orientations", metavar="SET", help="sf, quarter, or a step such as 10deg")
    group.add_argument("--stabilise", choices=["both", "rotation", "wedge", "none"])
    group.add_argument("--mu", type=float, help="coefficient of friction (default .58)")
    group.add_argument(
        "--geometry", choices=["exact", "raster"],
        help="exact: stones settle on their outlines; raster: they are their pixels",
    )  # fmt: skip
    group.add_argument(
        "--settle", choices=["energy", "pivot"],
        help="with exact geometry: down to the least energy, or rolling as in the paper",
    )  # fmt: skip
    effort = group.add_mutually_exclusive_group()
    effort.add_argument(
        "--time", type=positive, metavar="SECONDS",
        help="time limit of the search (best: 10 s for 30 stones, and a whole wall)",
    )  # fmt: skip
    effort.add_argument(
        "--budget", type=_count, metavar="N",
        help="how many walls are built instead, which repeats exactly: 1 is a single pass",
    )  # fmt: skip
    group.add_argument(
        "--aim", nargs="+", action="extend", type=_aim, metavar="FIGURE=VALUE",
        help="figures to reach, such as F_SF=.88 F_AV=40 F_AH=1.5 F_LR=.8",
    )  # fmt: skip
    group.add_argument(
        "--skip-too-large", action="store_true", default=None,
        help="leave out stones that fit into the wall in no orientation",
    )  # fmt: skip
    group.add_argument(
        "--jobs",
        type=_count,
        default=1,
        metavar="N",
        help="processes; never the result of a budget",
    )


def _choosing(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("stones")
    group.add_argument(
        "--ban", nargs="+", action="extend", type=_seed, default=[], metavar="ID",
        help="stones that are not used",
    )  # fmt: skip
    group.add_argument(
        "--pin", nargs="+", action="extend", type=_seed, default=[], metavar="ID",
        help="stones that must be in the wall",
    )  # fmt: skip
    group.add_argument(
        "--fixed-order", action="store_true",
        help="place stones in the order of their ids; what finds no place then is set aside",
    )  # fmt: skip


def _aim(text: str) -> tuple[str, float]:
    """Read what a figure of merit shall reach."""
    name, equals, value = text.partition("=")
    if name not in AIMS or not equals:
        message = f"{text!r} is not one of {', '.join(f'{known}=VALUE' for known in AIMS)}"
        raise argparse.ArgumentTypeError(message)
    return name, positive(value)


def _writing(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("output")
    group.add_argument(
        "--overwrite", action="store_true", help="write into a folder that has files"
    )
    group.add_argument(
        "--pareto", action="store_true",
        help="write the walls too that no wall of the search beats in every figure: pareto/01, ...",
    )  # fmt: skip
    group.add_argument("--json", action="store_true", help="print the summary as JSON")
    group.add_argument("--quiet", action="store_true", help="no progress")
    group.add_argument("--profile", action="store_true", help="say where the time went")
