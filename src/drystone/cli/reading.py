"""How to read stones or walls, from options or from the plan that was made of them."""

import argparse
from collections.abc import Mapping
from typing import Any, get_args

from drystone.io.read_settings import ReadSettings, Unit, Up
from drystone.model.settings import updated

_NAMES = (
    "background", "pieces", "holes", "mask", "min_area_px", "skip", "keep", "label", "unit", "up",
    "image", "px_per_m",
)  # fmt: skip

STONES = "label image, mask or NPY; folder of masks, or of `drystone segment`; labelme, COCO, SAM \
or GeoJSON; DXF, SVG, OBJ, PLY, STL"


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options that say how a picture of stones is to be read."""
    # fmt: off
    option = command.add_argument_group("reading").add_argument
    option("--background", type=_value, metavar="N", help="the value that is not stone")
    option("--pieces", choices=["auto", "keep-largest", "split", "error"],
           help="what to do with a stone of several pieces")
    option("--holes", choices=["fill", "keep"], help="fill holes in stones (default)")
    option("--mask", action=argparse.BooleanOptionalAction, default=None,
           help="read the picture as a binary mask, or as ids")
    option("--min-area", type=int, metavar="PX", dest="min_area_px",
           help="leave out smaller stones")
    option("--skip", type=int, action="append", metavar="ID",
           help="leave out a stone; may be repeated")
    option("--keep", type=int, action="append", metavar="ID",
           help="take for a stone what looks like a frame, the ground, a repeat or a part")
    option("--label", nargs="+", action="extend", metavar="NAME",
           help="which classes of annotations are stones")
    option("--unit", choices=get_args(Unit)[1:],
           help="of a drawing or mesh, also where a DXF or SVG says another")
    option("--up", choices=get_args(Up)[1:],
           help="which axis of a mesh or DXF is up; -back sees it from the other side")
    option("--image", metavar="NAME",
           help="which image of annotations of several, or the picture that shares (YOLO) are of")


def add_wall(command: argparse.ArgumentParser) -> None:
    """Add the wall, how its stones are read, and where results go."""
    # fmt: off
    option = command.add_argument
    option("wall_path", metavar="WALL",
           help=f"plan.json or its folder; block model (JSON); or stones: {STONES}")
    add_reading(command)
    option("--json", action="store_true", help="print as JSON")
    option("-o", "--output", metavar="DIR", help="draw pictures into a folder")
    option("--overwrite", action="store_true", help="replace pictures of the same names")


def _value(text: str) -> int:
    """Read a background; NaN is one in any case, and -1 is no id, so with it 0 is none either."""
    return -1 if text.lower() == "nan" else int(text)


_value.__name__ = "int"  # as argparse names it in errors


def reading_from(arguments: argparse.Namespace) -> ReadSettings:
    """Return the settings that the options ask for.

    ``--px-per-m`` is the resolution of drawings and meshes; pictures keep their own px, and for
    them it is only the scale.
    """
    given = {name: getattr(arguments, name, None) for name in _NAMES}
    return reading_of({"reading": {k: value for k, value in given.items() if value is not None}})


def reading_of(source: Mapping[str, Any]) -> ReadSettings:
    """Return the settings with which a plan's source was read."""
    return updated(ReadSettings(), source.get("reading", {}))
