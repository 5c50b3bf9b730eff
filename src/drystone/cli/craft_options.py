"""Options of `drystone craft`; nothing slow is imported here."""

import argparse


def add_craft(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a look at a wall."""
    command.add_argument(
        "wall_path", metavar="WALL", help="label image, plan.json, or block model (JSON)"
    )
    command.add_argument("-o", "--output", metavar="DIR", help="draw the findings into a folder")
    command.add_argument("--overwrite", action="store_true", help="replace pictures")
    command.add_argument("--json", action="store_true", help="print as JSON")
