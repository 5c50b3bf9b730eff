"""`drystone generate`: synthetic stone sets."""

import argparse
import re
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from drystone import generate
from drystone.cli.numbers import whole_from
from drystone.cli.output import note, prepare_files
from drystone.errors import ExitCode, Notice, UsageError, counted
from drystone.io.patches import MIN_AREA_PX
from drystone.io.wall_image import write_labels
from drystone.model.settings import updated


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    # fmt: off
    option = command.add_argument
    option("kind", choices=[*generate.GENERATORS], help="how the stones are shaped")
    option("-o", "--output", required=True, metavar="STONES.png", help="file to write")
    option("--count", type=whole_from(1), metavar="N", help="number of stones")
    option("--seed", type=whole_from(0), default=0, help="of the random choices (default 0)")
    option("--overwrite", action="store_true", help="replace the file")
    option("--set", action="append", default=[], metavar="NAME=VALUE", dest="changes",
           help="a parameter, such as noise=0.4 or D2=0.2 (docs/settings.md has all)")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Make stones and write them as one label image."""
    path = Path(arguments.output)
    prepare_files([path], overwrite=arguments.overwrite)
    settings_type, make = generate.GENERATORS[arguments.kind]
    changes = _changes(arguments.changes, settings_type)
    if arguments.count is not None:
        changes["count"] = arguments.count
    settings = updated(settings_type(), changes)
    stones = make(settings, np.random.default_rng(arguments.seed))
    write_labels(generate.lay_out(stones), path)
    size = stones.source
    if small := sum(stone.area_px < MIN_AREA_PX for stone in stones):
        text = f"reading leaves out {counted(small, 'stone')} of less than {MIN_AREA_PX} px."
        note(Notice("W113", text, "Ask for larger ones, or read them with --min-area 1."))
    print(f"{len(stones)} stones, {size.width_px} x {size.height_px} px: {path}")
    return ExitCode.DONE


def _changes(items: list[str], settings_type: type[Any]) -> dict[str, Any]:
    """Turn NAME=VALUE into values; VALUE is written as in TOML, or as 0.2."""
    changes: dict[str, Any] = {}
    for item in items:
        name, sign, text = item.partition("=")
        # TOML wants a digit before the point.
        text = re.sub(r"^\s*([+-]?)\.(?=\d)", r"\g<1>0.", text)
        try:
            changes[name] = tomllib.loads(f"value = {text}")["value"]
        except (ValueError, RecursionError):  # also numbers of thousands of digits
            sign = ""
        if not sign:
            cure = f"Known: {', '.join(field.name for field in fields(settings_type))}."
            raise UsageError("E135", f"{item!r} is not NAME=VALUE.", where="--set", cure=cure)
    return changes
