"""build.gif and build.mp4: the construction, a picture a step, drawn by Pillow."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.drawing import Area, Item
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.lettering import font
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PLAIN_COLOUR, WEDGE_COLOUR, rgb
from drystone.drawing.pixels import View, gif_bytes, paint, palette_of
from drystone.drawing.wall import drawing_of_assembly
from drystone.errors import UsageError

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

LONGEST_S = 655.0
"""A GIF counts hundredths of a second, in 16 bits."""

FRAMES_PER_S = 10
"""Pictures of a step are repeated: players show films of one picture a second badly."""


def gif(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return build.gif, which loops; E138 for steps that are longer than a GIF has."""
    if settings.seconds_per_step > LONGEST_S:
        raise UsageError(
            "E138",
            f"a step of {settings.seconds_per_step:g} s is too long for build.gif.",
            where="--seconds-per-step",
            cure=f"Give {LONGEST_S:g} s at most (seconds_per_step in Python), or export an mp4.",
        )
    frames = Film(assembly, settings.film_px).frames()
    return {"build.gif": lambda: gif_bytes(frames, palette(), durations_ms(assembly, settings))}


def mp4(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return build.mp4; E186 when PyAV is not installed."""
    av = load_extra("av", "film", "E186", "build.mp4")
    return {"build.mp4": lambda: _mp4_bytes(av, assembly, settings)}


def _mp4_bytes(av: Any, assembly: Assembly, settings: ExportSettings) -> bytes:
    film = Film(assembly, settings.film_px)
    with BytesIO() as file:
        # Nothing in it tells when and by what it was made: equal walls give equal bytes.
        with av.open(file, "w", format="mp4", options={"fflags": "+bitexact"}) as out:
            stream = out.add_stream(
                "h264", rate=FRAMES_PER_S, options={"threads": "1", "flags": "+bitexact"}
            )
            stream.width, stream.height = film.size_px
            stream.pix_fmt = "yuv420p"
            for picture, ms in zip(film.frames(), durations_ms(assembly, settings), strict=True):
                for _ in range(max(1, round(ms * FRAMES_PER_S / 1000))):
                    out.mux(stream.encode(av.VideoFrame.from_image(picture)))
            out.mux(stream.encode())
        return file.getvalue()


@dataclass(frozen=True, eq=False)
class Film:
    """Pictures of a wall under construction, `width_px` wide at most."""

    assembly: Assembly
    width_px: int = 960

    @cached_property
    def view(self) -> View:
        """Where the wall is in a picture."""
        width, height = self.assembly.size
        room = self.width_px - 2 * MARGIN_PX
        per_unit = min(room / width, TALLEST * room / height)
        return View(MARGIN_PX, MARGIN_PX + float(np.ceil(height * per_unit)), per_unit)

    @cached_property
    def size_px(self) -> tuple[int, int]:
        """Width and height of a picture: even numbers, which the codecs of films ask for."""
        width = max(int(np.ceil(self.assembly.size[0] * self.view.per_unit)), 260) + 2 * MARGIN_PX
        height = int(self.view.ground_px) + GROUND_PX + CAPTION_PX
        return width + width % 2, height + height % 2

    def frames(self) -> Iterator[Image.Image]:
        """Yield a picture for every step, and one of the finished wall."""
        drawing = drawing_of_assembly(self.assembly)
        width, height = self.size_px
        big = Image.new("RGB", (width * FINER, height * FINER), "white")
        self._paint(big, drawing.layers("SITE"))
        blocks = (item for item in drawing.items if isinstance(item, Area) and item.step)
        numbers, parts = drawing.layers("NUMBERS"), self.assembly.parts
        for placed, (block, part) in enumerate(zip(blocks, parts, strict=True), 1):
            fresh = big.copy()
            stone = part.kind == "stone"
            self._paint(fresh, [replace(block, fill=PLACING_COLOUR) if stone else block])
            caption = f"step {part.step} of {len(parts)}"
            if part.under is not None:
                # Numbers in the picture are steps, so those in words are steps, too.
                caption += f": wedge under {self.assembly.part(part.under).step}"
            yield self._finished(fresh, numbers[:placed], caption)
            self._paint(big, [block])
        stones = len(list(self.assembly.stones))
        yield self._finished(big, numbers, f"{stones} stones, {len(parts) - stones} wedges")

    def _paint(self, big: Image.Image, items: tuple[Item, ...] | list[Area]) -> None:
        paint(big, items, replace(self.view, finer=FINER), px_per_pt=5.0)

    def _finished(self, big: Image.Image, numbers: tuple[Item, ...], caption: str) -> Image.Image:
        picture = big.reduce(FINER)
        paint(picture, numbers, self.view)
        place = (MARGIN_PX, self.size_px[1] - CAPTION_PX / 2)
        ImageDraw.Draw(picture).text(place, caption, OUTLINE_COLOUR, font(16), anchor="lm")
        return picture


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
