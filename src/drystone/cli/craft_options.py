"""Options of `drystone craft`; nothing slow is imported here."""

import argparse

from drystone.cli.numbers import finite, whole_from
from drystone.cli.wall_options import add_wall


def add_craft(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a look at a wall."""
    add_wall(command)
    command.add_argument(
        "--cases", type=whole_from(0), default=3, metavar="N",
        help="how many places a rule names in the table (default 3); JSON has all",
    )  # fmt: skip
    command.add_argument(
        "--limit", action="append", type=_limit, default=[], metavar="RULE=GOOD:FAIR",
        dest="limits",
        help="last good and last fair number of a rule, such as laps=.1:.3; repeatable",
    )  # fmt: skip
    command.add_argument(
        "--wedges", nargs="+", action="extend", type=whole_from(1), default=[], metavar="ID",
        help="ids that are wedges, in a label image or block model",
    )  # fmt: skip


def _limit(text: str) -> tuple[str, float, float]:
    """Read a rule and its two limits."""
    name, equals, values = text.partition("=")
    good, colon, fair = values.partition(":")
    if not (equals and colon):
        raise argparse.ArgumentTypeError(f"{text!r} is not RULE=GOOD:FAIR")
    return name, finite(good), finite(fair)
