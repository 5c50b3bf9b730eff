"""`drystone trace`: a page on which a person draws the stones of a wall over its photograph."""

import argparse
from pathlib import Path

from drystone.cli.inputs import refuse_inputs
from drystone.cli.numbers import add_scale, refuse_outside
from drystone.cli.output import prepare_folder, print_table
from drystone.errors import ExitCode, InputError
from drystone.io.photo_beside import PAGE
from drystone.io.photo_file import read_photo
from drystone.io.read_stones import read_stones


def add(command: argparse.ArgumentParser) -> None:
    """Add what the page begins with."""
    # fmt: off
    option = command.add_argument
    option("photo", metavar="PHOTO", help="JPEG, PNG or TIFF of a wall, seen from the front")
    option("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    option("--overwrite", action="store_true", help="write into a folder with files")
    option("--proposals", metavar="FILE",
           help="outlines or masks of this photograph to begin with, such as those of SAM "
           "or cellpose")
    add_scale(command)


def run(arguments: argparse.Namespace) -> ExitCode:
    """Write the page, and say what to do with it."""
    from drystone.drawing.tracing.page import rings_of, write_outline_page  # noqa: PLC0415 - slow import

    path, folder = Path(arguments.photo), Path(arguments.output)
    asked = [path] if arguments.proposals is None else [path, Path(arguments.proposals)]
    refuse_inputs(asked, [folder / PAGE])
    photo = read_photo(path)
    width, height = photo.size_px
    refuse_outside(arguments.px_per_m, photo.size_px)
    rings, notices = {}, list(photo.notices)
    if arguments.proposals is not None:
        stones = read_stones(arguments.proposals)
        source = stones.source
        if (source.width_px, source.height_px) != (width, height):
            raise InputError(
                "E118",
                f"these are of a picture of {source.width_px} x {source.height_px} px, and the "
                f"photograph has {width} x {height}.",
                where=arguments.proposals,
                cure="Give outlines that were made on this photograph.",
            )
        rings = rings_of(stones, height)
        notices += stones.notices
    prepare_folder(folder, (PAGE,), overwrite=arguments.overwrite)
    page = folder / PAGE
    write_outline_page(
        page, photo.values, rings, title=f"Wall of {photo.name}", name=photo.name, kind="wall",
        proposed=True, px_per_m=arguments.px_per_m,
    )  # fmt: skip
    rows = [
        ("photograph", f"{width} x {height} px"),
        ("proposals", str(len(rings))),
        ("page", f"{page.stat().st_size / 1e6:.1f} MB, needs no network"),
        *(("notice", str(notice)) for notice in notices),
        ("next", "open it in a browser, draw the stones, the ground and a scale, and save"),
        ("then", "drystone analyse outlines.json"),
    ]
    print_table(str(page), rows)
    return ExitCode.DONE
