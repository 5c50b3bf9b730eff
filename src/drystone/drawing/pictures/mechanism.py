"""The failure mechanism of a wall (Fig. 15), and in motion as a GIF that loops."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_hex
from matplotlib.patches import PathPatch
from PIL import Image, PngImagePlugin

from drystone.drawing.canvas import block_path, draw
from drystone.drawing.drawing import Drawable, Drawing, Lines, Surface, Words, ground, size_of
from drystone.drawing.outlines import Loop, Region, regions_box, stands_on_ground, wall_regions
from drystone.drawing.palette import GREY
from drystone.drawing.pixels import gif_bytes, palette_of
from drystone.kernels.raster import Floats
from drystone.model.wall import Labels
from drystone.statics.model import Direction
from drystone.statics.result import Mechanism
from drystone.whole_files import write_whole

LARGEST_SHARE = 0.12  # largest displacement in the picture over the height of the wall
LARGEST_TURN = 0.35
"""Largest angle in the picture, rad: a small stone that turns alone must not spin."""

COLOURS = ListedColormap(colormaps["YlOrRd"](np.linspace(0.02, 0.82, 256)))
"""From pale (still) to red: lightness falls steadily, so it reads in grey too, and its dark end is
light enough for outlines to show."""


@dataclass(frozen=True, eq=False)
class MechanismMotion:
    """The blocks of a wall on their way from rest to the picture of a mechanism.

    `displacement` is to the right, up, and the angle (rad, counter-clockwise) at the centroid of
    each block, as large as the picture shows it.
    """

    regions: tuple[Region, ...]
    displacement: Floats

    @property
    def share(self) -> Floats:
        """Displacement of each centroid over the largest one."""
        length = np.hypot(self.displacement[:, 0], self.displacement[:, 1])
        return np.asarray(length / length.max()) if length.any() else length

    def at(self, amplitude: float) -> tuple[Region, ...]:
        """Return all blocks after a share of the motion, 0 (rest) to 1."""
        moved = []
        for region, twist in zip(self.regions, amplitude * self.displacement, strict=True):
            loops = tuple(_moved(loop, region, twist) for loop in region.loops)
            x, y = _moved(np.array([region.centroid]), region, twist)[0].tolist()
            moved.append(Region(region.id, loops, (x, y)))
        return tuple(moved)


def motion_of(wall: Labels | Mapping[int, Loop], mechanism: Mechanism) -> MechanismMotion:
    """Scale a mechanism of a wall, a label image or polygons, for pictures.

    No point moves by more than `LARGEST_SHARE` of the wall's height (or of a fifth of its length,
    if that is more), no block turns by more than `LARGEST_TURN`, and one of them does.  Blocks that
    the mechanism does not name stay; one that the wall does not have is a ValueError.
    """
    regions = wall_regions(wall)
    known = dict(zip(mechanism.block_ids, mechanism.velocity, strict=True))
    missing = sorted(set(known) - {region.id for region in regions})
    if missing:
        raise ValueError(f"the mechanism moves blocks that the wall lacks: {missing}")
    rows = [known.get(region.id, np.zeros(3)) for region in regions]
    velocities = np.array(rows, float).reshape(-1, 3)
    largest, fastest = LARGEST_SHARE * size_of(regions), 0.0
    for region, (along_x, along_y, turning) in zip(regions, velocities, strict=True):
        x, y = (np.concatenate(region.loops) - region.centroid).T
        speed = np.hypot(along_x - turning * y, along_y + turning * x)
        fastest = max(fastest, float(speed.max()))
    turning = float(np.abs(velocities[:, 2]).max(initial=0.0))
    if fastest == 0.0:
        return MechanismMotion(regions, velocities)
    factor = largest / fastest
    return MechanismMotion(
        regions, velocities * min(factor, LARGEST_TURN / turning if turning else factor)
    )


def plot_mechanism(
    wall: Labels | Mapping[int, Loop],
    mechanism: Mechanism,
    direction: Direction | None,
    alpha: float | None = None,
    ax: Axes | None = None,
    *,
    load: str = "",
    numbers: bool | Mapping[int, int] = False,
) -> Axes:
    """Draw how a wall fails: every block moved by its velocity, coloured by displacement (Fig. 15).

    Blocks turn about their centres of rotation and keep their size; the largest displacement in
    the picture is some 12 % of the wall's height.  Thin grey lines show the wall before.  Blocks
    without a velocity stay where they are.

    The wall is a label image, (h, w), row 0 at the top, or polygons, (n, 2), by id; ValueError when
    it lacks a block of the mechanism.  The live load points in the `direction`, None when the wall
    falls by itself.  Beside its arrow the load multiplier `alpha` (adequacy factor) is written.
    `load` are words for a live load that is not the tilting table's, such as "point load on 7",
    which has no arrow.  `numbers` writes ids on the blocks, or other numbers by id, such as steps.
    The axes are in px of the image or the unit of the polygons, y up from the ground: for a label
    image the lower edge of its lowest stone pixel.
    """
    motion = motion_of(wall, mechanism)
    moved = motion.at(1.0)
    x0, y0, x1, y1 = regions_box(region.loops for region in (*motion.regions, *moved))
    pad = 0.02 * (x1 - x0)
    depth = 0.035 * max(y1 - y0, 0.2 * (x1 - x0))
    box = (x0 - pad, y0 - depth, x1 + pad, y1 + 3.5 * depth)
    items: list[Drawable] = []
    if stands_on_ground(motion.regions):
        items += ground((box[0], -depth, box[2], 0.0))
    items += _blocks(motion, moved, numbers)
    y, middle, half = y1 + 2 * depth, (x0 + x1) / 2, 0.06 * (x1 - x0 + 2 * pad)
    if direction is None:
        half = 1.2 * depth
    reach = {"left": (-half, 0.0), "right": (half, 0.0), None: (0.0, -half)}[direction]
    if not load:
        arrow = np.array([(middle, y)] * 2) + np.array([-np.array(reach), reach])
        items.append(
            Lines("live-load" if direction else "own-weight", [arrow], width_pt=2.2, head=True)
        )
    ax = draw(Drawing(tuple(items), box), ax)
    words = "falls under its own weight"
    if direction is not None:
        words = load or rf"live load, $\alpha$ times the weight, to the {direction}"
        words += "" if alpha is None else rf", $\alpha$ = {alpha:.3f}"
    # In points from the arrow, which is short over low walls.
    ax.annotate(
        words, (middle if load else middle + abs(reach[0]), y),
        (0.0 if load else 10.0, 0.0), textcoords="offset points", size=8,
        ha="center" if load else "left", va="center",
    )  # fmt: skip
    return ax


def _blocks(
    motion: MechanismMotion, moved: Sequence[Region], numbers: bool | Mapping[int, int]
) -> list[Drawable]:
    share = motion.share
    items: list[Drawable] = []
    # The blocks that move most are drawn last: dilatancy opens joints, rounding may close some.
    for index in np.argsort(share, kind="stable"):
        fill, region = to_hex(COLOURS(float(share[index]))), moved[index]
        area = Surface(f"moved-{region.id}", region.loops, fill)
        items.append(area)
        if numbers:
            named = numbers if isinstance(numbers, Mapping) else {}
            written = str(named.get(region.id, region.id))
            name = f"number-{region.id}"
            items.append(Words(name, written, region.centroid, area.room, fill))
    items += [
        Surface(f"before-{region.id}", region.loops, line=GREY, width_pt=0.5, z=2.0)
        for region in motion.regions
    ]
    return items


def _moved(points: Loop, region: Region, twist: Floats) -> Loop:
    """Move points of a block by a finite twist: a turn about the twist's centre of rotation.

    So a block keeps its size, blocks that move as one stay together, and a toe stays where it is.
    With the angle a the centroid moves by V (x, y), V = [[sin a, cos a - 1], [1 - cos a, sin a]]
    / a, which is a translation for a = 0.
    """
    x, y, angle = twist
    sine_share = float(np.sinc(angle / np.pi))
    rest_share = float(np.sinc(angle / (2 * np.pi)) * np.sin(angle / 2))  # (1 - cos a) / a
    step = (sine_share * x - rest_share * y, rest_share * x + sine_share * y)
    cos, sin = np.cos(angle), np.sin(angle)
    arms = points - region.centroid
    return np.asarray(arms @ np.array([[cos, sin], [-sin, cos]]) + region.centroid + step)


FRAME_MS = 80  # how long a frame is shown
LONGER_SIDE_PX = 640  # width or height of a frame, the longer one, about
GREY_COUNT, COLOUR_COUNT = 8, 32


def mechanism_frames(
    wall: Labels | Mapping[int, Loop],
    mechanism: Mechanism,
    direction: Direction | None,
    alpha: float | None = None,
    *,
    frames: int = 24,
    load: str = "",
    numbers: bool | Mapping[int, int] = False,
) -> tuple[Image.Image, ...]:
    """Draw a mechanism from rest to the largest displacement of its picture and back.

    Parameters as for :func:`plot_mechanism`.  There are at least 2 frames, RGB and of one size; the
    motion slows down at both ends, and the last frame leads to the first.
    """
    if frames < 2:
        raise ValueError(f"an animation has at least 2 frames, not {frames}")
    ax = plot_mechanism(wall, mechanism, direction, alpha, load=load, numbers=numbers)
    figure, motion = ax.figure.get_figure(root=True), motion_of(wall, mechanism)
    box = figure.get_tightbbox().padded(0.08)
    dpi = LONGER_SIDE_PX / max(box.width, box.height)
    blocks = {patch.get_gid(): patch for patch in ax.patches if isinstance(patch, PathPatch)}
    texts = {text.get_gid(): text for text in ax.texts}
    drawn: list[Image.Image] = []
    for step in range(frames // 2 + 1):
        for region in motion.at((1.0 - np.cos(2.0 * np.pi * step / frames)) / 2.0):
            blocks[f"moved-{region.id}"].set_path(block_path(region.loops))
            if (number := texts.get(f"number-{region.id}")) is not None:
                number.set_position(region.centroid)
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
    **options: Any,
) -> None:
    """Write :func:`mechanism_frames`, with its options, as a looping GIF without a date in it.

    Another ending than ".gif" is a ValueError; E206 when the file cannot be written.
    """
    if Path(path).suffix.lower() != ".gif":
        raise ValueError(f"{path}: animations end in .gif")
    pictures = mechanism_frames(wall, mechanism, direction, alpha, **options)
    # The same few for every GIF: greys, and the colours of the displacements.
    greys = np.linspace(0.0, 1.0, GREY_COUNT)[:, None].repeat(3, axis=1)
    few = palette_of(np.vstack((greys, COLOURS(np.linspace(0.0, 1.0, COLOUR_COUNT))[:, :3])))
    write_whole(Path(path), gif_bytes(pictures, few, FRAME_MS))
