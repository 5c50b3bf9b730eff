"""Fig. 17: the shortest paths along the joints, ours and the masons' (§5.2)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from drystone.drawing.pictures.stones import plot_joint_paths
from drystone.io.published import published_file
from drystone.io.wall_image import read_wall_image
from drystone.metrics.frame import frame_wall
from drystone.metrics.joints import PAD_LEFT, PAD_TOP, joint_mask
from drystone.metrics.paths import (
    SHORTEST,
    JointPath,
    horizontal_paths,
    mean_excess,
    vertical_paths,
)
from drystone.metrics.reduce import reduce_labels
from drystone.model.wall import Labels
from drystone_lab.reproduce.item import Context, ItemPicture, PaperItem, paper
from drystone_lab.table import Cell, Table
from drystone_lab.walls import PR, Target

ACROSS, UPRIGHT = 3, 7
"""How many paths Fig. 17 draws."""

PANEL_IN = (6.4, 2.2)


@dataclass(frozen=True, eq=False)
class Paths:
    """The shortest paths along the joints of a wall, the shortest first.

    Width and height are the lengths of straight paths, px.
    """

    name: str
    labels: Labels
    across: tuple[JointPath, ...]
    upright: tuple[JointPath, ...]
    width: int
    height: int

    @classmethod
    def of(cls, name: str, labels: Labels, wall_width_px: float | None = None) -> "Paths":
        """Find the paths of a label image."""
        framed = frame_wall(labels, wall_width_px).labels
        joint = joint_mask(framed)
        rows, cols = joint.shape
        return cls(name, framed, horizontal_paths(joint), vertical_paths(joint), cols - 1, rows - 1)

    @property
    def figures(self) -> tuple[float | None, float | None]:
        """F_AH and F_AV, in percent; None where there is no path."""
        across = [path.length_px for path in self.across[:SHORTEST]]
        upright = [path.length_px for path in self.upright[:SHORTEST]]
        return mean_excess(across, self.width), mean_excess(upright, self.height)


def walls(context: Context, wall: Target = PR) -> tuple[Paths, ...]:
    """Find the shortest paths; of published stones the image is the masons' wall."""
    spec = wall.run(context.seed)
    built = context.wall(spec)
    found = [Paths.of(f"planned {wall.name}", built.labels, built.site.width_px)]
    if context.data is not None and wall.source.kind == "published":
        traced = read_wall_image(published_file(context.data, wall.source.name))
        found.append(Paths.of(f"the masons' {wall.name}", reduce_labels(traced, wall.scale)))
    return tuple(found)


def _figures(walls: Sequence[Paths]) -> Table:
    rows = []
    for paths in walls:
        figures = (None if value is None else round(value, 4) for value in paths.figures)
        rows.append((paths.name, paths.width, paths.height, *figures))
    return Table(
        "Alignment factors",
        ("wall", "straight across px", "straight upright px", "F_AH %", "F_AV %"),
        tuple(rows),
        (f"Mean over the {SHORTEST} shortest paths.",),
    )


def _paths(walls: Sequence[Paths]) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for paths in walls:
        for way, found, straight in (
            ("horizontal", paths.across, paths.width),
            ("vertical", paths.upright, paths.height),
        ):
            for rank, path in enumerate(found, 1):
                start = path.pixels[0] - (PAD_TOP, PAD_LEFT)
                at = int(start[0] if way == "horizontal" else start[1])
                excess = mean_excess([path.length_px], straight)
                cell = None if excess is None else round(excess, 4)
                rows.append((paths.name, way, rank, at, round(path.length_px, 4), cell))
    return Table(
        "Paths along the joints, the shortest first",
        ("wall", "way", "rank", "start row or col", "length px", "longer than straight %"),
        tuple(rows),
        ("Rows from the top of the stones, columns from the left end of the wall.",),
    )


def _picture(paths: Paths, number: int) -> ItemPicture:
    figure = Figure(figsize=(PANEL_IN[0], 2 * PANEL_IN[1]), layout="constrained")
    pad = np.array([PAD_TOP, PAD_LEFT])
    for ax, found, count, way in zip(
        figure.subplots(2, 1), (paths.across, paths.upright), (ACROSS, UPRIGHT),
        ("horizontal", "vertical"), strict=True,
    ):  # fmt: skip
        shown = found[:count]
        plot_joint_paths(paths.labels, [path.pixels - pad for path in shown], ax)
        lengths = ", ".join(f"{path.length_px:.0f}" for path in shown)
        ax.set_title(f"{paths.name}: {way} paths of {lengths} px", fontsize=8, loc="left")
    return ItemPicture(
        "fig17" if number == 0 else "fig17-masons", figure,
        f"The shortest paths along the joints, {paths.name}: {len(paths.across[:ACROSS])} "
        f"horizontal and {len(paths.upright[:UPRIGHT])} vertical ones. F_AH and F_AV come from the "
        f"{SHORTEST} shortest of each.",
    )  # fmt: skip


PATHS = PaperItem(
    **paper("fig17"),
    study=walls,
    tables={"figures": _figures, "paths": _paths},
    pictures=lambda found: [_picture(paths, number) for number, paths in enumerate(found)],
    needs=(PR.source.name,),
)
