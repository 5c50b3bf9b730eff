"""`drystone analyse`: limit analysis of any wall."""

import argparse
import hashlib
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np

from drystone.cli import numbers
from drystone.cli.inputs import files_of_wall, plan_file, refuse_inputs, refuse_plans_own
from drystone.cli.output import note, prepare_files, print_json, print_table
from drystone.cli.progress import busy, counting_bar
from drystone.cli.reading import add_wall, reading_from
from drystone.drawing.words import analysis, modelling
from drystone.errors import ExitCode, Notice, UsageError, counted
from drystone.io.walls import GivenWall, read_wall, unsupported
from drystone.model.builder import BuilderErrors
from drystone.statics.limit import lateral_resistance, load_range
from drystone.statics.loads import LoadCase, load_case
from drystone.statics.lp.program import assemble
from drystone.statics.scatter.scatter import ScatterSettings, scatter

SAMPLES = 200


def add(command: argparse.ArgumentParser) -> None:
    """Add what touches what and how rough it is, the loads, and the scatter of F_LR."""
    add_wall(command)
    numbers.add_scale(command)
    # fmt: off
    option = command.add_argument_group("model").add_argument
    option("--mu", type=numbers.friction, metavar="MU",
           help="coefficient of friction (default 0.58); LOW:HIGH for a random one in between")
    option("--mu-head", type=numbers.not_negative, metavar="MU",
           help="of upright joints, 0 for open ones")
    option("--contacts", choices=["pixels", "outlines"], default="pixels",
           help="find contacts on pixels (default) or on smooth outlines")
    option("--close-gaps", metavar="PX|auto|settle",
           help="treat stones closer than PX as touching; auto finds a width; settle lowers stones "
           "until they touch")
    option("--solver", choices=["auto", "highs", "highs-ipm", "clarabel"], default="auto",
           help="for the associative load multiplier (default: chosen by the number of blocks)")
    option("--associative-only", action="store_true",
           help="skip the load multiplier without dilatancy, which takes longer")
    group = command.add_argument_group("loads (the wall bears its weight, and alpha times ...)")
    option = group.add_argument
    # A table may be called by its motion.
    option("--load", type=lambda text: "tilting" if text == "tilt" else text, default="tilting",
           choices=["tilting", "height", "points", "gravity"],
           help="sideways as on a tilting table (default), growing with height, the --live forces, "
           "or more weight with the --dead forces held")
    option("--tilt", type=numbers.finite, default=0.0, metavar="DEG",
           help="turn gravity by this towards the right first")
    for name, text in (("--dead", "constant force"), ("--live", "force that grows with alpha")):
        option(name, action="append", default=[], metavar="ID@X,Y:FX,FY",
               help=f"{text}, on block ID at (x, y) of the wall frame, up is positive; repeatable")
    option("--settle", type=int, metavar="ID", help="lower the fixed block ID: its reaction")
    option = command.add_argument_group("scatter of the load multiplier (Monte Carlo)").add_argument
    option("--scatter", type=numbers.whole_from(1), metavar="N", help="samples (default 200)")
    option("--precision", type=_precision, metavar="P%",
           help="noise of a builder: outlines P/2, places P of the mean stone size (a robot 1.5%%, "
           "a hand 3%%)")
    for name, text in (("outline", "the outlines"), ("placement", "where stones lie")):
        option(f"--{name}-noise", type=numbers.not_negative, default=0.0, metavar="PX",
               help=f"standard deviation of {text} (of a block model: in its lengths)")
    option("--seed", type=numbers.whole_from(0), default=0,
           help="of the random choices (default 0)")
    option("--jobs", type=numbers.whole_from(1), default=1, metavar="N", help="number of processes")


def _precision(text: str) -> float:
    if not text.endswith("%"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a precision such as 1.5%")
    return numbers.not_negative(text[:-1]) / 100


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print load multipliers and mechanisms; draw contacts, forces and mechanisms when asked."""
    case = LoadCase(
        arguments.load, arguments.tilt, arguments.dead, arguments.live, arguments.settle
    )
    asked = modelling.ModelRequest(
        arguments.mu, arguments.mu_head, arguments.contacts, arguments.close_gaps, case
    )
    shaken = _wants_scatter(arguments)
    if shaken and not case.is_plain:
        raise UsageError("E138", "the scatter is of the tilting table.", cure="Leave loads out.")
    path = Path(arguments.wall_path)
    given = read_wall(path, reading_from(arguments))
    wall = modelling.modelled(given, asked, arguments.wall_path)
    per_unit_m = _metres_per_unit(given, arguments)
    few = modelling.scarcity(wall, per_unit_m)
    note(*wall.notices, few)
    size = modelling.size_words(wall.shapes, per_unit_m)
    if size is not None:
        wall = replace(wall, remarks={**wall.remarks, "size": size})
    folder = None if arguments.output is None else Path(arguments.output)
    if folder is not None:
        written = [folder / name for name in analysis.WRITTEN]
        refuse_inputs(files_of_wall(path), written)
        refuse_plans_own(path, written)
        prepare_files(written, overwrite=arguments.overwrite)
    model, loads = load_case(case, wall.model)
    far = modelling.far_forces(wall, given, case, per_unit_m)
    note(far)
    wall = replace(wall, model=model, notices=(*wall.notices, *filter(None, (few, far))))
    solver = arguments.solver
    sha256 = hashlib.sha256(plan_file(path).read_bytes()).hexdigest()
    counts = counted(len(model.blocks), "block")
    card: analysis.RangeCard
    if case.is_range:
        found = load_range(model, loads, solver=solver)
        card = analysis.RangeCard(
            wall, loads.name, {"least": found.least, "greatest": found.greatest}, sha256
        )
    else:
        counts += f", {counted(model.contact_count, 'contact point')}"
        resistance = lateral_resistance(model, loads, mechanism=True, solver=solver)
        swept = wall.sweep is not None
        note(None if resistance.stable else unsupported(model, given, swept=swept))
        said = "without dilatancy (skip: --associative-only)"
        with busy(said, quiet=arguments.json, after_s=2.0):
            card = analysis.analysis_of(
                wall, loads, resistance, sha256, associative_only=arguments.associative_only,
                solver=solver,
            )  # fmt: skip
    if folder is not None:
        from drystone.drawing.report.analysis import write_analysis  # noqa: PLC0415 - slow import

        with busy("drawing", quiet=arguments.json, after_s=2.0):
            write_analysis(folder, card, loads, per_unit_m)
    report, rows = card.report(), card.rows()
    if wall.sweep is not None:
        report["gaps"] = modelling.sweep_report(wall.sweep)
    if shaken:
        scattered = _scatter_of(wall, arguments, given)
        report, rows = {**report, "scatter": scattered.report()}, rows + scattered.rows()
    if arguments.json:
        print_json(report)
    else:
        print_table(f"{path}: {counts}", rows)
    if card.failed:
        program = (folder or Path()) / "drystone-failed.npz"
        assemble(model, loads).save(program)
        what = "no solver found an answer that can be certified."
        note(Notice("E140", what, f"Please report it with {program}, the linear program."))
    return ExitCode.DONE if card.stands and not card.failed else ExitCode.CHECK_FAILED


def _metres_per_unit(wall: GivenWall, arguments: argparse.Namespace) -> float | None:
    """Return how long a unit of the model is; None when nobody knows.

    E131 when the options give another scale than the plan has; E138 for a ruler that lies beyond
    the picture.
    """
    numbers.refuse_outside(arguments.px_per_m, numbers.wall_picture_px(wall))
    plan, px_per_m = wall.plan, numbers.wall_scale(arguments.px_per_m, wall)
    if px_per_m is None:
        return None
    if plan is None:
        return 1.0 / px_per_m
    if wall.blocks is not None:
        return 1.0 if plan.length_unit == "m" else 1.0 / px_per_m
    return 1.0 / (px_per_m * plan.working_scale)


def _wants_scatter(arguments: argparse.Namespace) -> bool:
    """Whether there is something that varies; E138 when samples would all be the same wall."""
    mu = arguments.mu
    noise = arguments.precision, arguments.outline_noise, arguments.placement_noise
    varied = any(noise) or bool(mu and mu[0] < mu[1])
    if arguments.scatter is not None and not varied:
        what, given = "all samples would be the same wall.", "--outline-noise or --placement-noise"
        cure = f"Say what is not known: --mu LOW:HIGH, {given}, or --precision."
        raise UsageError("E138", what, where="--scatter", cure=cure)
    return varied


def _scatter_of(
    wall: analysis.ModelledWall, arguments: argparse.Namespace, given: GivenWall
) -> analysis.ScatterCard:
    """Shake the wall and analyse it each time; draw the distribution into the folder."""
    unit = analysis.noise_unit(given)
    lengths = unit[1]
    # What is fixed, such as a footing, is no stone.
    areas = (b.area for b in wall.model.blocks if not (b.fixed or b.id in given.wedge_ids))
    size = float(np.mean(np.sqrt(list(areas))))
    errors = BuilderErrors.of_precision(arguments.precision or 0.0, size)
    settings = ScatterSettings(
        samples=SAMPLES if arguments.scatter is None else arguments.scatter,
        mu=arguments.mu,
        outline_noise=arguments.outline_noise * lengths or errors.outline,
        placement_noise=arguments.placement_noise * lengths or errors.placement,
    )
    path = None if arguments.output is None else Path(arguments.output) / analysis.SCATTER
    if path is not None:
        prepare_files([path], overwrite=arguments.overwrite)
    jobs = arguments.jobs
    bar = counting_bar("walls", settings.samples, quiet=arguments.json)
    with bar as on_sample, ThreadPoolExecutor(jobs) if jobs > 1 else nullcontext() as executor:
        found = scatter(
            wall.model, settings, seed=arguments.seed, executor=executor, on_sample=on_sample
        )
    if path is not None:
        from drystone.drawing import plot_scatter, save  # noqa: PLC0415 - slow import

        save(plot_scatter(found).figure, path)
    return analysis.ScatterCard(found, unit)
