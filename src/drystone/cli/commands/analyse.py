"""`drystone analyse`: limit analysis of any wall."""

import argparse
import sys
from pathlib import Path
from typing import Any

from drystone.cli.output import number, prepare_files, print_json, print_table
from drystone.cli.walls import GivenWall, read_wall, unsupported
from drystone.errors import ExitCode
from drystone.statics.limit import lateral_resistance
from drystone.statics.model import Direction, RigidBlockModel
from drystone.statics.result import LateralResistance, LimitResult

_DIRECTIONS: tuple[Direction, Direction] = ("left", "right")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print load multipliers and mechanism; draw the mechanisms when asked."""
    wall = read_wall(Path(arguments.wall_path))
    model, notices = wall.model(arguments.mu)
    for notice in notices:
        print(f"drystone: {notice}", file=sys.stderr)
    resistance = lateral_resistance(model, mechanism=True)
    loose = None if resistance.stable else unsupported(model)
    if loose is not None:
        print(f"drystone: {loose}", file=sys.stderr)
    if arguments.output is not None:
        _draw(wall, resistance, Path(arguments.output), overwrite=arguments.overwrite)
    if arguments.json:
        print_json(_report(model, resistance))
        return ExitCode.DONE
    print_table(
        f"{arguments.wall_path}: {len(model.blocks)} blocks, {model.contact_count} contact points",
        [
            ("load to the left", _words(resistance.left)),
            ("load to the right", _words(resistance.right)),
            ("F_LR", f"{number(resistance.value)}  min(alpha) / mu, mu = {model.mu:g}"),
            ("assumptions", "2D, rigid, no tension, Coulomb friction with associated flow"),
        ],
    )
    return ExitCode.DONE


def _results(resistance: LateralResistance) -> tuple[LimitResult, LimitResult]:
    return resistance.left, resistance.right


def _words(result: LimitResult) -> str:
    if result.alpha is None:
        return f"{result.status}: {result.message}"
    moving = _moving(result)
    blocks = ", ".join(map(str, moving[:8])) + (" …" if len(moving) > 8 else "")
    return f"alpha = {result.alpha:.4f} (load multiplier, adequacy factor); moving: {blocks}"


def _moving(result: LimitResult) -> list[int]:
    """Return the blocks that move in the mechanism, the fastest first."""
    if result.mechanism is None:
        return []
    speed = abs(result.mechanism.velocity).max(axis=1)
    order = sorted(range(len(speed)), key=lambda k: (-round(float(speed[k]), 9), k))
    return [result.mechanism.block_ids[k] for k in order if speed[k] > 1e-6]


def _report(model: RigidBlockModel, resistance: LateralResistance) -> dict[str, Any]:
    mechanisms = {
        direction: {
            str(block): [float(v) for v in velocity]
            for block, velocity in zip(
                result.mechanism.block_ids, result.mechanism.velocity, strict=True
            )
        }
        for direction, result in zip(_DIRECTIONS, _results(resistance), strict=True)
        if result.mechanism is not None
    }
    return {
        "status_left": str(resistance.left.status),
        "status_right": str(resistance.right.status),
        "alpha_left": resistance.left.alpha,
        "alpha_right": resistance.right.alpha,
        "F_LR": resistance.value,
        "mu": model.mu,
        "blocks": len(model.blocks),
        "contacts": model.contact_count,
        "mechanism": mechanisms,
    }


def _draw(wall: GivenWall, resistance: LateralResistance, folder: Path, *, overwrite: bool) -> None:
    if wall.labels is None:
        print("drystone: a block model has no image to draw", file=sys.stderr)
        return
    from drystone.plotting import plot_labels, plot_mechanism, save  # noqa: PLC0415 - slow import
    from drystone.plotting.files import MECHANISMS  # noqa: PLC0415

    picture = folder / "wall_picture.png"
    mechanisms = [folder / MECHANISMS[direction] for direction in _DIRECTIONS]
    prepare_files([picture, *mechanisms], overwrite=overwrite)
    save(plot_labels(wall.labels).figure, picture)
    for path, result in zip(mechanisms, _results(resistance), strict=True):
        if result.mechanism is not None:
            axes = plot_mechanism(wall.labels, result.mechanism, result.direction, result.alpha)
            save(axes.figure, path)
        else:
            # One that an earlier run left would belong to another wall.
            path.unlink(missing_ok=True)
