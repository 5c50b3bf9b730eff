"""`drystone segment`: stones in a photograph."""

import argparse
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from drystone.cli import numbers
from drystone.cli.inputs import refuse_inputs
from drystone.cli.output import note, prepare_folder, print_json, print_table
from drystone.cli.progress import busy
from drystone.errors import ExitCode, InputError, Notice, UsageError, counted
from drystone.io.patches import cut
from drystone.io.photo_beside import LABELS, PAGE, SIDECAR, PhotoSidecar, write_sidecar
from drystone.io.photo_file import Photo, read_photo
from drystone.io.wall_image import write_labels
from drystone.model.stone_size import StoneSize, median_sides, sizes_of
from drystone.photo.layout import MarkerLayout, parse_layout, parse_size_m
from drystone.photo.segment_doubts import (
    Doubt,
    doubts_of,
    notices_of,
    ruler_doubts,
    verdict_notices,
    verdict_of,
)
from drystone.photo.segment_photo import SegmentedPhoto, segment_photo
from drystone.photo.view import apply
from drystone.whole_files import write_whole

PHOTO, PREVIEW = "photo.jpg", "preview.png"
WRITTEN = (LABELS, PHOTO, SIDECAR, PREVIEW, PAGE)
QUALITY = 90
KEPT = ("source", "from_photo", "markers", "P_from_marker")
"""What the page saves beside the outlines."""


def add(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a photograph."""
    # fmt: off
    option = command.add_argument
    option("photo", metavar="PHOTO", help="JPEG, PNG or TIFF of stones laid out")
    option("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    option("--overwrite", action="store_true", help="write into a folder with files")
    numbers.add_scale(command)
    option = command.add_argument_group("markers (they correct the perspective too)").add_argument
    option("--aruco", metavar="MARKERS",
           help="A4 or A4:50mm: the sheet of `drystone markers`; 120mm: single markers")
    option("--marker-ids", nargs="+", type=numbers.whole_from(0), metavar="ID",
           help="ids of the markers to use (default: 0 to 3 of a sheet, all single ones)")
    option("--check-line", metavar="LENGTH",
           help="measured length of the 100 mm line on the printed sheet, such as 97mm or 3.82in")
    option = command.add_argument_group("stones").add_argument
    option("--ground", choices=["auto", "light", "dark"], default="auto",
           help="what the stones lie on (default: found by its colour)")
    option("--min-area", type=numbers.area, metavar="AREA",
           help="leave out smaller stones: px, or 12cm2 or 2in2 where the scale is given (default: "
           "a fiftieth of a usual one)")
    option("--no-split", action="store_false", dest="split", help="leave touching stones together")
    option("--mpx", type=numbers.positive, default=1.6, metavar="N",
           help="largest size of the result, million px (default 1.6)")
    command.add_argument("--json", action="store_true", help="print as JSON")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Find the stones of a photograph, write them, and say what is in doubt."""
    scale = scale_from(arguments)
    path, folder = Path(arguments.photo), Path(arguments.output)
    refuse_inputs([path], [folder / name for name in WRITTEN])
    photo = read_photo(path)
    numbers.refuse_outside(arguments.px_per_m, photo.size_px)
    min_area = arguments.min_area
    numbers.refuse_cm2(min_area, scale, "photograph", "--aruco, --px-per-m or --ruler")
    prepare_folder(folder, WRITTEN, overwrite=arguments.overwrite)
    ground, split, max_px = arguments.ground, arguments.split, round(arguments.mpx * 1e6)
    try:
        with busy("finding stones", quiet=arguments.json):
            result = segment_photo(
                photo.values, scale, ground=ground, min_area=min_area, split=split, max_px=max_px
            )
    except InputError as error:
        cures = *(notice.cure for notice in photo.notices), error.cure
        error.cure = " ".join(filter(None, cures))
        raise
    doubts = doubts_of(result.found, result.px_per_m)
    if isinstance(scale, numbers.Ruled):
        ends_px = apply(result.from_photo, np.array(scale.ends_px))
        doubts += ruler_doubts(result.found.labels, ends_px)
    against = verdict_of(result.found, doubts)
    said = (*photo.notices, *result.notices, *notices_of(doubts))
    notices = (*verdict_notices(against), *said)
    details = _details(photo, result, doubts, against)
    _write(folder, result, doubts, details)
    sizes = sizes_of(result.found.labels)
    if arguments.json:
        metres = None if result.px_per_m is None else 1.0 / result.px_per_m
        listed = [
            {
                "id": size.id, "x_px": round(size.at_px[0], 1), "y_px": round(size.at_px[1], 1),
                "area_px": size.area_px, "length_px": round(size.length_px, 1),
                "width_px": round(size.width_px, 1),
                "length_m": None if metres is None else round(size.length_px * metres, 4),
                "width_m": None if metres is None else round(size.width_px * metres, 4),
            }
            for size in sizes
        ]  # fmt: skip
        told = {"stones": len(sizes), "px_per_m": result.px_per_m, **details, "sizes": listed}
        print_json({**told, "notices": [str(notice) for notice in notices]})
    else:
        if against:
            print(f"doubtful: {'; '.join(against)}")
        _print(folder, result, sizes, notices)
    if result.px_per_m is None:
        note("No scale given, so sizes are in pixels. Add --aruco, --ruler or --px-per-m.")
    return ExitCode.CHECK_FAILED if against else ExitCode.DONE


def scale_from(arguments: argparse.Namespace) -> MarkerLayout | float | None:
    """Return the markers or the px in a metre that are given; E138 for both."""
    if arguments.aruco is None:
        for name in ("marker_ids", "check_line"):
            if getattr(arguments, name) is not None:
                what, option = "is about markers, and there are none.", name.replace("_", "-")
                cure = "Add --aruco, or leave it out."
                raise UsageError("E138", what, where=f"--{option}", cure=cure)
        scale: float | None = arguments.px_per_m
        return scale
    if arguments.px_per_m is not None:
        cure = "Give markers, or --px-per-m or --ruler."
        raise UsageError("E138", "the scale is given twice.", where="--aruco", cure=cure)
    line = "100mm" if arguments.check_line is None else arguments.check_line
    printed = parse_size_m(line, "--check-line") / 0.1
    ids = None if arguments.marker_ids is None else tuple(arguments.marker_ids)
    return parse_layout(arguments.aruco, ids, printed)


def _write(
    folder: Path, result: SegmentedPhoto, doubts: Sequence[Doubt], details: dict[str, Any]
) -> None:
    """Write stones.png, photo.jpg, stones.json, preview.png and outlines.html."""
    from drystone.drawing.canvas import save  # noqa: PLC0415 - matplotlib is slow
    from drystone.drawing.pictures.stones import plot_photo  # noqa: PLC0415
    from drystone.drawing.tracing.page import rings_of, write_outline_page  # noqa: PLC0415

    labels, px_per_m = result.found.labels, result.px_per_m
    write_labels(labels.astype(np.uint32), folder / LABELS)
    picture = io.BytesIO()
    Image.fromarray(result.picture).save(picture, "JPEG", quality=QUALITY)
    write_whole(folder / PHOTO, picture.getvalue())
    height, width = labels.shape
    write_sidecar(PhotoSidecar(width, height, px_per_m, PHOTO, details), folder)
    doubtful = tuple(sorted({stone for doubt in doubts for stone in doubt.stones}))
    necks_px = tuple(doubt.at_px for doubt in doubts if doubt.code == "W175")
    axes = plot_photo(result.picture, labels, (doubtful, necks_px), px_per_m)
    save(axes.figure, folder / PREVIEW, dpi=150)
    found = cut(labels.astype(np.int32), np.arange(1, result.found.count + 1))
    rings = rings_of([patch.to_stone() for patch in found], height)
    write_outline_page(
        folder / PAGE, result.picture, rings, title=f"Stones of {details['source']['name']}",
        name=PHOTO, kind="stones", px_per_m=px_per_m, doubts=doubts,
        details={name: details[name] for name in KEPT},
    )  # fmt: skip


def _details(
    photo: Photo, result: SegmentedPhoto, doubts: Sequence[Doubt], against: Sequence[str]
) -> dict[str, Any]:
    view, found = result.view, result.found
    return {
        "doubtful": list(against),
        "source": {"name": photo.name, "sha256": photo.sha256,
                   "width_px": photo.size_px[0], "height_px": photo.size_px[1]},
        "from_photo": np.asarray(result.from_photo).tolist(),
        "markers": [
            {"id": one.id, "corners_m": one.corners_m.tolist()} for one in result.markers
        ],
        "P_from_marker": None if not result.markers else {
            "id": result.markers[0].id, "matrix": result.markers[0].pose.matrix.tolist(),
        },
        "residual_mm": None if view is None else view.residual_mm,
        "residual_percent": None if view is None else view.residual_percent,
        "ground": {
            "lab": [round(float(part), 1) for part in found.ground.colour],
            "share": round(found.ground.share, 3), "uneven": round(found.ground.uneven, 3),
            "shadow": round(1.0 - found.shadow_level, 3),
        },
        "stones_found": found.count,
        "doubts": [
            {"code": doubt.code, "stones": list(doubt.stones), "x_px": round(doubt.at_px[0], 1),
             "y_px": round(doubt.at_px[1], 1), "text": doubt.text}
            for doubt in doubts
        ],
        "left_out": [
            {"x_px": round(one.at_px[0], 1), "y_px": round(one.at_px[1], 1),
             "area_px": one.area_px, "why": one.why}
            for one in found.left_out
        ],
    }  # fmt: skip


def _print(
    folder: Path, result: SegmentedPhoto, sizes: Sequence[StoneSize], notices: Sequence[Notice]
) -> None:
    px_per_m = result.px_per_m
    per_px, unit, digits = (1.0, "px", 0) if px_per_m is None else (100.0 / px_per_m, "cm", 1)

    def size(length_px: float, width_px: float) -> str:
        return f"{length_px * per_px:.{digits}f} x {width_px * per_px:.{digits}f} {unit}"

    ordered = sorted(sizes, key=lambda one: one.area_px)
    ends = (("smallest stone", ordered[0]), ("largest stone", ordered[-1]))
    height, width = result.found.labels.shape
    middle = median_sides((one.length_px, one.width_px) for one in sizes)
    rows = [
        ("picture", f"{width} x {height} px"),
        ("scale", "not known" if px_per_m is None else f"{px_per_m:.1f} px a metre"),
        ("median stone", size(*middle)),
        *((name, f"{one.id}: {size(one.length_px, one.width_px)}") for name, one in ends),
    ]
    if result.view is not None:
        said = f"{len(result.view.ids)}, residual {result.view.residual_mm:.2f} mm"
        rows.insert(2, ("markers", said))
    rows += [("notice", str(notice)) for notice in notices]
    rows.append(("to check", f"{folder / PAGE}: open it in a browser, correct, and save"))
    print_table(f"{folder / LABELS}: {counted(len(sizes), 'stone')}", rows)
