"""`drystone plan`."""

import argparse
import sys
from pathlib import Path

from drystone.cli.announce import WRITTEN
from drystone.cli.choice import files_of_choice
from drystone.cli.inputs import files_of, files_of_plan, refuse_among_masks, refuse_inputs
from drystone.cli.lengths import parse_wall
from drystone.cli.planning import plan_and_write
from drystone.cli.reading import reading_from
from drystone.cli.scale import scale_with
from drystone.errors import ExitCode
from drystone.io.photo_beside import photo_of
from drystone.io.read_stones import read_stones


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
    arguments.px_per_m = scale_with(arguments.px_per_m, stones.source.px_per_m)
    wall = parse_wall(arguments.wall, arguments.px_per_m)
    return plan_and_write(stones, wall, arguments, photo_of(source))
