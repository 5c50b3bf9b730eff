"""`drystone stones`: what was read."""

import argparse
import statistics
from pathlib import Path

from drystone.cli.output import prepare_picture, print_json, print_table
from drystone.cli.reading import reading_from
from drystone.clusters import cluster_stones
from drystone.errors import ExitCode
from drystone.io.read_stones import read_stones
from drystone.poses import PoseBook


def run(arguments: argparse.Namespace) -> ExitCode:
    """Print count, sizes, clusters and notices; draw the stones when asked."""
    picture = None if arguments.output is None else Path(arguments.output)
    if picture is not None:
        prepare_picture(picture, overwrite=arguments.overwrite)
    stones = read_stones(Path(arguments.stones), settings=reading_from(arguments))
    clusters = cluster_stones(stones, PoseBook())
    areas = [stone.area_px for stone in stones]
    sizes = [(stone.mask.shape[1], stone.mask.shape[0]) for stone in stones]
    largest = max(stones, key=lambda stone: stone.area_px)
    if picture is not None:
        from drystone.plotting import plot_stones, save  # noqa: PLC0415 - matplotlib is slow

        save(plot_stones(stones, clusters).figure, picture)
    if arguments.json:
        print_json(
            {
                "stones": len(stones),
                "source": stones.source.path,
                "sha256": stones.source.sha256,
                "width_px": stones.source.width_px,
                "height_px": stones.source.height_px,
                "px_per_m": stones.source.px_per_m,
                "total_area_px": stones.total_area_px,
                "median_area_px": statistics.median(areas),
                "clusters": {str(stone.id): clusters[stone.id] for stone in stones},
                "notices": [str(notice) for notice in stones.notices],
            }
        )
        return ExitCode.DONE
    median = [statistics.median(side) for side in zip(*sizes, strict=True)]
    print_table(
        f"{stones.source.path}: {len(stones)} stones",
        [
            ("image", f"{stones.source.width_px} x {stones.source.height_px} px"),
            *([("scale", f"{scale:g} px a metre")] if (scale := stones.source.px_per_m) else []),
            ("total area", f"{stones.total_area_px} px"),
            ("median stone", f"{median[0]:g} x {median[1]:g} px, {statistics.median(areas):g} px²"),
            (
                "largest stone",
                f"{largest.id}: {largest.mask.shape[1]} x {largest.mask.shape[0]} px",
            ),
            ("clusters", str(max(clusters.values()))),
            *[("notice", str(notice)) for notice in stones.notices],
        ],
    )
    return ExitCode.DONE
