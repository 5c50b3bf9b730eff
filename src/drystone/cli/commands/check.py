"""`drystone check`: re-derive a wall and verify every claim of its plan."""

import argparse
from hashlib import sha256
from pathlib import Path

from drystone.cli.output import print_json, print_table
from drystone.cli.reading import reading_of
from drystone.cli.walls import read_image_of
from drystone.errors import ExitCode, PlanError
from drystone.io.plan_json import read_plan
from drystone.io.read_stones import read_stones
from drystone.model.plan import Plan
from drystone.verify.check import check_plan


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print whether the plan holds, and each problem."""
    path = Path(arguments.plan)
    if path.is_dir():
        path /= "plan.json"
    plan = read_plan(path)
    source = Path(arguments.stones) if arguments.stones else _find_stones(plan, path.parent)
    # The image of a plan without stones is no picture of stones.
    labels = read_image_of(plan, path.parent) if plan.steps else None
    stones = read_stones(source, settings=reading_of(plan.source))
    report = check_plan(plan, stones, wall_labels=labels)
    if arguments.json:
        print_json(report.as_dict())
    else:
        print_table(
            f"{path}: {'holds' if report.ok else 'does not hold'}",
            [
                ("stones", f"{len(plan.stone_steps)} placed, {len(plan.wedge_steps)} wedges"),
                ("overlap", f"{report.overlap_depth:.2f} source px deep by the outlines"),
                ("area", f"the pixels of a stone miss its area by {report.area_error:.1%} at most"),
                ("buried", ", ".join(map(str, report.buried)) or "none"),
                *[("note", note) for note in report.notes],
                *[("problem", str(problem)) for problem in report.problems],
            ],
        )
    return ExitCode.DONE if report.ok else ExitCode.CHECK_FAILED


def _find_stones(plan: Plan, folder: Path) -> Path:
    """Return the source file of a plan, beside it, above it, or where we are."""
    name = str(plan.source["path"])
    places = [folder, folder.parent, Path()]
    found = [place / name for place in places if name and (place / name).exists()]
    for path in found:
        if path.is_dir() or sha256(path.read_bytes()).hexdigest() == plan.source["sha256"]:
            return path
    raise PlanError(
        "E202",
        f"the stones {name!r} that the plan was made from are not beside it.",
        where=str(folder),
        cure="Say where they are with --stones.",
    )
