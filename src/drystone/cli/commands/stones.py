"""`drystone stones`: what was read."""

import argparse
import statistics
from pathlib import Path

from drystone.cli import numbers
from drystone.cli.inputs import files_of, refuse_among_masks, refuse_inputs
from drystone.cli.output import prepare_files, prepare_picture, print_json, print_table
from drystone.cli.reading import STONES, add_reading, reading_from
from drystone.clusters import cluster_stones
from drystone.errors import ExitCode, counted
from drystone.io.read_stones import read_stones
from drystone.io.wall_image import write_stones, written_as
from drystone.model.stone_size import median_sides, sides_px
from drystone.poses import PoseBook


def add(command: argparse.ArgumentParser) -> None:
    """Add its options."""
    command.add_argument("stones", metavar="STONES", help=STONES)
    command.add_argument("-o", "--output", metavar="PICTURE.png", help="draw the stones")
    command.add_argument(
        "--labels", metavar="FILE",
        help="write what was read: as a label image (.png, .tif, .npy; its scale goes into "
        "stones.json beside it), or as outlines for labelme (.json)",
    )  # fmt: skip
    command.add_argument("--overwrite", action="store_true", help="replace what is written")
    add_reading(command)
    numbers.add_scale(command)
    command.add_argument("--json", action="store_true", help="print as JSON")


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print count, sizes, clusters and notices; draw or convert the stones when asked."""
    picture = None if arguments.output is None else Path(arguments.output)
    path = Path(arguments.stones)
    to = None if arguments.labels is None else Path(arguments.labels)
    files = () if to is None else written_as(to)
    written = files if picture is None else (*files, picture)
    refuse_inputs(files_of(path), written)
    refuse_among_masks(path, written)
    prepare_files(files, overwrite=arguments.overwrite)
    if picture is not None:
        prepare_picture(picture, overwrite=arguments.overwrite)
    stones = read_stones(path, settings=reading_from(arguments))
    source = stones.source
    numbers.refuse_outside(arguments.px_per_m, numbers.picture_size_px(source))
    px_per_m = numbers.scale_with(arguments.px_per_m, source.px_per_m)
    converted = () if to is None else write_stones(stones, to, px_per_m)
    clusters = cluster_stones(stones, PoseBook())
    median_area = statistics.median(stone.area_px for stone in stones)
    sides = {stone.id: sides_px(stone.mask) for stone in stones}
    largest = max(stones, key=lambda stone: stone.area_px)
    if picture is not None:
        from drystone.drawing import plot_stones, save  # noqa: PLC0415 - matplotlib is slow

        save(plot_stones(stones, clusters).figure, picture)
    median = median_sides(sides.values())
    odd = numbers.scale_notice(median[0], px_per_m)
    notices = [str(notice) for notice in (*stones.notices, *converted, odd) if notice is not None]
    if arguments.json:
        told = {
            "stones": len(stones),
            "source": source.path,
            "sha256": source.sha256,
            "width_px": source.width_px,
            "height_px": source.height_px,
            "px_per_m": px_per_m,
            "total_area_px": stones.total_area_px,
            "median_area_px": median_area,
            "clusters": {str(stone.id): clusters[stone.id] for stone in stones},
            "notices": notices,
        }
        print_json(told)
        return ExitCode.DONE
    area = f"{stones.total_area_px} px"
    metres = None if px_per_m is None else stones.total_area_px / px_per_m**2
    rows = [
        ("image", f"{source.width_px} x {source.height_px} px"),
        *([] if px_per_m is None else [("scale", f"{px_per_m:g} px a metre")]),
        ("total area", area if metres is None else f"{metres:.3f} m² ({area})"),
        ("median stone", f"{_size(median, px_per_m)}, {median_area:g} px²"),
        ("largest stone", f"{largest.id}: {_size(sides[largest.id], px_per_m)}"),
        ("clusters", str(max(clusters.values()))),
        *[("notice", notice) for notice in notices],
        *([] if to is None else [("written", str(to))]),
    ]
    print_table(f"{source.path}: {counted(len(stones), 'stone')}", rows)
    return ExitCode.DONE


def _size(size_px: tuple[float, float], px_per_m: float | None) -> str:
    length_px, width_px = size_px
    px = f"{round(length_px, 1):g} x {round(width_px, 1):g} px"
    if px_per_m is None:
        return px
    per_px_cm = 100.0 / px_per_m
    return f"{length_px * per_px_cm:.1f} x {width_px * per_px_cm:.1f} cm ({px})"
