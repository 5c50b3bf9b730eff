"""The construction as a film: a picture a step, drawn by Pillow because there are many."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from PIL import Image, ImageDraw

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.gif import palette_of
from drystone.drawing.lettering import font
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PLAIN_COLOUR, WEDGE_COLOUR, rgb

PLACING_COLOUR = "#f0a202"
"""Of the stone that a step places: apart from the others and the wedges in grey, too."""

FINER = 3
"""Px are drawn this many times finer and then averaged, which smooths the edges."""

MARGIN_PX, GROUND_PX, CAPTION_PX = 16, 12, 30
TALLEST = 0.75
"""Height of a picture over its largest width."""

HOLD_S = 3.0
"""How long the finished wall stays."""

TINTS = 6
"""Colours between each two that smoothed edges are reduced to."""


@dataclass(frozen=True, eq=False)
class Film:
    """Pictures of a wall under construction.

    Parameters
    ----------
    assembly : Assembly
        The wall.
    width_px : int
        Of a picture, at most.
    """

    assembly: Assembly
    width_px: int = 960

    @cached_property
    def per_unit(self) -> float:
        """Px in a unit of the assembly."""
        width, height = self.assembly.size
        room = self.width_px - 2 * MARGIN_PX
        return float(min(room / width, TALLEST * room / height))

    @cached_property
    def size_px(self) -> tuple[int, int]:
        """Width and height of a picture: even numbers, which the codecs of films ask for."""
        width, height = (int(np.ceil(side * self.per_unit)) for side in self.assembly.size)
        width = max(width, 260) + 2 * MARGIN_PX
        height += MARGIN_PX + GROUND_PX + CAPTION_PX
        return width + width % 2, height + height % 2

    def pixels(self, part: Part) -> list[tuple[float, float]]:
        """Return the outline of a part in a picture: px from its top left corner, y down."""
        points = part.corners * self.per_unit
        x, y = MARGIN_PX + points[:, 0], self._ground_px - points[:, 1]
        return list(zip(x.tolist(), y.tolist(), strict=True))

    def frames(self) -> Iterator[Image.Image]:
        """Yield a picture for every step, and one of the finished wall.

        Yields
        ------
        Image
            RGB, all of one size.
        """
        big = self._ground()
        placed: list[Part] = []
        count = len(self.assembly.parts)
        for part in self.assembly.parts:
            fresh = big.copy()
            self._draw(fresh, part, WEDGE_COLOUR if part.kind == "wedge" else PLACING_COLOUR)
            placed.append(part)
            yield self._finish(fresh, placed, self._caption(part))
            self._draw(big, part, WEDGE_COLOUR if part.kind == "wedge" else PLAIN_COLOUR)
        stones = sum(part.kind == "stone" for part in placed)
        yield self._finish(big, placed, f"{stones} stones, {count - stones} wedges")

    def _caption(self, part: Part) -> str:
        """Name the step; numbers in the picture are steps, so those in words are steps, too."""
        words = f"step {part.step} of {len(self.assembly.parts)}"
        if part.under is None:
            return words
        return f"{words}: wedge under {self.assembly.part(part.under).step}"

    @property
    def _ground_px(self) -> float:
        return float(self.size_px[1] - CAPTION_PX - GROUND_PX)

    def _ground(self) -> Image.Image:
        width, height = self.size_px
        big = Image.new("RGB", (width * FINER, height * FINER), "white")
        draw = ImageDraw.Draw(big)
        y, below = self._ground_px * FINER, GROUND_PX * FINER
        for x in range(-below, width * FINER, 8 * FINER):
            draw.line([(x, y + below), (x + below, y)], fill=GREY, width=FINER)
        top = self._ground_px - self.assembly.size[1] * self.per_unit
        right = MARGIN_PX + self.assembly.size[0] * self.per_unit
        frame = [(MARGIN_PX, self._ground_px), (MARGIN_PX, top), (right, top),
                 (right, self._ground_px)]  # fmt: skip
        draw.line([(x * FINER, y * FINER) for x, y in frame], fill=GREY, width=FINER)
        draw.line([(0, y), (width * FINER, y)], fill=OUTLINE_COLOUR, width=2 * FINER)
        return big

    def _draw(self, big: Image.Image, part: Part, fill: str) -> None:
        draw = ImageDraw.Draw(big)
        points = [(x * FINER, y * FINER) for x, y in self.pixels(part)]
        draw.polygon(points, fill=fill)
        draw.line([*points, points[0]], fill=OUTLINE_COLOUR, width=FINER + 1, joint="curve")

    def _finish(self, big: Image.Image, placed: list[Part], caption: str) -> Image.Image:
        picture = big.reduce(FINER)
        draw = ImageDraw.Draw(picture)
        for part in placed:
            if part.kind == "stone":
                self._number(draw, part)
        place = (MARGIN_PX, self.size_px[1] - CAPTION_PX / 2)
        draw.text(place, caption, fill=OUTLINE_COLOUR, font=font(16), anchor="lm")
        return picture

    def _number(self, draw: ImageDraw.ImageDraw, part: Part) -> None:
        width, height = np.ptp(np.array(self.pixels(part)), axis=0)
        size = 0.6 * min(height, width / (0.62 * len(str(part.step))))
        x, y = part.centroid
        place = (MARGIN_PX + x * self.per_unit, self._ground_px - y * self.per_unit)
        chosen = font(float(np.clip(size, 7.0, 20.0)))
        draw.text(place, str(part.step), fill=OUTLINE_COLOUR, font=chosen, anchor="mm")


def palette() -> Image.Image:
    """Return the palette of films: their colours, and tints of these with black and white."""
    dark, white = np.array(rgb(OUTLINE_COLOUR)), np.ones(3)
    rows = [dark, white, np.array(rgb(GREY))]
    for name in (PLAIN_COLOUR, PLACING_COLOUR, WEDGE_COLOUR, "#ffffff"):
        colour = np.array(rgb(name))
        for other in (dark, white):
            shares = np.linspace(0.0, 1.0, TINTS)[:, None]
            rows.extend((1.0 - shares) * colour + shares * other)
    return palette_of(np.unique(np.round(rows, 6), axis=0))


def durations_ms(assembly: Assembly, settings: ExportSettings) -> list[int]:
    """Return how long each picture is shown: whole hundredths of a second, as GIFs count."""
    step = max(2, round(100 * settings.seconds_per_step)) * 10
    return [step] * len(assembly.parts) + [max(step, round(1000 * HOLD_S))]
