"""Pictures of every step, drawn by Pillow: build.gif, build.mp4, and projector/, 1:1 on the wall.

In a projector's picture the wall lies in the middle, the ground above a strip that holds the words,
a bar of 100 mm and the number of the step; marks at the wall's corners are what it is aligned by.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from io import BytesIO

import numpy as np
from PIL import Image, ImageChops, ImageDraw

from drystone.drawing.assembly import Assembly
from drystone.drawing.drawing import Drawable, Lines, Surface, drawing_of_assembly
from drystone.drawing.export.formats import ExportSettings, Files, load_extra
from drystone.drawing.lettering import font
from drystone.drawing.palette import GREY, OUTLINE_COLOUR, PLAIN_COLOUR, WEDGE_COLOUR, rgb
from drystone.drawing.pixels import PixelView, gif_bytes, paint, palette_of
from drystone.errors import UsageError

PLACING_COLOUR = "#f0a202"
"""Of the stone that a step places: apart from the others and the wedges in grey, too."""

FINER = 3  # px are drawn this many times finer and then averaged, which smooths the edges
MARGIN_PX, GROUND_PX, CAPTION_PX = 16, 12, 30
TALLEST = 0.75  # height of a picture over its largest width
HOLD_S = 3.0  # how long the finished wall stays
TINTS = 6  # colours between each two that smoothed edges are reduced to
LONGEST_S = 655.0  # A GIF counts hundredths of a second, in 16 bits
FRAMES_PER_S = 10
"""Pictures of a step are repeated: players show films of one picture a second badly."""


def gif(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return build.gif, which loops; E138 for steps that are longer than a GIF has."""
    if settings.seconds_per_step > LONGEST_S:
        what = f"a step of {settings.seconds_per_step:g} s is too long for build.gif."
        cure = f"Give {LONGEST_S:g} s at most (seconds_per_step in Python), or export an mp4."
        raise UsageError("E138", what, where="--seconds-per-step", cure=cure)
    frames = Film(assembly).frames()
    return {"build.gif": gif_bytes(frames, palette(), durations_ms(assembly, settings))}


def mp4(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return build.mp4; E186 when PyAV is not installed."""
    av = load_extra("av", "film", "E186", "build.mp4")
    film = Film(assembly)
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
        return {"build.mp4": file.getvalue()}


@dataclass(frozen=True, eq=False)
class Film:
    """Pictures of a wall under construction, `width_px` wide at most."""

    assembly: Assembly
    width_px: int = 960

    @cached_property
    def view(self) -> PixelView:
        """Where the wall is in a picture."""
        width, height = self.assembly.size
        room = self.width_px - 2 * MARGIN_PX
        per_unit = min(room / width, TALLEST * room / height)
        return PixelView(MARGIN_PX, MARGIN_PX + float(np.ceil(height * per_unit)), per_unit)

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
        blocks = (item for item in drawing.items if isinstance(item, Surface) and item.step)
        # Numbers on white, which pictures are multiplied by: each is written once.
        written = Image.new("RGB", self.size_px, "white")
        numbers, parts = drawing.layers("NUMBERS"), self.assembly.parts
        for block, number, part in zip(blocks, numbers, parts, strict=True):
            fresh = big.copy()
            paint(written, [number], self.view)
            stone = part.kind == "stone"
            self._paint(fresh, [replace(block, fill=PLACING_COLOUR) if stone else block])
            caption = f"step {part.step} of {len(parts)}"
            if part.under is not None:
                # Numbers in the picture are steps, so those in words are steps, too.
                caption += f": wedge under {self.assembly.part(part.under).step}"
            yield self._finished(fresh, written, caption)
            self._paint(big, [block])
        stones = len(list(self.assembly.stones))
        yield self._finished(big, written, f"{stones} stones, {len(parts) - stones} wedges")

    def _paint(self, big: Image.Image, items: tuple[Drawable, ...] | list[Surface]) -> None:
        paint(big, items, replace(self.view, finer=FINER), px_per_pt=5.0)

    def _finished(self, big: Image.Image, written: Image.Image, caption: str) -> Image.Image:
        picture = ImageChops.multiply(big.reduce(FINER), written)
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


BRIGHT, DIM, WORDS = "#ffffff", "#505050", "#aaaaaa"
STRIP_PX = 84  # below the ground: words and the bar
EDGE_PX = 14
MARK_PX = 24
CROSS_PX = 11
BAR_M = 0.1


def projector(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return a picture of the empty wall, which the projector is aligned by, and one a step.

    E187 when the wall, marks included, is not in the picture of the projector.
    """
    view = _view(assembly, settings)
    return {
        f"projector/step_{step:03d}.png": _picture(assembly, settings, view, step)
        for step in range(len(assembly.parts) + 1)
    }


def _view(assembly: Assembly, settings: ExportSettings) -> PixelView:
    (wide, high), per_m = settings.projector_px, settings.projector_px_per_m
    width_m, height_m = assembly.size
    width, height = width_m * per_m, height_m * per_m
    left = round((wide - width) / 2)
    if min(left, wide - left - width, high - STRIP_PX - height) >= EDGE_PX:
        return PixelView(left, high - STRIP_PX, per_m)
    fits = int(min((wide - 2 * EDGE_PX) / width_m, (high - STRIP_PX - EDGE_PX) / height_m))
    away = f"Move the projector away: --projector {wide}x{high}@{fits} is the largest that fits."
    raise UsageError(
        "E187",
        f"a wall of {width_m:.3g} m x {height_m:.3g} m at {per_m:g} px a metre is {width:.0f} x "
        f"{height:.0f} px. With margins that is more than the projector's {wide} x {high}.",
        where="--projector",
        cure=away if fits > 0 else "Take a projector of more px.",
    )


def _picture(assembly: Assembly, settings: ExportSettings, view: PixelView, step: int) -> bytes:
    """Draw a step; 0 is the empty wall."""
    picture = Image.new("L", settings.projector_px, 0)
    items: list[Drawable] = [_site(assembly, view, DIM if step else BRIGHT)]
    if step:
        *there, part = assembly.parts[:step]
        items += [Surface(p.name, (p.corners,), line=DIM, width_pt=2.0) for p in there]
        items.append(Surface(part.name, (part.corners,), line=BRIGHT, width_pt=4.0))
        reach = min(CROSS_PX / view.per_unit, 0.3 * float(np.ptp(part.corners, axis=0).min()))
        arms = np.array([[(-reach, 0.0), (reach, 0.0)], [(0.0, -reach), (0.0, reach)]])
        items.append(Lines("", [*(part.centroid + arms)], BRIGHT, 2.0))
    paint(picture, items, view)
    _words(picture, assembly, view, step)
    with BytesIO() as file:
        picture.save(file, format="PNG")
        return file.getvalue()


def _site(assembly: Assembly, view: PixelView, colour: str) -> Lines:
    """Return the ground, and the marks at the wall's corners, which point into the wall."""
    width, height = assembly.size
    long, short = MARK_PX / view.per_unit, min(MARK_PX, EDGE_PX - 2) / view.per_unit
    lines = [np.array([(0.0, 0.0), (width, 0.0)])]
    for x, sign_x in ((0.0, 1.0), (width, -1.0)):
        for y, sign_y in ((0.0, 1.0), (height, -1.0)):
            lines.append(np.array([(x + sign_x * long, y), (x - sign_x * short, y)]))
            lines.append(np.array([(x, y + sign_y * long), (x, y - sign_y * short)]))
    return Lines("site", lines, colour, 1.0)


def _words(picture: Image.Image, assembly: Assembly, view: PixelView, step: int) -> None:
    """Write the step and what it is, and draw the bar, all in the strip below the wall."""
    draw, (wide, high) = ImageDraw.Draw(picture), picture.size
    length = BAR_M * view.per_unit
    right, y = wide - EDGE_PX - 1, high - EDGE_PX - 8
    draw.line([(right - length, y), (right, y)], WORDS, 3)
    for x in (right - length, right):
        draw.line([(x, y - 7), (x, y + 7)], WORDS, 1)
    # Beside the bar: at low resolution it is shorter than its name.
    draw.text((right - length - 10, y), "100 mm", WORDS, font(18), anchor="rm")
    name = f"{step} / {len(assembly.parts)}"
    what = (
        assembly.parts[step - 1].name.replace("_", " ") if step else
        f"align: the wall's lower left corner is {view.left_px:.0f} px from the left, "
        f"{high - view.ground_px:.0f} px from the lower edge; {view.per_unit:g} px are 1 m"
    )  # fmt: skip
    y = high - EDGE_PX - 16
    draw.text((EDGE_PX, y), name, BRIGHT, font(40, bold=True), anchor="lm")
    end = EDGE_PX + draw.textlength(name, font(40, bold=True))
    draw.text((end + 24, y), what, WORDS, font(20), anchor="lm")
