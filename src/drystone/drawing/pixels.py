"""Drawings by Pillow, where there are many of one wall, and the GIFs that they make."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import BytesIO

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw

from drystone.drawing.drawing import Drawable, Lines, Surface, Words, letters_pt
from drystone.drawing.lettering import font
from drystone.drawing.palette import OUTLINE_COLOUR
from drystone.model.plan import Point

HATCH_PX = 8  # between the strokes of a hatched area
SMALLEST_PX, LARGEST_PX = 7.0, 20.0  # of numbers


@dataclass(frozen=True)
class PixelView:
    """Where a wall is in a picture.

    Its lower left corner is so many px from the picture's upper left one.  The picture is drawn
    `finer` times finer than it will be.
    """

    left_px: float
    ground_px: float
    per_unit: float
    finer: int = 1

    def pixels(self, points: ArrayLike) -> list[Point]:
        """Return points of the wall in the picture, y down."""
        x, y = np.asarray(points, float).reshape(-1, 2).T * self.per_unit
        there = np.column_stack([self.left_px + x, self.ground_px - y]) * self.finer
        return [(float(x), float(y)) for x, y in there]


def paint(
    picture: Image.Image, items: Iterable[Drawable], view: PixelView, px_per_pt: float = 1.0
) -> None:
    """Draw areas, lines and numbers on a picture; what is written beside things is left out."""
    draw = ImageDraw.Draw(picture)

    def width(points: float) -> int:
        return max(1, round(points * px_per_pt))

    for item in items:
        if isinstance(item, Surface) and item.hatch:
            corners = view.pixels(item.loops[0])
            (left, top), (right, low) = np.min(corners, axis=0), np.max(corners, axis=0)
            deep = low - top
            for x in np.arange(left, right - deep, HATCH_PX * view.finer):
                draw.line([(x, low), (x + deep, top)], item.line, view.finer)
        elif isinstance(item, Surface):
            for loop in item.loops:
                points = view.pixels(loop)
                if item.fill != "none":
                    draw.polygon(points, fill=item.fill)
                draw.line([*points, points[0]], item.line, width(item.width_pt), joint="curve")
        elif isinstance(item, Lines):
            for line in item.lines:
                draw.line(view.pixels(line), item.colour, width(float(np.max(item.width_pt))))
        elif isinstance(item, Words) and not item.beside:
            size = letters_pt(item.text, *(side * view.per_unit for side in item.room))
            chosen = font(float(np.clip(size, SMALLEST_PX, LARGEST_PX)))
            (at,) = view.pixels(item.at)
            draw.text(at, item.text, OUTLINE_COLOUR, chosen, anchor="mm")


def palette_of(colours: ArrayLike) -> Image.Image:
    """Return the palette that pictures are reduced to: at most 256 colours (n, 3) in [0, 1]."""
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.rint(255 * np.asarray(colours, float)).astype(np.uint8).tobytes())
    return palette


def gif_bytes(
    pictures: Iterable[Image.Image], palette: Image.Image, duration_ms: int | Sequence[int]
) -> bytes:
    """Return a GIF that loops, of RGB pictures of one size.

    All frames have one palette, of :func:`palette_of`: colours chosen from a picture would tint its
    black lines, and differ from frame to frame.

    >>> two = [Image.new("RGB", (4, 4), colour) for colour in ("black", "white")]
    >>> gif_bytes(two, palette_of([[0, 0, 0], [1, 1, 1]]), 80)[:6]
    b'GIF89a'
    """
    first, *others = (
        picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures
    )
    with BytesIO() as file:
        first.save(
            file, format="GIF", save_all=True, append_images=others, duration=duration_ms, loop=0,
            disposal=1, optimize=False,
        )  # fmt: skip
        return file.getvalue()
