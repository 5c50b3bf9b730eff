"""A mechanism in motion: frames to scale, and a GIF that loops."""

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from PIL import Image, PngImagePlugin

from drystone.drawing.canvas import block_path
from drystone.drawing.outlines import Loop
from drystone.drawing.pictures.mechanism import COLOURS, Motion, motion_of, plot_mechanism
from drystone.drawing.pixels import gif_bytes, palette_of
from drystone.model.wall import Labels
from drystone.statics.model import Direction
from drystone.statics.result import Mechanism
from drystone.whole_files import write_whole

FRAME_MS = 80
"""How long a frame is shown."""

LONGER_SIDE_PX = 640
"""Width or height of a frame, the longer one, about."""

GREY_COUNT, COLOUR_COUNT = 8, 32


def mechanism_frames(
    wall: Labels | Mapping[int, Loop],
    mechanism: Mechanism,
    direction: Direction | None,
    alpha: float | None = None,
    *,
    frames: int = 24,
    load: str = "",
    numbers: bool = False,
) -> tuple[Image.Image, ...]:
    """Draw a mechanism from rest to the largest displacement of its picture and back."""
    if frames < 2:
        raise ValueError(f"an animation has at least 2 frames, not {frames}")
    ax = plot_mechanism(wall, mechanism, direction, alpha, load=load, numbers=numbers)
    figure, motion = ax.figure.get_figure(root=True), motion_of(wall, mechanism)
    box = figure.get_tightbbox().padded(0.08)
    dpi = LONGER_SIDE_PX / max(box.width, box.height)
    drawn: list[Image.Image] = []
    for step in range(frames // 2 + 1):
        _move(ax, motion, (1.0 - np.cos(2.0 * np.pi * step / frames)) / 2.0)
        with BytesIO() as file:
            figure.savefig(file, format="png", dpi=dpi, bbox_inches=box, facecolor="white")
            file.seek(0)
            drawn.append(PngImagePlugin.PngImageFile(file).convert("RGB"))
    return tuple(drawn[min(step, frames - step)] for step in range(frames))


def save_mechanism_animation(
    path: str | Path,
    wall: Labels | Mapping[int, Loop],
    mechanism: Mechanism,
    direction: Direction | None,
    alpha: float | None = None,
    *,
    frames: int = 24,
    **options: Any,
) -> None:
    """Write :func:`mechanism_frames` as a GIF that loops, without a date in the file."""
    if Path(path).suffix.lower() != ".gif":
        raise ValueError(f"{path}: animations end in .gif")
    pictures = mechanism_frames(wall, mechanism, direction, alpha, frames=frames, **options)
    # The same few for every GIF: greys, and the colours of the displacements.
    greys = np.linspace(0.0, 1.0, GREY_COUNT)[:, None].repeat(3, axis=1)
    few = palette_of(np.vstack((greys, COLOURS(np.linspace(0.0, 1.0, COLOUR_COUNT))[:, :3])))
    write_whole(Path(path), gif_bytes(pictures, few, FRAME_MS))


def _move(ax: Axes, motion: Motion, amplitude: float) -> None:
    """Put the blocks and their numbers where they are after a share of the motion."""
    blocks = {patch.get_gid(): patch for patch in ax.patches if isinstance(patch, PathPatch)}
    numbers = {text.get_gid(): text for text in ax.texts}
    moved, centroids = motion.at(amplitude), motion.centroids(amplitude)
    for region, loops, centroid in zip(motion.regions, moved, centroids, strict=True):
        blocks[f"moved-{region.id}"].set_path(block_path(loops))
        number = numbers.get(f"number-{region.id}")
        if number is not None:
            number.set_position(centroid)
