"""Options of `drystone markers`; nothing slow is imported here."""

import argparse


def add_markers(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a sheet of markers."""
    command.add_argument("-o", "--output", default="markers.pdf", metavar="SHEET.pdf")
    command.add_argument("--overwrite", action="store_true", help="replace the file")
