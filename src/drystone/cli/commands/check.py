"""`drystone check`: re-derive a wall and verify every claim of its plan."""

import argparse
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from drystone.cli import inputs
from drystone.cli.output import prepare_picture, print_json, print_table
from drystone.cli.progress import busy, counting_bar
from drystone.cli.reading import reading_of
from drystone.drawing.words.checked import PICTURE, Checked, PhysicsCard
from drystone.errors import ExitCode, InputError, PlanError
from drystone.io.files import file_bytes
from drystone.io.plan_json import read_plan
from drystone.io.read_stones import read_stones
from drystone.io.walls import read_blocks_of, read_image_of
from drystone.model.plan import Plan
from drystone.physics.building import build_up, tilt_of
from drystone.physics.table import load_engine
from drystone.verify.check import check_plan
from drystone.verify.lengths import plan_settings
from drystone.verify.outlines import plan_polygons


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    # fmt: off
    option = command.add_argument
    option("plan", metavar="PLAN", help="plan.json, or its folder")
    option("--stones", metavar="STONES", help="what the plan was made from, if it is not beside it")
    option("--physics", action="store_true",
           help="also build and tilt the wall in a physics engine (extra `physics`)")
    option("--picture", metavar="FILE.png",
           help="draw the result here (default: check.png beside the plan, if something fails)")
    option("--overwrite", action="store_true", help="replace the picture")
    option("--json", action="store_true", help="print as JSON")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print whether the plan holds, and each problem; draw what fails."""
    asked_picture = Path(arguments.picture) if arguments.picture else None
    if asked_picture is not None:
        prepare_picture(asked_picture, overwrite=arguments.overwrite)
    if arguments.physics:
        load_engine()
    path = inputs.plan_file(Path(arguments.plan))
    folder, plan = path.parent, read_plan(path)
    source = Path(arguments.stones) if arguments.stones else _find_stones(plan, folder)
    # Without a place of its own, what may be drawn, here or by another check before.
    read = (*inputs.files_of(source), *inputs.files_of_wall(path))
    inputs.refuse_inputs(read, [asked_picture or folder / PICTURE])
    if asked_picture is not None:
        inputs.refuse_among_masks(source, [asked_picture])
    # The image of a plan without stones is no picture of stones.
    labels = read_image_of(plan, folder) if plan.steps else None
    try:
        blocks: Any = read_blocks_of(plan, folder)
    except InputError as error:
        blocks = error.what  # of a damaged file; words are no block model
    stones = read_stones(source, settings=reading_of(plan.source))
    with busy("checking every step", quiet=arguments.json, after_s=2.0):
        report = check_plan(plan, stones, wall_labels=labels, blocks=blocks)
        polygons = plan_polygons(plan, stones)
    checked = Checked(plan, stones, report, polygons, asked_physics=arguments.physics)
    if arguments.physics:
        checked = replace(checked, physics=_physics_of(checked, quiet=arguments.json))
    picture = None
    if asked_picture is not None or not checked.ok:
        from drystone.drawing.pictures.check import draw_check  # noqa: PLC0415 - slow import

        picture = draw_check(checked, asked_picture, folder)
    if arguments.json:
        print_json({**checked.as_dict(), **({"picture": picture[0]} if picture else {})})
    else:
        drawn = [("picture", picture[1])] if picture else []
        print_table(
            f"{'OK' if checked.ok else 'FAILED'}: {path} {checked.verdict}", checked.rows() + drawn
        )
    return ExitCode.DONE if checked.ok else ExitCode.CHECK_FAILED


def _physics_of(checked: Checked, *, quiet: bool) -> PhysicsCard | None:
    """Build the wall in the engine and tilt it; None when some step places nothing."""
    plan, groups = checked.plan, checked.groups
    if sum(map(len, groups)) < len(plan.steps):
        return None
    settings, _ = plan_settings(plan)
    with counting_bar("stones in the engine", len(groups), quiet=quiet) as on_group:
        built = build_up(groups, settings.mu, on_group=on_group)
    return PhysicsCard(plan, checked.report, built, tilt_of(built))


def _find_stones(plan: Plan, folder: Path) -> Path:
    """Return the source file of a plan, beside it, above it, or where we are.

    A plan without a digest takes the first of its name; the check says what was not compared.
    """
    name, digest = str(plan.source["path"]), plan.source["sha256"]
    # The system's way up is right where the path has none, as in "."; the other follows no link.
    places = [folder, folder.parent, folder / "..", Path()]
    found = [place / name for place in places if name and (place / name).exists()]
    for path in found:
        if not digest or path.is_dir() or sha256(file_bytes(path)).hexdigest() == digest:
            return path
    what = f"the stones {name!r} that the plan was made from are not beside it."
    cure = "Say where they are with --stones."
    if not name:
        what = "the stones that the plan was made from were given by a program: no file is known."
        cure = "Write them as a label image, and say with --stones where it is."
    if found:
        what = f"{found[0]} is another file than the {name!r} that the plan was made from."
        cure = "Say where that is with --stones, or give this file there to check with it (E210)."
    raise PlanError("E202", what, where=str(folder), cure=cure)
