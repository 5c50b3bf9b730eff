"""Options of `drystone markers`; nothing slow is imported here."""

import argparse

from drystone.cli.numbers import whole_from


def add_markers(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a sheet of markers."""
    command.add_argument(
        "-o", "--output", default="markers.pdf", metavar="SHEET.pdf",
        help="file to write (default markers.pdf)",
    )  # fmt: skip
    command.add_argument("--overwrite", action="store_true", help="replace the file")
    command.add_argument(
        "--size", metavar="LENGTH",
        help="side of a black square (default 50mm; with --single 120mm)",
    )  # fmt: skip
    command.add_argument(
        "--dictionary", choices=["aruco", "apriltag"], default="aruco",
        help="family of the markers: ArUco 4x4 (default) or AprilTag 36h11",
    )  # fmt: skip
    command.add_argument(
        "--page", choices=["A4", "A3", "letter"], default="A4", help="paper (default A4)"
    )
    command.add_argument(
        "--single", action="store_true",
        help="one large marker a page, to lie anywhere (use two or more)",
    )  # fmt: skip
    command.add_argument(
        "--count", type=whole_from(1), metavar="N",
        help="markers: four make a sheet (default 4; with --single 2)",
    )  # fmt: skip
    command.add_argument(
        "--ids", type=whole_from(0), default=0, metavar="FIRST",
        help="number of the first marker, 0, 4, 8 ... for sheets (default 0)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")
