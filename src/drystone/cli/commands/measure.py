"""`drystone measure`: the figures of merit of any wall."""

import argparse
from dataclasses import asdict, replace
from pathlib import Path

from drystone.cli import numbers
from drystone.cli.inputs import files_of_wall, refuse_inputs
from drystone.cli.output import note, prepare_files, print_json, print_table
from drystone.cli.progress import busy
from drystone.cli.reading import add_wall, reading_from
from drystone.contacts.blocks import model_from_labels, notices_of
from drystone.contacts.given import model_from_json
from drystone.drawing.words.content import figure_rows, number
from drystone.errors import ExitCode, UsageError, counted
from drystone.io.walls import GivenWall, read_wall, unsupported
from drystone.metrics.frame import frame_wall, reduce_labels
from drystone.metrics.measure import WallMetrics, measure_labels
from drystone.model.wall import Labels
from drystone.statics.limit import lateral_resistance


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    add_wall(command, "or ")
    # fmt: off
    option = command.add_argument
    option("--mu", type=numbers.not_negative, help="coefficient of friction (default 0.58)")
    option("--wall", metavar="WxH", help="size that the wall was to have: 280x80 (px) or 1.4mx0.4m")
    option("--scale", type=numbers.share, default=1.0, metavar="S",
           help="reduce the image by S first, 0 to 1")
    numbers.add_scale(command)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print F_SF, F_AV, F_AH, F_LR, T_LEVEL and E_FLUSH."""
    wall = read_wall(Path(arguments.wall_path), reading_from(arguments))
    if not wall.drawn and arguments.px_per_m is not None:
        asked = arguments.wall
        # Only a wall in metres is another one at another scale.
        if asked is None or numbers.parse_wall(asked, 1.0) == numbers.parse_wall(asked, 2.0):
            what = "would do nothing: no wall in metres is asked for, and no figure has a length."
            cure = "Leave it out, or give --wall in metres, as in 1.4mx0.4m."
            raise UsageError("E138", what, where=numbers.option_of(arguments.px_per_m), cure=cure)
    if wall.labels is None:
        cure = "Use `drystone analyse` or `drystone craft`, or give the plan that it stands beside."
        raise UsageError("E134", "a block model has no pixels.", where="measure", cure=cure)
    numbers.refuse_outside(arguments.px_per_m, numbers.wall_picture_px(wall))
    # Of the picture as it was given: reducing it may part what hangs together.
    pixels = wall.blocks is None and wall.outlines is None
    note(*wall.notices, *(notices_of(wall.labels) if pixels else ()))
    labels = reduce_labels(wall.labels, arguments.scale) if arguments.scale != 1 else wall.labels
    with busy("measuring the wall", quiet=arguments.json, after_s=2.0):
        metrics = _measured(wall, labels, arguments)
    if arguments.output is not None:
        whole = wall.plan is None and arguments.wall is None
        _draw(labels, None if whole else metrics.width, arguments)
    if arguments.json:
        print_json(asdict(metrics))
        return ExitCode.DONE
    height, width = labels.shape
    rows = [("F_SF", f"{number(metrics.F_SF)}  filling, higher is better"), *figure_rows(metrics)]
    rows.append(("wall", f"{metrics.width:g} x {metrics.height:g} px; joints are two px wide"))
    size = f"in a picture of {width} x {height} px"
    said = counted(metrics.stones, "stone")
    print_table(f"{arguments.wall_path}: {said}, {size}", rows)
    return ExitCode.DONE


def _measured(wall: GivenWall, labels: Labels, arguments: argparse.Namespace) -> WallMetrics:
    wall_px, stone_area_px = _size(wall, arguments)
    mu = wall.mu if arguments.mu is None else arguments.mu
    if wall.blocks is not None:  # pixels misread a wall of outlines
        model = replace(model_from_json(wall.blocks), mu=mu)
    else:
        model = model_from_labels(labels, mu).model
    resistance = lateral_resistance(model)
    if not resistance.stable:
        why = "The solver gave up." if resistance.failed else "The wall does not stand."
        note(f"F_LR is not defined. {unsupported(model, wall) or why} See drystone analyse.")
    return measure_labels(
        labels,
        wall_px=wall_px,
        wedge_ids=wall.wedge_ids,
        stone_area_px=stone_area_px,
        lateral_resistance=resistance.value,
    )


def _size(
    wall: GivenWall, arguments: argparse.Namespace
) -> tuple[tuple[float, float] | None, float | None]:
    """Return width and height of the wall, and the area of its stones, in px of what is measured.

    None is what the picture says itself.
    """
    plan = wall.plan
    scale = numbers.wall_scale(arguments.px_per_m, wall)
    asked = None if arguments.wall is None else numbers.parse_wall(arguments.wall, scale)
    if plan is None:
        return None if asked is None else _reduced(asked, arguments.scale), None
    to_source = plan.px_per_m or 1.0
    planned = plan.width * to_source, plan.height * to_source
    factor = plan.working_scale * arguments.scale
    # The pixels of reduced stones are off by a little; the plan knows their real area.
    stone_area_px = plan.metrics.F_SF * planned[0] * planned[1] * factor**2
    return _reduced(asked or planned, factor), stone_area_px


def _reduced(size_px: tuple[float, float], factor: float) -> tuple[float, float]:
    return size_px[0] * factor, size_px[1] * factor


def _draw(labels: Labels, width_px: float | None, arguments: argparse.Namespace) -> None:
    from drystone.drawing import plot_joint_paths, save  # noqa: PLC0415 - slow import
    from drystone.metrics import paths as joints  # noqa: PLC0415

    pictures = [Path(arguments.output) / f"paths_{name}.png" for name in ("F_AV", "F_AH")]
    refuse_inputs(files_of_wall(Path(arguments.wall_path)), pictures)
    prepare_files(pictures, overwrite=arguments.overwrite)
    framed = frame_wall(labels, width_px).labels
    joint = joints.joint_mask(framed)
    both = (joints.vertical_paths(joint), joints.horizontal_paths(joint))
    for picture, found in zip(pictures, both, strict=True):
        # The joint image has one more row and column of joint around the wall.
        paths = [path.pixels - 1 for path in found[:5]]
        save(plot_joint_paths(framed, paths).figure, picture)
