"""`drystone rehearse`: build a plan again and again, each time with a builder's errors."""

import argparse
import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from drystone.cli.inputs import files_of_wall, refuse_inputs
from drystone.cli.numbers import METRES, friction, whole_from
from drystone.cli.output import prepare_picture, print_json, print_table
from drystone.cli.progress import counting_bar
from drystone.contacts.given import polygons_from_json
from drystone.drawing.words.checked import Rehearsed
from drystone.errors import ExitCode, PlanError, UsageError
from drystone.io.walls import GivenWall, read_wall
from drystone.model.builder import BuilderErrors
from drystone.model.plan import Plan
from drystone.model.steps import grouped, piece_id
from drystone.physics.table import load_engine
from drystone.search.closed_loop import rehearse_closed
from drystone.search.rehearsal import Groups, mean_size, rehearse, rehearse_in_engine, tilt_as_built

_PART = re.compile(r"(\d+(?:\.\d*)?|\.\d+)(px|mm|cm|m|ft|in|deg|%)")

NOTHING = BuilderErrors(placement=0.0, angle_deg=0.0, outline=0.0)


def add(command: argparse.ArgumentParser) -> None:
    """Add the plan, the errors, and where results go."""
    # fmt: off
    option = command.add_argument
    option("wall_path", metavar="PLAN.json", help="plan on outlines, or its folder")
    option("--precision", type=_parts, default="3%", metavar="P%|LENGTH,ANGLE",
           help="how precisely stones are put down, one standard deviation: a share of the mean "
           "stone size (a good robot 1.5%%, a hand 3%%: default), or such as 5mm,1deg")
    option("--outline", type=_parts, metavar="LENGTH",
           help="how precisely outlines are known (default: half the precision)")
    option("--mu", type=friction, metavar="MU",
           help="coefficient of friction (default that of the plan); LOW:HIGH for one of each run")
    option("--runs", type=whole_from(1), default=50, metavar="N", help="default 50")
    option("--seed", type=whole_from(0), default=0)
    option("--closed-loop", action="store_true",
           help="look at the wall after every stone and plan the rest again")
    option("--physics", action="store_true",
           help="build in a rigid-body engine, which takes longer (extra `physics`); with "
           "--closed-loop it tilts the finished walls")
    option("-o", "--output", metavar="FILE.png",
           help="draw the wall, every stone in the colour of its risk")
    option("--overwrite", action="store_true", help="replace the picture")
    option("--json", action="store_true", help="print as JSON")


def _parts(text: str) -> dict[str, float]:
    found = [_PART.fullmatch(part.strip()) for part in text.split(",")]
    parts = {one[2]: float(one[1]) for one in found if one}
    if len(parts) < len(found):
        raise argparse.ArgumentTypeError(f"{text!r} is not like 1.5%, 5mm,1deg or 2mm")
    return parts


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print how the runs ended; 5 when the wall falls even as it is planned."""
    path = Path(arguments.wall_path)
    if arguments.output:
        prepare_picture(Path(arguments.output), overwrite=arguments.overwrite)
        refuse_inputs(files_of_wall(path), [Path(arguments.output)])
    if arguments.physics:
        load_engine()
    wall = read_wall(path)
    plan, groups = _planned(wall, arguments.wall_path)
    errors = _errors(arguments, groups, plan.px_per_m)
    closed = arguments.closed_loop
    once = rehearse_closed if closed else rehearse_in_engine if arguments.physics else rehearse
    least, most = arguments.mu or (wall.mu, wall.mu)
    if min(most, wall.mu) == 0.0:
        cure = "Give a coefficient of friction above 0."
        raise UsageError("E138", "without friction no stone rests.", where="--mu", cure=cure)
    planned = once(groups, NOTHING, np.random.default_rng(0), mu=wall.mu)
    found = []
    with counting_bar("walls", arguments.runs, quiet=arguments.json) as on_run:
        for number in range(arguments.runs):
            rng = np.random.default_rng([arguments.seed, number])
            mu = np.random.default_rng([arguments.seed, number, 1]).uniform(least, most)
            ran = once(groups, errors, rng, mu=mu)
            tilts = closed and arguments.physics and ran.first_fall is None
            found.append(replace(ran, tilt=tilt_as_built(groups, ran, mu)) if tilts else ran)
            on_run(number + 1)
    engine = arguments.physics and not closed
    card = Rehearsed(plan, groups, errors, tuple(found), planned, engine=engine)
    if arguments.output:
        from drystone.drawing.canvas import save  # noqa: PLC0415 - slow import
        from drystone.drawing.pictures.check import plot_risk  # noqa: PLC0415

        save(plot_risk(card).figure, Path(arguments.output))
    if arguments.json:
        print_json(card.report())
    else:
        print_table(f"{arguments.wall_path}: {card.verdict}", card.rows())
    return ExitCode.DONE if planned.first_fall is None else ExitCode.CHECK_FAILED


def _planned(wall: GivenWall, name: str) -> tuple[Plan, Groups]:
    """Return a plan, and its stones with their wedges, source px, in the order of placement."""
    plan = wall.plan
    if plan is None or wall.blocks is None:
        what = "only a plan on outlines can be rehearsed."
        cure = "Give one of `drystone plan`; plan one on pixels again, with --geometry exact."
        raise UsageError("E138", what, where=name, cure=cure)
    outlines, px = polygons_from_json(wall.blocks), plan.px_per_m or 1.0
    groups = [[piece_id(step) for step in steps] for steps in grouped(plan.steps)[0]]
    missing = [str(i) for ids in groups for i in ids if i not in outlines]
    if missing:
        what = f"the blocks.json beside it lacks {', '.join(missing)}."
        raise PlanError("E238", what, where=name, cure="Plan again, or see `drystone check`.")
    return plan, [[(i, outlines[i][:-1] * px) for i in ids] for ids in groups]


def _errors(arguments: argparse.Namespace, groups: Groups, px_per_m: float | None) -> BuilderErrors:
    """Return the errors that are asked for, source px; E131 for metres without a scale."""
    precision = arguments.precision

    def length(parts: dict[str, float], option: str) -> float:
        unit = next((unit for unit in parts if unit not in ("deg", "%")), None)
        if unit is None or len(parts) > 1 + ("deg" in parts and option == "--precision"):
            cure = "Give a share such as 1.5%, or a length and an angle such as 5mm,1deg."
            raise UsageError("E138", "that is not a precision.", where=option, cure=cure)
        if unit != "px" and px_per_m is None:
            cure = "Give px, or plan with --px-per-m or --ruler."
            raise UsageError("E131", "the plan has no scale.", where=option, cure=cure)
        return parts[unit] * (1.0 if unit == "px" else METRES[unit] * (px_per_m or 0.0))

    if set(precision) == {"%"}:
        errors = BuilderErrors.of_precision(precision["%"] / 100, mean_size(groups))
    else:
        placement = length(precision, "--precision")
        errors = BuilderErrors(
            placement=placement, angle_deg=precision.get("deg", 0.0), outline=0.5 * placement
        )
    if arguments.outline is None:
        return errors
    return replace(errors, outline=length(arguments.outline, "--outline"))
