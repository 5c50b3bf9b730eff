"""Fig. 17: the shortest paths along the joints, ours and the masons' (§5.2)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from drystone.drawing.pictures.stones import plot_joint_paths
from drystone.metrics import paths as joint_paths
from drystone.metrics.frame import frame_wall, reduce_labels
from drystone.metrics.paths import PAD_LEFT, PAD_TOP, SHORTEST, JointPath, joint_mask, mean_excess
from drystone.model.wall import Labels
from drystone_lab.reproduce.cells import rounded
from drystone_lab.reproduce.item import Context, ItemFigure, PaperItem, Rows
from drystone_lab.walls import PR, Target

ACROSS, UPRIGHT = 3, 7
"""How many paths Fig. 17 draws."""


Way = tuple[str, tuple[JointPath, ...], int, int]
"""Name, paths, length of a straight one in px, and how many are drawn."""


@dataclass(frozen=True, eq=False)
class Paths:
    """The shortest paths along the joints of a wall either way, the shortest first."""

    name: str
    labels: Labels
    ways: tuple[Way, Way]

    @classmethod
    def of(cls, name: str, labels: Labels, wall_width_px: float | None = None) -> "Paths":
        """Find the paths of a label image."""
        framed = frame_wall(labels, wall_width_px).labels
        joint = joint_mask(framed)
        rows, cols = joint.shape
        across = "horizontal", joint_paths.horizontal_paths(joint), cols - 1, ACROSS
        upright = "vertical", joint_paths.vertical_paths(joint), rows - 1, UPRIGHT
        return cls(name, framed, (across, upright))


def walls(context: Context, wall: Target = PR) -> tuple[Paths, ...]:
    """Find the shortest paths; of published stones the image is the masons' wall."""
    built = context.wall(wall.run(context.seed))
    found = [Paths.of(f"planned {wall.name}", built.labels, built.site.width_px)]
    if context.data is not None and wall.source.kind == "published":
        traced = wall.source.labels(context.data)
        found.append(Paths.of(f"the masons' {wall.name}", reduce_labels(traced, wall.scale)))
    return tuple(found)


def _figures(walls: Sequence[Paths]) -> Rows:
    for paths in walls:
        factors = (
            rounded(mean_excess([path.length_px for path in found[:SHORTEST]], straight))
            for _, found, straight, _ in paths.ways
        )
        yield paths.name, *(straight for _, _, straight, _ in paths.ways), *factors


def _paths(walls: Sequence[Paths]) -> Rows:
    for paths in walls:
        for way, found, straight, _ in paths.ways:
            for rank, path in enumerate(found, 1):
                start = path.pixels[0] - (PAD_TOP, PAD_LEFT)
                at = int(start[0] if way == "horizontal" else start[1])
                excess = rounded(mean_excess([path.length_px], straight))
                yield paths.name, way, rank, at, round(path.length_px, 4), excess


def _picture(paths: Paths, number: int) -> ItemFigure:
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    for ax, (way, found, _, count) in zip(figure.subplots(2, 1), paths.ways, strict=True):
        pad = np.array([PAD_TOP, PAD_LEFT])
        plot_joint_paths(paths.labels, [path.pixels - pad for path in found[:count]], ax)
        lengths = ", ".join(f"{path.length_px:.0f}" for path in found[:count])
        ax.set_title(f"{paths.name}: {way} paths of {lengths} px", fontsize=8, loc="left")
    counts = {way: len(found[:count]) for way, found, _, count in paths.ways}
    return ItemFigure("fig17-masons" if number else "fig17", figure, {"name": paths.name, **counts})


PATHS = PaperItem(
    study=walls,
    tables={"figures": _figures, "paths": _paths},
    pictures=lambda found: [_picture(paths, number) for number, paths in enumerate(found)],
)
