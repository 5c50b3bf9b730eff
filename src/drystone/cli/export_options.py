"""Options of `drystone export`; nothing slow is imported here."""

import argparse

from drystone.cli.numbers import positive
from drystone.cli.scale import add_scale
from drystone.drawing.export.formats import FORMATS


def add_export(command: argparse.ArgumentParser) -> None:
    """Add formats and what shapes them."""
    command.add_argument("plan", metavar="PLAN.json", nargs="?", help="plan, or its folder")
    command.add_argument("--list", action="store_true", help="name the formats, one a line")
    command.add_argument(
        "--to", nargs="+", action="extend", default=[], metavar="FORMAT", choices=list(FORMATS),
        help=", ".join(FORMATS),
    )  # fmt: skip
    command.add_argument(
        "-o", "--output", metavar="DIR", help="folder to add files to (default: beside the plan)"
    )
    command.add_argument("--overwrite", action="store_true", help="replace files of the same names")
    command.add_argument("--json", action="store_true", help="print the files as JSON")
    add_scale(command)
    making = command.add_argument_group("stones")
    making.add_argument(
        "--thickness", type=positive, metavar="M", dest="thickness_m",
        help="of the wall, metres (default: the median square root of the stones' areas)",
    )  # fmt: skip
    making.add_argument(
        "--density", type=positive, metavar="KG", dest="density_kg_m3", default=2600.0,
        help="kg in a cubic metre of stone (default 2600)",
    )  # fmt: skip
    drawing = command.add_argument_group("drawings and films")
    drawing.add_argument(
        "--paper-scale", type=positive, default=10.0, metavar="N",
        help="the build sheet is drawn at 1:N (default 10, larger when the wall does not fit)",
    )  # fmt: skip
    drawing.add_argument("--title", default="", metavar="TEXT", help="in the title block")
    drawing.add_argument(
        "--projector", metavar="WxH@PX", default="1920x1080@1000",
        help="px of the projector and how many are a metre on the wall (1920x1080@1000)",
    )  # fmt: skip
    drawing.add_argument(
        "--seconds-per-step", type=positive, default=0.6, metavar="S", help="of films (default .6)"
    )
