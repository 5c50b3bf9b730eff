"""How to read stones or walls, from options or from the plan that was made of them."""

import argparse
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_args

from drystone.cli.numbers import area, refuse_cm2
from drystone.cli.parser import list_only
from drystone.io.read_settings import ReadSettings, Unit, Up
from drystone.model.settings import updated

STONES = "label image, mask or NPY; folder of masks, or of `drystone segment`; labelme, COCO, SAM \
or GeoJSON; DXF, SVG, OBJ, PLY, STL"

READING = "How stones are read (--skip, --min-area, --unit ...): drystone stones --help."


def add_reading(command: argparse.ArgumentParser) -> None:
    """Add the options that say how a picture of stones is to be read."""
    # fmt: off
    option = command.add_argument_group("reading").add_argument
    option("--background", type=_value, metavar="N", help="the value of what is not stone")
    option("--pieces", choices=["auto", "keep-largest", "split", "error"],
           help="what to do with a stone of several pieces")
    option("--holes", choices=["fill", "keep"], help="fill holes in stones (default)")
    option("--mask", action=argparse.BooleanOptionalAction, default=None,
           help="read the picture as a binary mask, or as ids")
    option("--min-area", type=area, metavar="AREA",
           help="leave out smaller stones: px, or 12cm2 or 2in2 where the scale is given")
    option("--skip", type=int, action="append", metavar="ID",
           help="leave this out, it is not a stone; repeatable")
    option("--keep", type=int, action="append", metavar="ID",
           help="read this as a stone, though it looks like a frame, the ground, a repeat or a "
           "part; repeatable")
    option("--label", nargs="+", action="extend", metavar="NAME",
           help="classes of annotations that are stones")
    option("--unit", choices=get_args(Unit)[1:],
           help="of a drawing or mesh, even if a DXF or SVG names another")
    option("--up", choices=get_args(Up)[1:],
           help="axis of a mesh or DXF that points up; -back looks from behind")
    option("--image", metavar="NAME",
           help="image to take from annotations of several, or the picture of YOLO's shares")


def add_wall(command: argparse.ArgumentParser, or_a: str = "block model (JSON); or ") -> None:
    """Add the wall, what else it may be, how its stones are read, and where results go."""
    # fmt: off
    option = command.add_argument
    option("wall_path", metavar="WALL",
           help=f"plan.json or its folder; {or_a}stones: {STONES}")
    add_reading(command)
    list_only(command)
    command.epilog = READING
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
    names = [field.name for field in fields(ReadSettings)]
    given: dict[str, Any] = {name: getattr(arguments, name, None) for name in names}
    refuse_cm2(arguments.min_area, given["px_per_m"], "picture")
    if arguments.min_area is not None:
        value, unit = arguments.min_area
        per_px = 1e-4 * given["px_per_m"] ** 2 if unit == "cm2" else 1.0
        given["min_area_px"] = max(1, round(value * per_px))
    return reading_of({"reading": {k: value for k, value in given.items() if value is not None}})


def reading_of(source: Mapping[str, Any]) -> ReadSettings:
    """Return the settings with which a plan's source was read."""
    return updated(ReadSettings(), source.get("reading", {}))
