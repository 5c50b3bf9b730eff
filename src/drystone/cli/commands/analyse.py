"""`drystone analyse`: limit analysis of any wall."""

import argparse
import hashlib
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from drystone.cli.inputs import files_of_wall, refuse_inputs, refuse_plans_own
from drystone.cli.numbers import finite, friction, not_negative, whole_from
from drystone.cli.output import prepare_files, print_json, print_table
from drystone.cli.progress import counting_bar
from drystone.cli.reading import add_wall
from drystone.cli.scale import add_scale, refuse_outside, scale_with, wall_picture_px
from drystone.drawing.words.analysis import (
    Card,
    ModelledWall,
    NoiseUnit,
    RangeCard,
    ScatterCard,
    analysis_of,
    noise_unit,
)
from drystone.drawing.words.modelling import ModelRequest, modelled, scarcity, size_words
from drystone.drawing.words.tables import NAMES as TABLES
from drystone.drawing.words.tables import write_tables
from drystone.errors import ExitCode, Notice, UsageError
from drystone.io.walls import GivenWall, read_wall, unsupported
from drystone.statics.limit import lateral_resistance, load_range
from drystone.statics.loads import LoadCase, Loads, load_case
from drystone.statics.lp.program import assemble
from drystone.statics.model import RigidBlockModel
from drystone.statics.result import LimitStatus
from drystone.statics.scatter.scatter import scatter
from drystone.statics.scatter.shaking import ScatterSettings

FRICTION, REPORT, SCATTER = "friction.png", "report.html", "scatter.png"
SAMPLES = 200


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    add_wall(command)
    add_scale(command)
    _add_model(command)
    _add_loads(command)
    _add_scatter(command)


def _add_model(command: argparse.ArgumentParser) -> None:
    """Add the options that say what touches what, and how rough it is."""
    group = command.add_argument_group("model")
    group.add_argument(
        "--mu", type=friction, metavar="MU",
        help="coefficient of friction (default .58); LOW:HIGH gives the scatter between them",
    )  # fmt: skip
    group.add_argument(
        "--mu-head", type=not_negative, metavar="MU", help="of head joints, 0 for open ones"
    )
    group.add_argument(
        "--contacts", choices=["pixels", "outlines"], default="pixels",
        help="from the edges of pixels (default), or from sub-pixel outlines",
    )  # fmt: skip
    group.add_argument(
        "--close-gaps", metavar="PX|settle",
        help="gaps up to PX between drawn stones bear, or stones are lowered until they touch",
    )  # fmt: skip
    group.add_argument(
        "--solver",
        choices=["auto", "highs", "highs-ipm", "clarabel"],
        default="auto",
        help="of the associative load multiplier and its certificate (default auto: by the number"
        " of blocks, and another one when a certificate fails)",
    )
    group.add_argument(
        "--associative-only", action="store_true",
        help="leave out the load multiplier without dilatancy, which takes longer",
    )  # fmt: skip


def _add_scatter(command: argparse.ArgumentParser) -> None:
    """Add the options of the scatter of F_LR."""
    group = command.add_argument_group("scatter of the load multiplier (Monte Carlo)")
    group.add_argument("--scatter", type=whole_from(1), metavar="N", help="samples (default 200)")
    group.add_argument(
        "--outline-noise", type=not_negative, default=0.0, metavar="PX",
        help="standard deviation of the outlines (of a block model: in its lengths)",
    )  # fmt: skip
    group.add_argument(
        "--placement-noise", type=not_negative, default=0.0, metavar="PX",
        help="standard deviation of where stones lie (of a block model: in its lengths)",
    )  # fmt: skip
    group.add_argument("--seed", type=whole_from(0), default=0)
    group.add_argument(
        "--jobs", type=whole_from(1), default=1, metavar="N", help="workers; never the result"
    )


def _add_loads(command: argparse.ArgumentParser) -> None:
    """Add the options that make up dead + alpha live."""
    group = command.add_argument_group("loads (dead load: weight; live load: alpha times ...)")
    group.add_argument(
        "--load", type=_load, choices=["tilting", "height", "points", "gravity"],
        default="tilting",
        help="weights sideways as on a tilting table (default), growing with height, the --live"
        " forces, or the weight itself with the --dead forces held",
    )  # fmt: skip
    group.add_argument(
        "--tilt", type=finite, default=0.0, metavar="DEG",
        help="gravity is turned by this towards the right already",
    )  # fmt: skip
    for name, text in (("--dead", "force that acts always"), ("--live", "force times alpha")):
        group.add_argument(
            name, action="append", default=[], metavar="ID@X,Y:FX,FY",
            help=f"{text}, on block ID at (x, y) of the wall frame, up is positive; repeatable",
        )  # fmt: skip
    group.add_argument(
        "--settle", type=int, metavar="ID", help="the fixed block ID gives way: its reaction"
    )


def _load(text: str) -> str:
    """Read `--load`; a table may be called by its motion."""
    return "tilting" if text == "tilt" else text


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print load multipliers and mechanisms; draw contacts, forces and mechanisms when asked."""
    case = LoadCase(
        arguments.load, arguments.tilt, arguments.dead, arguments.live, arguments.settle
    )
    asked = ModelRequest(
        arguments.mu, arguments.mu_head, arguments.contacts, arguments.close_gaps, case
    )
    if _wants_scatter(arguments) and not case.is_plain:
        raise UsageError("E138", "the scatter is that of the tilting table; leave loads out.")
    path = Path(arguments.wall_path)
    given = read_wall(path, background=arguments.background)
    wall = modelled(given, asked, arguments.wall_path)
    per_unit_m = _metres_per_unit(given, arguments)
    few = scarcity(wall, per_unit_m)
    if few is not None:
        wall = replace(wall, notices=(*wall.notices, few))
    for notice in wall.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    size = size_words(wall.shapes, per_unit_m)
    if size is not None:
        wall = replace(wall, remarks={**wall.remarks, "size": size})
    folder = None if arguments.output is None else Path(arguments.output)
    pictures = [] if folder is None else _prepare(folder, arguments)
    model, loads = load_case(case, wall.model)
    if case.is_range:
        return _print_range(replace(wall, model=model), loads, arguments, pictures)
    resistance = lateral_resistance(model, loads, mechanism=True, solver=arguments.solver)
    loose = None if resistance.stable else unsupported(model)
    if loose is not None:
        print(f"drystone: {loose}", file=sys.stderr)
    card = analysis_of(
        wall, loads, resistance, _sha256(arguments),
        associative_only=arguments.associative_only, solver=arguments.solver,
    )  # fmt: skip
    if folder is not None:
        _write_all(folder, pictures, wall, card, loads, per_unit_m)
    unit = noise_unit(given)
    shaken = _scatter_of(wall, arguments, unit, folder) if _wants_scatter(arguments) else None
    if arguments.json:
        report = card.report()
        print_json(report if shaken is None else {**report, "scatter": shaken.report()})
    else:
        title = f"{path}: {_many(model)}, {model.contact_count} contact points"
        print_table(title, card.rows() + ([] if shaken is None else shaken.rows()))
    if resistance.failed:
        return _keep_failure(model, loads, folder)
    return ExitCode.DONE if card.stands else ExitCode.CHECK_FAILED


def _write_all(
    folder: Path,
    pictures: list[Path],
    wall: ModelledWall,
    card: Card,
    loads: Loads,
    per_unit_m: float | None,
) -> None:
    """Write pictures, tables and the report."""
    from drystone.drawing.report.analysis import (  # noqa: PLC0415 - slow import
        draw_analysis,
        draw_friction,
        write_analysis,
    )

    ends = (card.resistance.left, card.resistance.right)
    _clear(folder)
    draw_analysis(pictures, wall, loads, ends)
    write_tables(folder, card.model, ends, per_unit_m)
    curve = draw_friction(folder, card.model, loads)
    write_analysis(folder / REPORT, wall, card, per_unit_m, curve)


def _many(model: RigidBlockModel) -> str:
    return f"{len(model.blocks)} block{'' if len(model.blocks) == 1 else 's'}"


def _sha256(arguments: argparse.Namespace) -> str:
    path = Path(arguments.wall_path)
    file = path / "plan.json" if path.is_dir() else path
    return hashlib.sha256(file.read_bytes()).hexdigest()


def _print_range(
    wall: ModelledWall, loads: Loads, arguments: argparse.Namespace, pictures: list[Path]
) -> ExitCode:
    model = wall.model
    found = load_range(model, loads, mechanism=True, solver=arguments.solver)
    ends = (found.least, found.greatest)
    card = RangeCard(
        found=found,
        mu=model.mu,
        load_case=loads.name,
        failures=wall.failures(ends),
        sha256=_sha256(arguments),
        version=version("drystone"),
        remarks=wall.remarks,
    )
    if pictures:
        from drystone.drawing.report.analysis import draw_analysis  # noqa: PLC0415 - slow import

        _clear(pictures[0].parent)
        draw_analysis(pictures, wall, loads, ends)
    if arguments.json:
        print_json(card.report())
    else:
        print_table(f"{arguments.wall_path}: {_many(model)}", card.rows())
    failed = any(end.status is LimitStatus.FAILED for end in ends)
    folder = pictures[0].parent if pictures else None
    return _keep_failure(model, loads, folder) if failed else ExitCode.DONE


def _keep_failure(model: RigidBlockModel, loads: Loads, folder: Path | None) -> ExitCode:
    """Save the program that no solver could solve (E140)."""
    path = (folder or Path()) / "drystone-failed.npz"
    assemble(model, loads).save(path)
    said = Notice(
        "E140",
        "no solver found an answer that can be certified.",
        f"Please report it with {path}, the linear program.",
    )
    print(f"drystone: {said}", file=sys.stderr)
    return ExitCode.CHECK_FAILED


def _metres_per_unit(wall: GivenWall, arguments: argparse.Namespace) -> float | None:
    """Return how long a unit of the model is; None when nobody knows.

    Raises
    ------
    UsageError
        E131 when the options give another scale than the plan has; E138 for a ruler that lies
        beyond the picture.
    """
    refuse_outside(arguments.px_per_m, wall_picture_px(wall))
    plan = wall.plan
    px_per_m = scale_with(arguments.px_per_m, None if plan is None else plan.px_per_m, "plan")
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
    varied = bool(arguments.outline_noise or arguments.placement_noise or (mu and mu[0] < mu[1]))
    if arguments.scatter is not None and not varied:
        raise UsageError(
            "E138",
            "all samples would be the same wall.",
            where="--scatter",
            cure="Say what is not known: --mu LOW:HIGH, --outline-noise or --placement-noise.",
        )
    return varied


def _scatter_of(
    wall: ModelledWall, arguments: argparse.Namespace, unit: NoiseUnit, folder: Path | None
) -> ScatterCard:
    """Shake the wall and analyse it each time; draw the distribution into the folder."""
    settings = ScatterSettings(
        samples=SAMPLES if arguments.scatter is None else arguments.scatter,
        mu=arguments.mu,
        outline_noise=arguments.outline_noise * unit.lengths,
        placement_noise=arguments.placement_noise * unit.lengths,
    )
    if folder is not None:
        prepare_files([folder / SCATTER], overwrite=arguments.overwrite)
    jobs = arguments.jobs
    bar = counting_bar("walls", settings.samples, quiet=arguments.json)
    with bar as on_sample, ThreadPoolExecutor(jobs) if jobs > 1 else nullcontext() as executor:
        found = scatter(
            wall.model, settings, seed=arguments.seed, executor=executor, on_sample=on_sample
        )
    if folder is not None:
        from drystone.drawing import plot_scatter, save  # noqa: PLC0415 - slow import

        save(plot_scatter(found).figure, folder / SCATTER)
    return ScatterCard(found, unit)


def _prepare(folder: Path, arguments: argparse.Namespace) -> list[Path]:
    """Make room for all pictures; refuse to write over files unless asked to."""
    names = ["contacts.png"]
    for direction in ("left", "right"):
        names += [f"{kind}_{direction}.png" for kind in ("mechanism", "forces")]
        names.append(f"mechanism_{direction}.gif")
    paths = [folder / name for name in names]
    wall, written = Path(arguments.wall_path), [*paths, *_others(folder)]
    refuse_inputs(files_of_wall(wall), written)
    refuse_plans_own(wall, written)
    prepare_files(written, overwrite=arguments.overwrite)
    return paths


def _clear(folder: Path) -> None:
    """Take out what an earlier run left and not every run writes: it belongs to another wall.

    Not before there is an answer to put in its place.
    """
    for path in _others(folder):
        path.unlink(missing_ok=True)


def _others(folder: Path) -> list[Path]:
    return [folder / name for name in (*TABLES, FRICTION, REPORT, SCATTER)]
