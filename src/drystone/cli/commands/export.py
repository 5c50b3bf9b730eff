"""`drystone export`."""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from drystone.cli import numbers
from drystone.cli.inputs import files_of_wall, plan_file, refuse_inputs
from drystone.cli.output import note, prepare_files, print_json
from drystone.cli.progress import busy
from drystone.drawing.assembly import DENSITY_KG_M3, read_assembly
from drystone.drawing.export.formats import FORMATS, ExportSettings, write_files
from drystone.errors import ExitCode, Notice, UsageError
from drystone.whole_files import refuse_existing

_PROJECTOR = re.compile(r"(\d+)x(\d+)@(\d+(?:\.\d*)?)")

CHANGED = {
    "px_per_m": " ".join(name for name in FORMATS if name not in ("gif", "mp4")),
    "thickness": "poses compas moveit urdf obj glb stl csv parquet geojson",
    "density": "poses compas urdf csv parquet geojson",
    "paper_scale": "pdf",
    "title": "dxf svg png pdf",
    "projector": "projector",
    "seconds_per_step": "gif mp4",
}
"""The formats that an option changes."""


def add(command: argparse.ArgumentParser) -> None:
    """Add formats and what shapes them."""
    # fmt: off
    option = command.add_argument
    option("plan", metavar="PLAN", nargs="?", help="plan.json, or its folder")
    option("--list", action="store_true", help="name the formats, one a line")
    option("--to", nargs="+", action="extend", default=[], metavar="FORMAT", choices=list(FORMATS),
           help=", ".join(FORMATS))
    option("-o", "--output", metavar="DIR",
           help="folder to add files to (default: beside the plan)")
    option("--overwrite", action="store_true", help="replace files of the same names")
    option("--json", action="store_true", help="print the files as JSON")
    numbers.add_scale(command)
    option = command.add_argument_group("stones").add_argument
    option("--thickness", type=numbers.positive, metavar="M",
           help="of the wall, metres (default: the side of a median stone)")
    option("--density", type=numbers.positive, metavar="KG",
           help="kg in a cubic metre of stone (default 2600)")
    option = command.add_argument_group("drawings and films").add_argument
    option("--paper-scale", type=numbers.positive, metavar="N",
           help="draw the build sheet at 1:N (default: the largest usual scale that fits)")
    option("--title", metavar="TEXT", help="in the title block")
    option("--projector", type=_projector, metavar="WxH@PX",
           help="pixels of the projector, and how many make a metre on the wall (1920x1080@1000)")
    option("--seconds-per-step", type=numbers.positive, metavar="S", help="of films (default 0.6)")


def _projector(text: str) -> dict[str, Any]:
    found = _PROJECTOR.fullmatch(text)
    if found is None or not (int(found[1]) and int(found[2]) and float(found[3])):
        message = f"{text!r} is not like 1920x1080@1000: its px, and how many are a metre"
        raise argparse.ArgumentTypeError(message)
    return {
        "projector_px": (int(found[1]), int(found[2])), "projector_px_per_m": float(found[3])
    }  # fmt: skip


def run(arguments: argparse.Namespace) -> ExitCode:
    """Write a plan in every format that is asked for; nothing is written when one cannot be."""
    if arguments.list:
        for name, one in FORMATS.items():
            print(f"{name}: {', '.join(one.writes)}: {one.text}")
        return ExitCode.DONE
    if arguments.plan is None or not arguments.to:
        cure = "drystone export out/plan.json --to svg pdf; --list names the formats."
        raise UsageError("E138", "a plan and a format are needed.", where="export", cure=cure)
    settings = _settings_from(arguments)
    path = Path(arguments.plan)
    density, thickness_m = arguments.density or DENSITY_KG_M3, arguments.thickness
    assembly = read_assembly(
        path, px_per_m=arguments.px_per_m, thickness_m=thickness_m, density_kg_m3=density
    )
    numbers.refuse_outside(arguments.px_per_m, numbers.picture_size_px(assembly.plan.source))
    asked, made = list(dict.fromkeys(arguments.to)), {}
    folder = Path(arguments.output) if arguments.output else plan_file(path).parent
    # What lies there is told before the work, as far as names are known.
    for place in (folder / name for one in asked for name in FORMATS[one].writes):
        if place.is_file():
            refuse_existing(place, overwrite=arguments.overwrite)
    with busy(quiet=arguments.json) as told:
        for name in asked:
            told(f"making {name}")
            made[name] = FORMATS[name].files(assembly, settings)
    names = [name for files in made.values() for name in files]
    paths = [folder / name for name in names]
    refuse_inputs(files_of_wall(path), paths)
    prepare_files(paths, overwrite=arguments.overwrite)
    written = {
        name: [str(file) for file in write_files(files, folder)] for name, files in made.items()
    }
    note(_left_over(folder, names))
    lengths, px_per_m = [stone.length for stone in assembly.stones], assembly.px_per_m
    if px_per_m is not None and lengths:
        note(numbers.scale_notice(median(lengths) * px_per_m, px_per_m))
    if any(FORMATS[name].metric for name in asked) and arguments.thickness is None:
        note(f"no --thickness: parts are {assembly.thickness:.3g} m thick")
    if arguments.json:
        print_json({"files": written})
        return ExitCode.DONE
    for name, files in written.items():
        print(f"{name}: {files[0]}{_and_more(files)}")
    return ExitCode.DONE


def _settings_from(arguments: argparse.Namespace) -> ExportSettings:
    """Return what drawings and films are made with; E138 for an option that changes nothing."""
    asked = arguments.to
    for name, formats in CHANGED.items():
        value = getattr(arguments, name)
        if value is not None and not {*asked} & {*formats.split()}:
            option = f"--{name.replace('_', '-')}"
            option = numbers.option_of(value) if name == "px_per_m" else option
            what = f"would do nothing with --to {' '.join(asked)}."
            cure = f"Leave it out; it is for {formats.replace(' ', ', ')}."
            raise UsageError("E138", what, where=option, cure=cure)
    names = ("paper_scale", "title", "seconds_per_step")
    given = {name: getattr(arguments, name) for name in names} | (arguments.projector or {})
    return ExportSettings(**{name: value for name, value in given.items() if value is not None})


def _left_over(folder: Path, names: Sequence[str]) -> Notice | None:
    """Name what lies in folders of this export and is not of it (W180).

    A projector shows all frames of its folder, those of an earlier wall with more steps as well.
    """
    places = {Path(name).parent for name in names} - {Path()}
    files = [file for place in places for file in (folder / place).iterdir() if file.is_file()]
    others = sorted({file.relative_to(folder).as_posix() for file in files} - set(names))
    if not others:
        return None
    what = f"not of this plan: {others[0]}{_and_more(others)}, in {folder}."
    return Notice("W180", what, "Remove them if they are old.")


def _and_more(names: Sequence[str]) -> str:
    return f" and {len(names) - 1} more" if len(names) > 1 else ""
