"""How to read stones or walls, from options or from the plan that was made of them."""

import argparse
from collections.abc import Mapping
from typing import Any, get_args

from drystone.io.read_settings import ReadSettings, Unit
from drystone.model.settings import updated

_NAMES = (
    "background", "pieces", "holes", "mask", "min_area_px", "skip", "keep", "label", "unit",
    "image", "px_per_m",
)  # fmt: skip

STONES = "label image, mask or NPY; folder of masks, or of `drystone segment`; labelme, COCO, SAM \
or GeoJSON; DXF, SVG, OBJ, PLY, STL"


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options that say how a picture of stones is to be read."""
    group = command.add_argument_group("reading")
    group.add_argument("--background", type=int, metavar="N", help="the value that is not stone")
    group.add_argument(
        "--pieces", choices=["auto", "keep-largest", "split", "error"],
        help="what to do with a stone of several pieces",
    )  # fmt: skip
    group.add_argument("--holes", choices=["fill", "keep"], help="fill holes in stones (default)")
    group.add_argument(
        "--mask", action=argparse.BooleanOptionalAction, default=None,
        help="read the picture as a binary mask, or as ids",
    )  # fmt: skip
    group.add_argument(
        "--min-area", type=int, metavar="PX", dest="min_area_px", help="leave out smaller stones"
    )
    group.add_argument(
        "--skip", type=int, action="append", metavar="ID", help="leave out a stone; may be repeated"
    )
    group.add_argument(
        "--keep", type=int, action="append", metavar="ID",
        help="take for a stone what looks like a frame, the ground, a repeat or a part of another",
    )  # fmt: skip
    group.add_argument(
        "--label", nargs="+", action="extend", metavar="NAME",
        help="which classes of annotations are stones",
    )  # fmt: skip
    group.add_argument(
        "--unit", choices=get_args(Unit)[1:], help="of a drawing or mesh that does not say its own"
    )
    group.add_argument(
        "--image",
        metavar="NAME",
        help="which image of annotations of several, or the picture that shares (YOLO) are of",
    )


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


def reading_from(arguments: argparse.Namespace) -> ReadSettings:
    """Return the settings that the options ask for.

    ``--px-per-m`` is the resolution of drawings and meshes; pictures keep their own px, and for
    them it is only the scale.
    """
    given = {name: getattr(arguments, name, None) for name in _NAMES}
    return _settings({name: value for name, value in given.items() if value is not None})


def reading_of(source: Mapping[str, Any]) -> ReadSettings:
    """Return the settings with which a plan's source was read."""
    return _settings(source.get("reading", {}))


def _settings(changes: Mapping[str, Any]) -> ReadSettings:
    return updated(ReadSettings(), changes)
