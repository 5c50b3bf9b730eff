"""projector/: a picture a step, 1:1 on the wall.

The wall lies in the middle of the picture, the ground above a strip that holds the words, a bar
of 100 mm and the number of the step; marks at the wall's corners are what it is aligned by.
"""

from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.export.settings import ExportSettings
from drystone.drawing.lettering import font
from drystone.errors import UsageError
from drystone.whole_files import write_whole

FOLDER = "projector"

BRIGHT, DIM, WORDS = 255, 80, 170
STRIP_PX = 84
"""Below the ground: words and the bar."""

EDGE_PX = 14
MARK_PX = 24
CROSS_PX = 11
BAR_M = 0.1


@dataclass(frozen=True, eq=False)
class Projection:
    """Where things of the wall are in the picture of a projector.

    Parameters
    ----------
    assembly : Assembly
        In metres.
    settings : ExportSettings
        The projector's px, how many are a metre, and where the wall begins.
    """

    assembly: Assembly
    settings: ExportSettings

    @cached_property
    def wall_px(self) -> tuple[float, float]:
        """Width and height of the wall."""
        width, height = self.assembly.size
        return width * self.settings.projector_px_per_m, height * self.settings.projector_px_per_m

    @cached_property
    def offset_px(self) -> tuple[float, float]:
        """The wall's lower left corner, from the picture's lower left corner."""
        if self.settings.projector_offset_px is not None:
            x, y = self.settings.projector_offset_px
            return float(x), float(y)
        return float(round((self.settings.projector_px[0] - self.wall_px[0]) / 2)), STRIP_PX

    def point(self, x_m: float, y_m: float) -> tuple[float, float]:
        """Return a point of the wall in the picture: px from its top left corner, y down."""
        left, bottom = self.offset_px
        per_m = self.settings.projector_px_per_m
        return left + x_m * per_m, self.settings.projector_px[1] - bottom - y_m * per_m

    def corners(self, part: Part) -> list[tuple[float, float]]:
        """Return the outline of a part in the picture, closed."""
        points = [self.point(x, y) for x, y in part.corners.tolist()]
        return [*points, points[0]]

    def require_room(self) -> None:
        """Raise UsageError (E187) when the wall is not in the picture, marks included."""
        (left, bottom), (width, height) = self.offset_px, self.wall_px
        room = self.settings.projector_px
        spare = (left, room[0] - left - width, bottom, room[1] - bottom - height)
        if min(spare) >= EDGE_PX:
            return
        wall = self.assembly.size
        fits = min((room[0] - 2 * EDGE_PX) / wall[0], (room[1] - STRIP_PX - EDGE_PX) / wall[1])
        raise UsageError(
            "E187",
            f"a wall of {wall[0]:.3g} m x {wall[1]:.3g} m at {self.settings.projector_px_per_m:g} "
            f"px a metre is {width:.0f} x {height:.0f} px, and with its margins that is more than "
            f"the projector's {room[0]} x {room[1]}.",
            where="--projector",
            cure=f"Move the projector away: --projector {room[0]}x{room[1]}@{int(fits)} is the "
            "largest that fits.",
        )


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:
    """Return the names that will be written: step 0 shows what the projector is aligned by.

    Raises
    ------
    UsageError
        E131 without a scale; E187 when the wall is not in the picture of the projector.
    """
    assembly.require_scale("what a projector shows")
    Projection(assembly, settings).require_room()
    return tuple(f"{FOLDER}/step_{step:03d}.png" for step in _numbers(assembly))


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:
    """Write a picture of the empty wall, and one a step.

    Raises
    ------
    UsageError
        E131 without a scale; E187 when the wall is not in the picture of the projector.
    """
    assembly.require_scale("what a projector shows")
    projection = Projection(assembly, settings)
    projection.require_room()
    (folder / FOLDER).mkdir(exist_ok=True)
    aligning, standing = _empty(projection, BRIGHT), _empty(projection, DIM)
    written = [_save(_titled(projection, aligning, None), folder, 0)]
    for part in assembly.parts:
        picture = _titled(projection, standing, part)
        _draw_placing(projection, picture, part)
        written.append(_save(picture, folder, part.step))
        line = projection.corners(part)
        ImageDraw.Draw(standing).line(line, fill=DIM, width=2, joint="curve")
    return tuple(written)


def _numbers(assembly: Assembly) -> list[int]:
    return [0, *(part.step for part in assembly.parts)]


def _empty(projection: Projection, level: int) -> Image.Image:
    """Return the ground, the marks at the wall's corners and the bar."""
    picture = Image.new("L", projection.settings.projector_px, 0)
    draw = ImageDraw.Draw(picture)
    width, height = projection.assembly.size
    for x, sign_x in ((0.0, -1), (width, 1)):
        for y, sign_y in ((0.0, 1), (height, -1)):
            at_x, at_y = projection.point(x, y)
            reach = min(MARK_PX, EDGE_PX - 2)
            draw.line([(at_x - MARK_PX * sign_x, at_y), (at_x + reach * sign_x, at_y)], level, 1)
            draw.line([(at_x, at_y - MARK_PX * sign_y), (at_x, at_y + reach * sign_y)], level, 1)
    draw.line([projection.point(0.0, 0.0), projection.point(width, 0.0)], level, 1)
    _draw_bar(projection, draw)
    return picture


def _draw_bar(projection: Projection, draw: ImageDraw.ImageDraw) -> None:
    wide, high = projection.settings.projector_px
    length = BAR_M * projection.settings.projector_px_per_m
    right, y = wide - EDGE_PX - 1, high - EDGE_PX - 8
    draw.line([(right - length, y), (right, y)], WORDS, 3)
    for x in (right - length, right):
        draw.line([(x, y - 7), (x, y + 7)], WORDS, 1)
    # Beside the bar: at low resolution it is shorter than its name.
    draw.text((right - length - 10, y), "100 mm", WORDS, font(18), anchor="rm")


def _titled(projection: Projection, standing: Image.Image, part: Part | None) -> Image.Image:
    picture = standing.copy()
    draw, high = ImageDraw.Draw(picture), projection.settings.projector_px[1]
    steps = len(projection.assembly.parts)
    name = f"{part.step} / {steps}" if part else f"0 / {steps}"
    left, bottom = projection.offset_px
    what = (
        f"{part.name.replace('_', ' ')}" if part else
        f"align: the wall's lower left corner is {left:.0f} px from the left, {bottom:.0f} px "
        f"from the lower edge; {projection.settings.projector_px_per_m:g} px are 1 m"
    )  # fmt: skip
    y = high - EDGE_PX - 16
    draw.text((EDGE_PX, y), name, BRIGHT, font(40, bold=True), anchor="lm")
    end = EDGE_PX + draw.textlength(name, font(40, bold=True))
    draw.text((end + 24, y), what, WORDS, font(20), anchor="lm")
    return picture


def _draw_placing(projection: Projection, picture: Image.Image, part: Part) -> None:
    draw = ImageDraw.Draw(picture)
    draw.line(projection.corners(part), BRIGHT, 4, joint="curve")
    x, y = projection.point(*part.centroid)
    size = np.ptp(part.corners, axis=0).min() * projection.settings.projector_px_per_m
    reach = min(CROSS_PX, 0.3 * float(size))
    draw.line([(x - reach, y), (x + reach, y)], BRIGHT, 2)
    draw.line([(x, y - reach), (x, y + reach)], BRIGHT, 2)


def _save(picture: Image.Image, folder: Path, step: int) -> Path:
    path = folder / FOLDER / f"step_{step:03d}.png"
    with BytesIO() as file:
        picture.save(file, format="PNG")
        write_whole(path, file.getvalue())
    return path
