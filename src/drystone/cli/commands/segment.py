"""`drystone segment`: stones in a photograph."""

import argparse
import io
import math
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from drystone.cli.inputs import refuse_inputs
from drystone.cli.numbers import positive, whole_from
from drystone.cli.output import prepare_folder, print_json, print_table
from drystone.cli.scale import Ruled, add_scale, refuse_outside
from drystone.errors import ExitCode, Notice, UsageError
from drystone.io.photo_beside import LABELS, SIDECAR, PhotoSidecar, write_sidecar
from drystone.io.photo_file import Photo, read_photo
from drystone.model.stone_size import StoneSize, median_sides, sizes_of
from drystone.photo.layout import MarkerLayout, parse_layout, parse_size_m
from drystone.photo.segment_doubts import Doubt, doubts_of, notices_of, ruler_doubts
from drystone.photo.segment_photo import SegmentedPhoto, segment_photo
from drystone.photo.segment_settings import SegmentSettings
from drystone.photo.view import apply
from drystone.whole_files import write_whole

PHOTO, PREVIEW = "photo.jpg", "preview.png"
WRITTEN = (LABELS, PHOTO, SIDECAR, PREVIEW)
QUALITY = 90


_AREA = re.compile(r"(\d+(?:\.\d*)?|\.\d+)\s*(cm2|px)?")


def add(command: argparse.ArgumentParser) -> None:
    """Add what can be said about a photograph."""
    command.add_argument("photo", metavar="PHOTO", help="JPEG, PNG or TIFF of stones laid out")
    command.add_argument("-o", "--output", required=True, metavar="DIR", help="folder to write to")
    command.add_argument("--overwrite", action="store_true", help="write into a folder with files")
    add_scale(command)
    markers = command.add_argument_group("markers (they correct the perspective too)")
    markers.add_argument(
        "--aruco", metavar="MARKERS",
        help="A4 or A4:50mm: the sheet of `drystone markers`; 120mm: single markers of this size",
    )  # fmt: skip
    markers.add_argument(
        "--marker-ids", nargs="+", type=whole_from(0), metavar="ID",
        help="markers that count (default: of a sheet 0 to 3, of single ones all)",
    )  # fmt: skip
    markers.add_argument(
        "--check-line", metavar="LENGTH",
        help="what a ruler says of the line of 100 mm on the printed sheet, such as 97mm",
    )  # fmt: skip
    stones = command.add_argument_group("stones")
    stones.add_argument(
        "--ground", choices=["auto", "light", "dark"], default="auto",
        help="what the stones lie on (default: the most frequent colour)",
    )  # fmt: skip
    stones.add_argument(
        "--min-area", type=area, metavar="AREA",
        help="smaller is no stone: 12cm2, or px of the result (default: a fiftieth of a usual one)",
    )  # fmt: skip
    stones.add_argument(
        "--no-split", action="store_false", dest="split", help="leave touching stones together"
    )
    stones.add_argument(
        "--mpx", type=positive, default=1.6, metavar="N",
        help="million px of the result, at most (default 1.6)",
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print as JSON")


def area(text: str) -> tuple[float, str]:
    """Read an area: value and unit.

    Examples
    --------
    >>> area("12cm2"), area("300")
    ((12.0, 'cm2'), (300.0, 'px'))
    """
    found = _AREA.fullmatch(text.strip())
    if found is None or not 0 < float(found[1]) < math.inf:
        message = f"{text!r} is no area such as 12cm2 or 300 (px)"
        raise argparse.ArgumentTypeError(message)
    return float(found[1]), found[2] or "px"


def run(arguments: argparse.Namespace) -> ExitCode:
    """Find the stones of a photograph, write them, and say what is in doubt."""
    scale = scale_from(arguments)
    settings = SegmentSettings(ground=arguments.ground, split=arguments.split)
    path, folder = Path(arguments.photo), Path(arguments.output)
    refuse_inputs([path], [folder / name for name in WRITTEN])
    photo = read_photo(path)
    refuse_outside(arguments.px_per_m, photo.size_px)
    unit = None if arguments.min_area is None else arguments.min_area[1]
    if unit == "cm2" and scale is None:
        raise UsageError(
            "E131", "an area in cm2 needs the scale of the photograph.", where="--min-area",
            cure="Give it with --aruco, --px-per-m or --ruler, or give the area in px.",
        )  # fmt: skip
    prepare_folder(folder, WRITTEN, overwrite=arguments.overwrite)
    result = segment_photo(
        photo.values, scale, settings, arguments.min_area, max_px=round(arguments.mpx * 1e6)
    )
    doubts = doubts_of(result.found, result.px_per_m, settings)
    if isinstance(scale, Ruled):
        doubts += ruler_doubts(result.found.labels, _moved(result, scale))
    notices = (*photo.notices, *result.notices, *notices_of(result.found, doubts))
    _write(folder, photo, result, doubts)
    sizes = sizes_of(result.found.labels)
    if arguments.json:
        print_json(_as_json(photo, result, sizes, doubts, notices))
    else:
        _print(folder, result, sizes, notices)
    if result.px_per_m is None:
        said = "no scale: sizes are px. --aruco, --px-per-m or --ruler give one"
        print(f"drystone: {said}", file=sys.stderr)
    return ExitCode.DONE


def scale_from(arguments: argparse.Namespace) -> MarkerLayout | float | None:
    """Return the markers or the px in a metre that are given; E138 for both."""
    if arguments.aruco is None:
        for name in ("marker_ids", "check_line"):
            if getattr(arguments, name) is not None:
                raise UsageError(
                    "E138", "is about markers, and there are none.",
                    where=f"--{name.replace('_', '-')}", cure="Add --aruco, or leave it out.",
                )  # fmt: skip
        scale: float | None = arguments.px_per_m
        return scale
    if arguments.px_per_m is not None:
        raise UsageError(
            "E138", "the scale is given twice.", where="--aruco",
            cure="Give markers, or --px-per-m or --ruler.",
        )  # fmt: skip
    printed = 1.0 if arguments.check_line is None else parse_size_m(arguments.check_line) / 0.1
    ids = None if arguments.marker_ids is None else tuple(arguments.marker_ids)
    return parse_layout(arguments.aruco, ids, printed)


def _moved(result: SegmentedPhoto, scale: Ruled) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return where the ends of a ruler are in the picture of the result."""
    (x1, y1), (x2, y2) = apply(result.from_photo, np.array(scale.ends_px)).tolist()
    return (x1, y1), (x2, y2)


def _write(folder: Path, photo: Photo, result: SegmentedPhoto, doubts: tuple[Doubt, ...]) -> None:
    """Write stones.png, photo.jpg, stones.json and preview.png."""
    from drystone.drawing.files import save  # noqa: PLC0415 - matplotlib is slow
    from drystone.drawing.pictures.stones import plot_photo  # noqa: PLC0415

    _save_image(Image.fromarray(result.found.labels), folder / LABELS, "PNG")
    _save_image(Image.fromarray(result.picture), folder / PHOTO, "JPEG", quality=QUALITY)
    height, width = result.found.labels.shape
    write_sidecar(
        PhotoSidecar(width, height, result.px_per_m, PHOTO, _details(photo, result, doubts)), folder
    )
    axes = plot_photo(result.picture, result.found.labels, _marked(doubts), result.px_per_m)
    save(axes.figure, folder / PREVIEW, dpi=150)


def _save_image(image: Image.Image, path: Path, kind: str, **settings: Any) -> None:
    file = io.BytesIO()
    image.save(file, kind, **settings)
    write_whole(path, file.getvalue())


def _marked(doubts: tuple[Doubt, ...]) -> tuple[tuple[int, ...], tuple[tuple[float, float], ...]]:
    """Return doubtful stones, and the places of necks."""
    stones = sorted({stone for doubt in doubts for stone in doubt.stones})
    return tuple(stones), tuple(doubt.at_px for doubt in doubts if doubt.code == "W175")


def _details(photo: Photo, result: SegmentedPhoto, doubts: tuple[Doubt, ...]) -> dict[str, Any]:
    view, found = result.view, result.found
    return {
        "source": {"name": photo.name, "sha256": photo.sha256,
                   "width_px": photo.size_px[0], "height_px": photo.size_px[1]},
        "from_photo": np.asarray(result.from_photo).tolist(),
        "markers": None if view is None or not view.ids else {
            "ids": list(view.ids), "residual_mm": view.residual_mm,
            "residual_percent": view.residual_percent,
        },
        "ground": {
            "lab": [round(float(part), 1) for part in found.ground.colour],
            "share": round(found.ground.share, 3), "uneven": round(found.ground.uneven, 3),
            "shadow": round(1.0 - found.shadow_level, 3),
        },
        "stones_found": found.count,
        "doubts": [_doubt_json(doubt) for doubt in doubts],
    }  # fmt: skip


def _doubt_json(doubt: Doubt) -> dict[str, Any]:
    x, y = (round(part, 1) for part in doubt.at_px)
    return {"code": doubt.code, "stones": list(doubt.stones), "x_px": x, "y_px": y,
            "text": doubt.text}  # fmt: skip


def _as_json(
    photo: Photo,
    result: SegmentedPhoto,
    sizes: tuple[StoneSize, ...],
    doubts: tuple[Doubt, ...],
    notices: tuple[Notice, ...],
) -> dict[str, Any]:
    metres = None if result.px_per_m is None else 1.0 / result.px_per_m
    stones = [
        {
            "id": size.id, "x_px": round(size.at_px[0], 1), "y_px": round(size.at_px[1], 1),
            "area_px": size.area_px, "length_px": round(size.length_px, 1),
            "width_px": round(size.width_px, 1),
            "length_m": None if metres is None else round(size.length_px * metres, 4),
            "width_m": None if metres is None else round(size.width_px * metres, 4),
        }
        for size in sizes
    ]  # fmt: skip
    return {
        "stones": len(sizes),
        "px_per_m": result.px_per_m,
        **_details(photo, result, doubts),
        "sizes": stones,
        "notices": [str(notice) for notice in notices],
    }


def _print(
    folder: Path,
    result: SegmentedPhoto,
    sizes: tuple[StoneSize, ...],
    notices: tuple[Notice, ...],
) -> None:
    per_px, unit = (1.0, "px") if result.px_per_m is None else (100.0 / result.px_per_m, "cm")
    digits = 0 if result.px_per_m is None else 1

    def size(length_px: float, width_px: float) -> str:
        return f"{length_px * per_px:.{digits}f} x {width_px * per_px:.{digits}f} {unit}"

    ordered = sorted(sizes, key=lambda one: one.area_px)
    height, width = result.found.labels.shape
    middle = median_sides((one.length_px, one.width_px) for one in sizes)
    rows = [
        ("picture", f"{width} x {height} px"),
        ("scale", "not known" if result.px_per_m is None else f"{result.px_per_m:.1f} px a metre"),
        ("median stone", size(*middle)),
        *(
            (name, f"{one.id}: {size(one.length_px, one.width_px)}")
            for name, one in (("smallest stone", ordered[0]), ("largest stone", ordered[-1]))
        ),
    ]
    if result.view is not None and result.view.ids:
        said = f"{len(result.view.ids)}, residual {result.view.residual_mm:.2f} mm"
        rows.insert(2, ("markers", said))
    rows += [("notice", str(notice)) for notice in notices]
    rows.append(("to check", str(folder / PREVIEW)))
    print_table(f"{folder / LABELS}: {len(sizes)} stones", rows)
