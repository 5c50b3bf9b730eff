"""Options of `drystone segment`; nothing slow is imported here."""

import argparse
import math
import re

from drystone.cli.numbers import positive, whole_from
from drystone.cli.scale import add_scale

_AREA = re.compile(r"(\d+(?:\.\d*)?|\.\d+)\s*(cm2|px)?")


def add_segment(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a photograph."""
    command.add_argument("photo", metavar="PHOTO", help="JPEG, PNG or TIFF of stones laid out")
    command.add_argument("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    command.add_argument("--overwrite", action="store_true", help="write into a folder with files")
    add_scale(command)
    markers = command.add_argument_group("markers (they correct the perspective too)")
    markers.add_argument(
        "--aruco", metavar="MARKERS",
        help="A4 or A4:50mm: the sheet of `drystone markers`; 120mm: single markers of this size",
    )  # fmt: skip
    markers.add_argument(
        "--marker-ids", nargs="+", type=whole_from(0), metavar="ID",
        help="markers that count (default: of a sheet 0 to 3, of single ones all)",
    )  # fmt: skip
    markers.add_argument(
        "--check-line", metavar="LENGTH",
        help="what a ruler says of the line of 100 mm on the printed sheet, such as 97mm",
    )  # fmt: skip
    stones = command.add_argument_group("stones")
    stones.add_argument(
        "--ground", choices=["auto", "light", "dark"], default="auto",
        help="what the stones lie on (default: the most frequent colour)",
    )  # fmt: skip
    stones.add_argument(
        "--min-area", type=area, metavar="AREA",
        help="smaller is no stone: 12cm2, or px of the result (default: a fiftieth of a usual one)",
    )  # fmt: skip
    stones.add_argument(
        "--no-split", action="store_false", dest="split", help="leave touching stones together"
    )
    stones.add_argument(
        "--mpx", type=positive, default=1.6, metavar="N",
        help="million px of the result, at most (default 1.6)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")


def area(text: str) -> tuple[float, str]:
    """Read an area: value and unit.

    Examples
    --------
    >>> area("12cm2"), area("300")
    ((12.0, 'cm2'), (300.0, 'px'))
    """
    found = _AREA.fullmatch(text.strip())
    if found is None or not 0 < float(found[1]) < math.inf:
        message = f"{text!r} is no area such as 12cm2 or 300 (px)"
        raise argparse.ArgumentTypeError(message)
    return float(found[1]), found[2] or "px"
