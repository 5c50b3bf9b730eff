"""Options of `drystone segment`; nothing slow is imported here."""

import argparse


def add_segment(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a photograph."""
    command.add_argument("photo", metavar="PHOTO", help="JPEG, PNG or TIFF of stones laid out")
    command.add_argument("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    command.add_argument("--overwrite", action="store_true", help="write into a folder with files")
    command.add_argument("--json", action="store_true", help="print as JSON")
