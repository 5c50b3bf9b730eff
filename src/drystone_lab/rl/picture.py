"""The wall of an episode as an array of pixels."""

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drystone.drawing.pictures.wall import plot_wall
from drystone_lab.rl.episode import Episode

SIZE_IN = (8.0, 4.0)
DPI = 100
"""Size of a picture: always the same, as a film wants it."""


def wall_picture(episode: Episode) -> NDArray[np.uint8]:
    """Draw what is built, with what it carries above, (400, 800, 3) RGB."""
    figure = Figure(figsize=SIZE_IN, dpi=DPI)
    canvas: Any = FigureCanvasAgg(figure)
    ax = figure.add_axes((0.05, 0.14, 0.9, 0.76))
    wall, actions = episode.build.wall, episode.build.actions
    carried = (actions[-1].resistance.value or 0.0) if actions else 0.0
    title = (
        f"{len(actions)} stones built, {episode.aside} put aside, {episode.waiting} to come; "
        f"F_SF {wall.filling:.2f}, F_LR {carried:.2f}"
    )
    plot_wall(wall, episode.workshop.clusters, ax, title=title)
    canvas.draw()
    return np.array(np.asarray(canvas.buffer_rgba())[..., :3])
