"""The pictures of `drystone analyse`."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from drystone.cli.analyse_tables import NAMES as TABLES
from drystone.cli.inputs import files_of_wall, refuse_inputs, refuse_plans_own
from drystone.cli.modelling import Modelled
from drystone.cli.output import prepare_files
from drystone.statics.friction_curve import AtFriction, friction_curve
from drystone.statics.loads import Loads
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitResult, LimitStatus

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


def draw(paths: list[Path], wall: Modelled, loads: Loads, ends: Sequence[LimitResult]) -> None:
    """Draw the contacts, and forces, mechanism and its motion for both ends, left first."""
    from drystone.drawing import plot_contacts, save  # noqa: PLC0415 - slow import

    contacts, *others = paths
    save(plot_contacts(wall.shapes, wall.model).figure, contacts)
    for end, files in zip(ends, (others[:3], others[3:]), strict=True):
        _draw_direction(files, wall, loads, end)


def draw_friction(folder: Path, model: RigidBlockModel, loads: Loads) -> tuple[AtFriction, ...]:
    """Analyse the wall at usual coefficients of friction, and draw that."""
    from drystone.drawing import save  # noqa: PLC0415 - slow import
    from drystone.drawing.pictures.friction import plot_friction  # noqa: PLC0415
    from drystone.drawing.report.content import TILTING  # noqa: PLC0415

    curve = friction_curve(model, loads)
    axes = plot_friction(curve, model.mu, slides_at_mu=loads.name == TILTING)
    save(axes.figure, folder / FRICTION)
    return curve


def _draw_direction(files: list[Path], wall: Modelled, loads: Loads, result: LimitResult) -> None:
    from drystone.drawing import (  # noqa: PLC0415 - slow import
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
    load = "" if falls or loads.name.startswith("tilting table") else loads.name.split(" (")[0]
    moving = (wall.shapes, result.mechanism, direction, result.alpha)
    # The card names blocks by their ids.
    save(plot_mechanism(*moving, load=load, numbers=True).figure, mechanism)
    save_mechanism_animation(motion, *moving, load=load, numbers=True)
