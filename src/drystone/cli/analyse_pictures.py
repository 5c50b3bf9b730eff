"""The pictures of `drystone analyse`."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.modelling import Modelled
from drystone.cli.output import prepare_files
from drystone.statics.loads import Loads
from drystone.statics.result import LimitResult, LimitStatus

_DIRECTIONS = ("left", "right")


def prepare(folder: Path, arguments: argparse.Namespace) -> list[Path]:
    """Make room for all pictures; refuse to write over files unless asked to."""
    names = ["contacts.png"]
    for direction in _DIRECTIONS:
        names += [f"{kind}_{direction}.png" for kind in ("mechanism", "forces")]
        names.append(f"mechanism_{direction}.gif")
    paths = [folder / name for name in names]
    prepare_files(paths, overwrite=arguments.overwrite)
    return paths


def draw(paths: list[Path], wall: Modelled, loads: Loads, ends: Sequence[LimitResult]) -> None:
    """Draw the contacts, and forces, mechanism and its motion for both ends, left first."""
    from drystone.plotting import plot_contacts, save  # noqa: PLC0415 - slow import

    contacts, *others = paths
    save(plot_contacts(wall.shapes, wall.model).figure, contacts)
    for end, files in zip(ends, (others[:3], others[3:]), strict=True):
        _draw_direction(files, wall, loads, end)


def _draw_direction(files: list[Path], wall: Modelled, loads: Loads, result: LimitResult) -> None:
    from drystone.plotting import (  # noqa: PLC0415 - slow import
        plot_forces,
        plot_mechanism,
        save,
        save_mechanism_animation,
    )

    for path in files:
        # One that an earlier run left would belong to another wall.
        path.unlink(missing_ok=True)
    mechanism, forces, motion = files
    if result.forces is not None:
        save(plot_forces(wall.shapes, wall.model, result.forces).figure, forces)
    if result.mechanism is None:
        return
    falls = result.status is LimitStatus.UNSTABLE
    direction = None if falls else result.direction
    load = "" if falls or loads.name.startswith("tilting table") else loads.name
    moving = (wall.shapes, result.mechanism, direction, result.alpha)
    # The card names blocks by their ids.
    save(plot_mechanism(*moving, load=load, numbers=True).figure, mechanism)
    save_mechanism_animation(motion, *moving, load=load, numbers=True)
