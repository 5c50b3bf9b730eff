"""`drystone markers`: sheets that give photographs a scale."""

import argparse
from pathlib import Path

from drystone.cli.output import prepare_files, print_json
from drystone.drawing.pictures.marker_sheet import MarkerSheets, write_marker_sheets
from drystone.errors import ExitCode, UsageError
from drystone.photo.layout import FIRST_SHEET, ON_A_SHEET, parse_size_m


def run(arguments: argparse.Namespace) -> ExitCode:
    """Write the sheets and say how to name them when stones are looked for."""
    path = Path(arguments.output)
    if path.suffix.lower() != ".pdf":
        raise UsageError(
            "E139", "marker sheets are written as .pdf.", where=str(path),
            cure="Choose another ending.",
        )  # fmt: skip
    sheets = _sheets(arguments)
    prepare_files([path], overwrite=arguments.overwrite)
    write_marker_sheets(sheets, path)
    size = f"{sheets.size_m * 1000:g}mm"
    named = size if sheets.single else f"{sheets.page}:{size}"
    options = ["--aruco", named]
    if not sheets.single and sheets.ids != FIRST_SHEET:
        options += ["--marker-ids", *map(str, sheets.ids)]
    if arguments.json:
        print_json(
            {
                "file": str(path),
                "pages": len(sheets.pages),
                "ids": list(sheets.ids),
                "size_m": sheets.size_m,
                "dictionary": sheets.dictionary,
                "page": sheets.page,
                "layout": named,
                "options": options,
            }
        )
        return ExitCode.DONE
    print(f"{path}: markers {sheets.ids[0]} to {sheets.ids[-1]}, {len(sheets.pages)} page(s)")
    print(f"Print at 100 %. Stones are then looked for with {' '.join(options)}")
    return ExitCode.DONE


def _sheets(arguments: argparse.Namespace) -> MarkerSheets:
    single = arguments.single
    count = arguments.count or (2 if single else ON_A_SHEET)
    if not single and (count % ON_A_SHEET or arguments.ids % ON_A_SHEET):
        raise UsageError(
            "E174", "a sheet has four markers, and the first is 0, 4, 8 and so on.",
            where="--count, --ids", cure="Give multiples of 4, or --single.",
        )  # fmt: skip
    size_m = parse_size_m(arguments.size or ("120mm" if single else "50mm"))
    ids = tuple(range(arguments.ids, arguments.ids + count))
    return MarkerSheets(ids, size_m, arguments.dictionary, arguments.page, single)
