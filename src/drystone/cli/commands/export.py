"""`drystone export`."""

import argparse
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from drystone.cli.inputs import files_of_wall, refuse_inputs
from drystone.cli.numbers import positive
from drystone.cli.output import make_folder, prepare_files, print_json
from drystone.cli.scale import add_scale, planned_picture_px, refuse_outside, scale_notice
from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.assembly.read import read_assembly
from drystone.drawing.export.formats import FORMATS, ExportSettings, write_files
from drystone.errors import ExitCode, Notice, UsageError

_PROJECTOR = re.compile(r"(\d+)x(\d+)@(\d+(?:\.\d*)?)")


def add(command: argparse.ArgumentParser) -> None:
    """Add formats and what shapes them."""
    command.add_argument("plan", metavar="PLAN.json", nargs="?", help="plan, or its folder")
    command.add_argument("--list", action="store_true", help="name the formats, one a line")
    command.add_argument(
        "--to", nargs="+", action="extend", default=[], metavar="FORMAT", choices=list(FORMATS),
        help=", ".join(FORMATS),
    )  # fmt: skip
    command.add_argument(
        "-o", "--output", metavar="DIR", help="folder to add files to (default: beside the plan)"
    )
    command.add_argument("--overwrite", action="store_true", help="replace files of the same names")
    command.add_argument("--json", action="store_true", help="print the files as JSON")
    add_scale(command)
    making = command.add_argument_group("stones")
    making.add_argument(
        "--thickness", type=positive, metavar="M", dest="thickness_m",
        help="of the wall, metres (default: the median square root of the stones' areas)",
    )  # fmt: skip
    making.add_argument(
        "--density", type=positive, metavar="KG", dest="density_kg_m3", default=2600.0,
        help="kg in a cubic metre of stone (default 2600)",
    )  # fmt: skip
    drawing = command.add_argument_group("drawings and films")
    drawing.add_argument(
        "--paper-scale", type=positive, default=10.0, metavar="N",
        help="the build sheet is drawn at 1:N (default 10, larger when the wall does not fit)",
    )  # fmt: skip
    drawing.add_argument("--title", default="", metavar="TEXT", help="in the title block")
    drawing.add_argument(
        "--projector", metavar="WxH@PX", default="1920x1080@1000",
        help="px of the projector and how many are a metre on the wall (1920x1080@1000)",
    )  # fmt: skip
    drawing.add_argument(
        "--seconds-per-step", type=positive, default=0.6, metavar="S", help="of films (default .6)"
    )


def run(arguments: argparse.Namespace) -> ExitCode:
    """Write a plan in every format that is asked for; nothing is written when one cannot be."""
    if arguments.list:
        for name, one in FORMATS.items():
            print(f"{name}: {', '.join(one.writes)}: {one.text}")
        return ExitCode.DONE
    if arguments.plan is None or not arguments.to:
        raise UsageError(
            "E138", "a plan and a format are needed.", where="export",
            cure="drystone export out/plan.json --to svg pdf; --list names the formats.",
        )  # fmt: skip
    settings = settings_from(arguments)
    path = Path(arguments.plan)
    assembly = read_assembly(
        path,
        px_per_m=arguments.px_per_m,
        thickness_m=arguments.thickness_m,
        density_kg_m3=arguments.density_kg_m3,
    )
    refuse_outside(arguments.px_per_m, planned_picture_px(assembly.plan.source))
    asked = list(dict.fromkeys(arguments.to))
    made = {name: FORMATS[name].files(assembly, settings) for name in asked}
    folder = Path(arguments.output) if arguments.output else _beside(path)
    names = [name for files in made.values() for name in files]
    refuse_inputs(files_of_wall(path), [folder / name for name in names])
    make_folder(folder)
    prepare_files([folder / name for name in names], overwrite=arguments.overwrite)
    written = {
        name: [str(file) for file in write_files(files, folder)] for name, files in made.items()
    }
    for said in _notices(assembly, folder, names):
        print(f"drystone: {said}", file=sys.stderr)
    if any(FORMATS[name].metric for name in asked) and arguments.thickness_m is None:
        said = f"no --thickness: parts are {assembly.thickness:.3g} m thick"
        print(f"drystone: {said}", file=sys.stderr)
    if arguments.json:
        print_json({"files": written})
    else:
        _print_files(written)
    return ExitCode.DONE


def _print_files(written: Mapping[str, Sequence[str]]) -> None:
    for name, files in written.items():
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        print(f"{name}: {files[0]}{more}")


def settings_from(arguments: argparse.Namespace) -> ExportSettings:
    """Return what the options say; E138 for a projector that is none."""
    found = _PROJECTOR.fullmatch(arguments.projector)
    if found is None or not (int(found[1]) and int(found[2]) and float(found[3])):
        raise UsageError(
            "E138", f"{arguments.projector!r} is no projector.", where="--projector",
            cure="Write 1920x1080@1000: its px, and how many of them are a metre on the wall.",
        )  # fmt: skip
    return ExportSettings(
        paper_scale=arguments.paper_scale,
        title=arguments.title,
        projector_px=(int(found[1]), int(found[2])),
        projector_px_per_m=float(found[3]),
        seconds_per_step=arguments.seconds_per_step,
    )


def _notices(assembly: Assembly, folder: Path, names: Sequence[str]) -> list[str]:
    found = _left_over(folder, names), _odd_scale(assembly)
    return [str(notice) for notice in found if notice is not None]


def _odd_scale(assembly: Assembly) -> Notice | None:
    """Say when the scale makes stones that nobody builds with (W123)."""
    lengths = [stone.length for stone in assembly.stones]
    if assembly.px_per_m is None or not lengths:
        return None
    return scale_notice(median(lengths) * assembly.px_per_m, assembly.px_per_m)


def _left_over(folder: Path, names: Sequence[str]) -> Notice | None:
    """Name what lies in folders of this export and is not of it (W180).

    A projector shows all frames of its folder, those of an earlier wall with more steps as well.
    """
    places = {Path(name).parent for name in names} - {Path()}
    found = {
        file.relative_to(folder).as_posix()
        for place in places
        for file in (folder / place).iterdir()
        if file.is_file()
    }
    others = sorted(found - set(names))
    if not others:
        return None
    more = f" and {len(others) - 1} more" if len(others) > 1 else ""
    return Notice(
        "W180", f"not of this plan: {others[0]}{more}, in {folder}.", "Remove them if they are old."
    )


def _beside(plan: Path) -> Path:
    return plan if plan.is_dir() else plan.parent
