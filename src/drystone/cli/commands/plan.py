"""`drystone plan`."""

import argparse
import sys
from pathlib import Path

from drystone.cli.lengths import parse_wall
from drystone.cli.planning import plan_and_write
from drystone.cli.reading import reading_from
from drystone.errors import ExitCode
from drystone.io.read_stones import read_stones


def run(arguments: argparse.Namespace) -> ExitCode:
    """Plan a wall and write it."""
    width, height = parse_wall(arguments.wall, arguments.px_per_m)
    stones = read_stones(Path(arguments.stones), settings=reading_from(arguments))
    for notice in stones.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    return plan_and_write(stones, (width, height), arguments)
