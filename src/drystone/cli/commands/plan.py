"""`drystone plan`."""

import argparse
import sys
from pathlib import Path

from drystone.cli.announce import WRITTEN
from drystone.cli.choice import files_of_choice
from drystone.cli.inputs import files_of, files_of_plan, refuse_among_masks, refuse_inputs
from drystone.cli.lengths import parse_wall
from drystone.cli.numbers import whole_from
from drystone.cli.planning import add_writing, plan_and_write
from drystone.cli.reading import STONES, add_reading, reading_from
from drystone.cli.request import output_from, request_from
from drystone.cli.scale import add_scale, scale_with
from drystone.cli.settings import add_settings
from drystone.errors import ExitCode
from drystone.io.photo_beside import photo_of
from drystone.io.read_stones import read_stones


def add(command: argparse.ArgumentParser) -> None:
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
    add_settings(command)
    group = command.add_argument_group("stones")
    group.add_argument(
        "--ban", nargs="+", action="extend", type=whole_from(0), default=[], metavar="ID",
        help="stones that are not used",
    )  # fmt: skip
    group.add_argument(
        "--pin", nargs="+", action="extend", type=whole_from(0), default=[], metavar="ID",
        help="stones that must be in the wall",
    )  # fmt: skip
    group.add_argument(
        "--fixed-order", action="store_true",
        help="place stones in the order of their ids; what finds no place then is set aside",
    )  # fmt: skip
    add_writing(command)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall and write it."""
    parse_wall(arguments.wall, 1.0)  # what is no size is refused before anything is read
    source, folder = Path(arguments.stones), Path(arguments.output)
    begin = () if arguments.begin is None else files_of_plan(Path(arguments.begin))
    own = () if arguments.settings is None else (Path(arguments.settings),)
    read, written = (*files_of(source), *own), [folder / name for name in WRITTEN]
    refuse_inputs(read, written)
    # A plan may be replaced by a better one, the choice of an earlier search may not.
    refuse_inputs((*read, *begin), files_of_choice(folder))
    refuse_among_masks(source, written)
    stones = read_stones(source, settings=reading_from(arguments))
    for notice in stones.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    px_per_m = scale_with(arguments.px_per_m, stones.source.px_per_m)
    wall = parse_wall(arguments.wall, px_per_m)
    request = request_from(stones, wall, px_per_m, arguments)
    return plan_and_write(request, output_from(arguments, photo_of(source)))
