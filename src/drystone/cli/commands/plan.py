"""`drystone plan`."""

import argparse
from pathlib import Path

from drystone.cli.choice import files_of_choice
from drystone.cli.inputs import files_of, plan_file, refuse_among_masks, refuse_inputs
from drystone.cli.keeping import WRITTEN
from drystone.cli.numbers import add_scale, parse_wall, scale_with, whole_from
from drystone.cli.output import note
from drystone.cli.parser import list_only
from drystone.cli.planning import add_writing, plan_and_write
from drystone.cli.reading import READING, STONES, add_reading, reading_from
from drystone.cli.settings import SHOWN, add_settings, request_from
from drystone.errors import ExitCode
from drystone.io.photo_beside import photo_of
from drystone.io.read_stones import read_stones


def add(command: argparse.ArgumentParser) -> None:
    """Add what `drystone plan` takes."""
    # fmt: off
    option = command.add_argument
    option("stones", metavar="STONES", help=STONES)
    option("--wall", required=True, metavar="WxH",
           help="size of the wall: 280x80 (px of the image), or 1.4mx0.4m where the scale is known")
    option("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    option = command.add_mutually_exclusive_group().add_argument
    option("--resume", action="store_true", help="continue the plan in the output folder")
    option("--from", dest="begin", metavar="PLAN",
           help="start from the wall of another plan of these stones")
    add_reading(command)
    add_scale(command)
    add_settings(command)
    option = command.add_argument_group("stones").add_argument
    for name, text in (("--ban", "leave out of"), ("--pin", "put into")):
        option(name, nargs="+", action="extend", type=whole_from(0), default=[], metavar="ID",
               help=f"stones to {text} the wall")
    option("--fixed-order", action="store_true")
    add_writing(command)
    list_only(command, *SHOWN)
    command.epilog = f"{READING} All settings, --policy and its like among them: drystone settings."


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall and write it."""
    parse_wall(arguments.wall, 1.0)  # what is no size is refused before anything is read
    source, folder = Path(arguments.stones), Path(arguments.output)
    begin = () if arguments.begin is None else (plan_file(Path(arguments.begin)),)
    own = () if arguments.settings is None else (Path(arguments.settings),)
    read, written = (*files_of(source), *own), [folder / name for name in WRITTEN]
    refuse_inputs(read, written)
    # A plan may be replaced by a better one, the choice of an earlier search may not.
    refuse_inputs((*read, *begin), files_of_choice(folder))
    refuse_among_masks(source, written)
    stones = read_stones(source, settings=reading_from(arguments))
    note(*stones.notices)
    px_per_m = scale_with(arguments.px_per_m, stones.source.px_per_m)
    wall = parse_wall(arguments.wall, px_per_m)
    return plan_and_write(request_from(stones, wall, px_per_m, arguments, photo_of(source)))
