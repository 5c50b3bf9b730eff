"""The pictures of `drystone analyse`."""

import argparse
from pathlib import Path

from drystone.cli.inputs import files_of_wall, refuse_inputs, refuse_plans_own
from drystone.cli.output import prepare_files
from drystone.drawing.words.tables import NAMES as TABLES

_DIRECTIONS = ("left", "right")

FRICTION, REPORT, SCATTER = "friction.png", "report.html", "scatter.png"


def prepare(folder: Path, arguments: argparse.Namespace) -> list[Path]:
    """Make room for all pictures; refuse to write over files unless asked to."""
    names = ["contacts.png"]
    for direction in _DIRECTIONS:
        names += [f"{kind}_{direction}.png" for kind in ("mechanism", "forces")]
        names.append(f"mechanism_{direction}.gif")
    paths = [folder / name for name in names]
    wall, written = Path(arguments.wall_path), [*paths, *_others(folder)]
    refuse_inputs(files_of_wall(wall), written)
    refuse_plans_own(wall, written)
    prepare_files(written, overwrite=arguments.overwrite)
    return paths


def clear(folder: Path) -> None:
    """Take out what an earlier run left and not every run writes: it belongs to another wall.

    Not before there is an answer to put in its place.
    """
    for path in _others(folder):
        path.unlink(missing_ok=True)


def _others(folder: Path) -> list[Path]:
    return [folder / name for name in (*TABLES, FRICTION, REPORT, SCATTER)]
