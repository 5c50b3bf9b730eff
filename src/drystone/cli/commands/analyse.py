"""`drystone analyse`: limit analysis of any wall."""

import argparse
import hashlib
import sys
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from drystone.cli.analyse_pictures import draw, prepare
from drystone.cli.analyse_scatter import scatter_of, wants_scatter
from drystone.cli.card import Card, range_report, range_rows
from drystone.cli.loads import is_range, load_case
from drystone.cli.modelling import Modelled, modelled
from drystone.cli.output import print_json, print_table
from drystone.cli.walls import read_wall, unsupported
from drystone.errors import ExitCode, Notice
from drystone.statics.failure import save_program
from drystone.statics.limit import lateral_resistance, load_range
from drystone.statics.loads import Loads
from drystone.statics.mechanism import Failure, describe_mechanism
from drystone.statics.nonassociative import nonassociative_resistance
from drystone.statics.result import LateralResistance, LimitResult, LimitStatus
from drystone.statics.sensitivity import friction_sensitivity


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print load multipliers and mechanisms; draw contacts, forces and mechanisms when asked."""
    path = Path(arguments.wall_path)
    wall = modelled(read_wall(path), arguments)
    for notice in wall.notices:
        print(f"drystone: {notice}", file=sys.stderr)
    folder = None if arguments.output is None else Path(arguments.output)
    pictures = [] if folder is None else prepare(folder, arguments)
    if is_range(arguments):
        return _print_range(wall, arguments)
    model, loads = load_case(arguments, wall.model)
    resistance = lateral_resistance(model, loads, mechanism=True, solver=arguments.solver)
    loose = None if resistance.stable else unsupported(model)
    if loose is not None:
        print(f"drystone: {loose}", file=sys.stderr)
    if folder is not None:
        draw(pictures, wall, loads, resistance)
    card = _card(path, wall, loads, resistance, arguments)
    scatter = scatter_of(wall, arguments, folder) if wants_scatter(arguments) else None
    if arguments.json:
        report = card.report()
        print_json(report if scatter is None else {**report, "scatter": scatter.report()})
    else:
        title = f"{path}: {len(model.blocks)} blocks, {model.contact_count} contact points"
        print_table(title, card.rows() + ([] if scatter is None else scatter.rows()))
    return _keep_failure(wall, loads, resistance, folder)


def _card(
    path: Path,
    wall: Modelled,
    loads: Loads,
    resistance: LateralResistance,
    arguments: argparse.Namespace,
) -> Card:
    both = (resistance.left, resistance.right)
    sensitivity: dict[str, float] = {
        result.direction: friction_sensitivity(wall.model, result, loads).total
        for result in both
        if result.success
    }
    without = None
    if not arguments.associative_only:
        without = nonassociative_resistance(wall.model, loads=loads)
    return Card(
        model=wall.model,
        load_case=loads.name,
        resistance=resistance,
        nonassociative=without,
        failures=_failures(wall, both),
        sensitivity=sensitivity,
        sha256=hashlib.sha256(_file(path).read_bytes()).hexdigest(),
        version=version("drystone"),
        remarks=wall.remarks,
    )


def _file(path: Path) -> Path:
    return path / "plan.json" if path.is_dir() else path


def _failures(wall: Modelled, results: tuple[LimitResult, ...]) -> Mapping[str, Failure]:
    return {
        result.direction: describe_mechanism(
            wall.model,
            result.mechanism,
            falls=result.status is LimitStatus.UNSTABLE,
            noun=wall.noun,
            wedges=wall.wedge_ids,
        )
        for result in results
        if result.mechanism is not None
    }


def _print_range(wall: Modelled, arguments: argparse.Namespace) -> ExitCode:
    model, loads = load_case(arguments, wall.model)
    found = load_range(model, loads, mechanism=True, solver=arguments.solver)
    if arguments.json:
        print_json(range_report(found, loads.name))
    else:
        rows = range_rows(found, loads.name)
        if found.least.mechanism is not None:
            told = describe_mechanism(
                model, found.least.mechanism, noun=wall.noun, wedges=wall.wedge_ids
            )
            rows.insert(2, ("  mechanism", told.words))
        print_table(f"{arguments.wall_path}: {len(model.blocks)} blocks", rows)
    return ExitCode.DONE


def _keep_failure(
    wall: Modelled, loads: Loads, resistance: LateralResistance, folder: Path | None
) -> ExitCode:
    """Save the program that no solver could solve (E140)."""
    if not resistance.failed:
        return ExitCode.DONE
    path = (folder or Path()) / "drystone-failed.npz"
    save_program(wall.model, loads, path)
    said = Notice(
        "E140",
        "no solver found an answer that can be certified.",
        f"Please report it with {path}, the linear program.",
    )
    print(f"drystone: {said}", file=sys.stderr)
    return ExitCode.CHECK_FAILED
