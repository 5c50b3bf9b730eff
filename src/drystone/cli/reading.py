"""How to read stones, from options or from the plan that was made of them."""

import argparse
from collections.abc import Mapping
from typing import Any

from drystone.io.read_settings import ReadSettings
from drystone.model.settings import updated


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


def reading_from(arguments: argparse.Namespace) -> ReadSettings:
    """Return the settings that the options ask for."""
    names = ("background", "pieces", "holes", "mask", "min_area_px", "skip")
    given = {name: getattr(arguments, name) for name in names}
    return _settings({name: value for name, value in given.items() if value is not None})


def reading_of(source: Mapping[str, Any]) -> ReadSettings:
    """Return the settings with which a plan's source was read."""
    return _settings(source.get("reading", {}))


def _settings(changes: Mapping[str, Any]) -> ReadSettings:
    values = {name: tuple(v) if isinstance(v, list) else v for name, v in changes.items()}
    skip = values.pop("skip", ())
    return updated(ReadSettings(skip=skip), values)
