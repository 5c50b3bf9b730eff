"""`drystone markers`: sheets that give photographs a scale."""

import argparse
from pathlib import Path

from drystone.cli.numbers import whole_from
from drystone.cli.output import prepare_files, print_json
from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.errors import ExitCode, UsageError, counted
from drystone.photo.layout import FIRST_SHEET, ON_A_SHEET, parse_size_m


def add(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a sheet of markers."""
    # fmt: off
    option = command.add_argument
    option("-o", "--output", default="markers.pdf", metavar="SHEET.pdf",
           help="file to write (default markers.pdf)")
    option("--overwrite", action="store_true", help="replace the file")
    option("--size", metavar="LENGTH",
           help="side of a black square (default 50mm; with --single 120mm)")
    option("--dictionary", choices=["aruco", "apriltag"], default="aruco",
           help="family of the markers: ArUco 4x4 (default) or AprilTag 36h11")
    option("--page", choices=["A4", "A3", "letter"], default="A4", help="paper (default A4)")
    option("--single", action="store_true",
           help="one large marker a page, to lie anywhere (use two or more)")
    option("--count", type=whole_from(1), metavar="N",
           help="markers: four make a sheet (default 4; with --single 2)")
    option("--ids", type=whole_from(0), default=0, metavar="FIRST",
           help="number of the first marker, 0, 4, 8 ... for sheets (default 0)")
    option("--json", action="store_true", help="print as JSON")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Write the sheets and say how to name them when stones are looked for."""
    path = Path(arguments.output)
    if path.suffix.lower() != ".pdf":
        what = "marker sheets are written as .pdf."
        raise UsageError("E139", what, where=str(path), cure="Choose another ending.")
    single = arguments.single
    count = arguments.count or (2 if single else ON_A_SHEET)
    if not single and (count % ON_A_SHEET or arguments.ids % ON_A_SHEET):
        what = "a sheet has four markers, and the first is 0, 4, 8 and so on."
        cure = "Give multiples of 4, or --single."
        raise UsageError("E174", what, where="--count, --ids", cure=cure)
    size_m = parse_size_m(arguments.size or ("120mm" if single else "50mm"), "--size")
    ids = tuple(range(arguments.ids, arguments.ids + count))
    sheets = MarkerSheets(ids, size_m, arguments.dictionary, arguments.page, single)
    prepare_files([path], overwrite=arguments.overwrite)
    write_marker_sheets(sheets, path)
    size = f"{size_m * 1000:g}mm"
    named = size if single else f"{sheets.page}:{size}"
    options = ["--aruco", named]
    if not single and ids != FIRST_SHEET:
        options += ["--marker-ids", *map(str, ids)]
    if arguments.json:
        told = {
            "file": str(path),
            "pages": len(sheets.pages),
            "ids": list(ids),
            "size_m": size_m,
            "dictionary": sheets.dictionary,
            "page": sheets.page,
            "layout": named,
            "options": options,
        }
        print_json(told)
        return ExitCode.DONE
    print(f"{path}: markers {ids[0]} to {ids[-1]}, {counted(len(sheets.pages), 'page')}")
    print(f"Print at 100 %. Then: drystone segment PHOTO {' '.join(options)} -o DIR")
    return ExitCode.DONE
