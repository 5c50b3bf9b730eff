"""The options of commands that look at a wall: `analyse`, `measure` and `craft`."""

import argparse


def add_wall(command: argparse.ArgumentParser) -> None:
    """Add the wall, how its picture is read, and where results go."""
    command.add_argument(
        "wall_path", metavar="WALL", help="label image, plan.json, or block model (JSON)"
    )
    command.add_argument(
        "--background", type=int, default=0, metavar="N",
        help="the value of a label image that is not stone (default 0)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
    command.add_argument("-o", "--output", metavar="DIR", help="draw pictures into a folder")
    command.add_argument(
        "--overwrite", action="store_true", help="replace pictures of the same names"
    )
