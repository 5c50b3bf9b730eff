"""Fig. 18: clusters, the wall of the fixed seed, the best one, and the masons'."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from drystone.clusters import cluster_stones
from drystone.drawing.pictures.stones import plot_stones
from drystone.poses import PoseBook
from drystone_lab.pictures.masonry import masonry_panel
from drystone_lab.pictures.sheet import EMPTY, Panel, sheet_of
from drystone_lab.pictures.wall_grid import wall_aspect, wall_panel
from drystone_lab.reproduce.drawn import titled_wall
from drystone_lab.reproduce.item import Context, Picture
from drystone_lab.reproduce.table2_rows import FiveWall

COLUMNS = 4


def fig18(context: Context, walls: Sequence[FiveWall]) -> Picture:
    """Draw a row for each wall."""
    panels = [panel for wall in walls for panel in _row(context, wall)]
    return Picture(
        "fig18",
        sheet_of(panels, COLUMNS),
        "From the left: the stones by cluster; the wall of the fixed seed; the best of all seeds "
        "by the paper's rule; the masons' wall, its stones drawn together and dilated by one "
        "working px. Numbers on stones of walls are steps of the plan, on stones alone their ids; "
        "wedges are dark red.",
    )


def _row(context: Context, wall: FiveWall) -> list[Panel]:
    trials = wall.trials
    start = f"Wall {wall.number}, {wall.name}"
    fixed = titled_wall(context, trials, f"fixed seed {trials.specs[0].seed}")
    seed = trials.specs[wall.best].seed
    chosen = titled_wall(
        context, trials, f"best of {len(trials.specs)}, seed {seed}", which=wall.best
    )
    return [_clusters(wall, start), wall_panel(*fixed), wall_panel(*chosen), _masons(wall)]


def _clusters(wall: FiveWall, start: str) -> Panel:
    stones, scale = wall.stones, wall.trials.wall.scale
    clusters = cluster_stones(stones, PoseBook(scale))
    count = len(set(clusters.values()))

    def draw(ax: Axes) -> Axes:
        return plot_stones(stones, clusters, ax)

    title = f"{start}\n{len(stones)} stones in {count} clusters"
    return Panel(title, wall_aspect(stones.source.height_px / stones.source.width_px), draw)


def _masons(wall: FiveWall) -> Panel:
    if wall.masons is None:
        return EMPTY
    labels, scale = wall.masons.papers_way, wall.masons.wall.scale
    return masonry_panel("masons, gaps closed", labels, wall.masons.clusters, 1 / scale)
