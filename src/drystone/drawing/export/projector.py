"""projector/: a picture a step, 1:1 on the wall.

The wall lies in the middle of the picture, the ground above a strip that holds the words, a bar
of 100 mm and the number of the step; marks at the wall's corners are what it is aligned by.
"""

from functools import partial
from io import BytesIO

import numpy as np
from PIL import Image, ImageDraw

from drystone.drawing.assembly.parts import Assembly, Part
from drystone.drawing.drawing import Area, Item, Lines
from drystone.drawing.export.formats import ExportSettings, Files
from drystone.drawing.lettering import font
from drystone.drawing.pixels import View, paint
from drystone.errors import UsageError

BRIGHT, DIM, WORDS = 255, 80, 170
STRIP_PX = 84
"""Below the ground: words and the bar."""

EDGE_PX = 14
MARK_PX = 24
CROSS_PX = 11
BAR_M = 0.1


def projector(assembly: Assembly, settings: ExportSettings) -> Files:
    """Return a picture of the empty wall, which the projector is aligned by, and one a step.

    E187 when the wall, marks included, is not in the picture of the projector.
    """
    view = _view(assembly, settings)
    parts: list[Part | None] = [None, *assembly.parts]
    return {
        f"projector/step_{part.step if part else 0:03d}.png": partial(
            _picture, assembly, settings, view, part
        )
        for part in parts
    }


def _view(assembly: Assembly, settings: ExportSettings) -> View:
    (wide, high), per_m = settings.projector_px, settings.projector_px_per_m
    width_m, height_m = assembly.size
    width, height = width_m * per_m, height_m * per_m
    left, bottom = settings.projector_offset_px or (round((wide - width) / 2), STRIP_PX)
    if min(left, wide - left - width, bottom, high - bottom - height) >= EDGE_PX:
        return View(left, high - bottom, per_m)
    fits = min((wide - 2 * EDGE_PX) / width_m, (high - STRIP_PX - EDGE_PX) / height_m)
    raise UsageError(
        "E187",
        f"a wall of {width_m:.3g} m x {height_m:.3g} m at {per_m:g} px a metre is {width:.0f} x "
        f"{height:.0f} px, and with its margins that is more than the projector's {wide} x {high}.",
        where="--projector",
        cure=f"Move the projector away: --projector {wide}x{high}@{int(fits)} is the largest that "
        "fits.",
    )


def _picture(assembly: Assembly, settings: ExportSettings, view: View, part: Part | None) -> bytes:
    picture = Image.new("L", settings.projector_px, 0)
    there = assembly.parts[: part.step - 1 if part else 0]
    items: list[Item] = [_site(assembly, view, DIM if part else BRIGHT)]
    items += [Area(p.name, (p.corners,), line=_grey(DIM), width_pt=2.0) for p in there]
    if part is not None:
        items.append(Area(part.name, (part.corners,), line=_grey(BRIGHT), width_pt=4.0))
        reach = min(CROSS_PX / view.per_unit, 0.3 * float(np.ptp(part.corners, axis=0).min()))
        arms = np.array([[(-reach, 0.0), (reach, 0.0)], [(0.0, -reach), (0.0, reach)]])
        items.append(Lines("", [*(part.centroid + arms)], _grey(BRIGHT), 2.0))
    paint(picture, items, view)
    _words(picture, assembly, view, part)
    with BytesIO() as file:
        picture.save(file, format="PNG")
        return file.getvalue()


def _site(assembly: Assembly, view: View, level: int) -> Lines:
    """Return the ground, and the marks at the wall's corners, which point into the wall."""
    width, height = assembly.size
    long, short = MARK_PX / view.per_unit, min(MARK_PX, EDGE_PX - 2) / view.per_unit
    lines = [np.array([(0.0, 0.0), (width, 0.0)])]
    for x, sign_x in ((0.0, 1.0), (width, -1.0)):
        for y, sign_y in ((0.0, 1.0), (height, -1.0)):
            lines.append(np.array([(x + sign_x * long, y), (x - sign_x * short, y)]))
            lines.append(np.array([(x, y + sign_y * long), (x, y - sign_y * short)]))
    return Lines("site", lines, _grey(level), 1.0)


def _words(picture: Image.Image, assembly: Assembly, view: View, part: Part | None) -> None:
    """Write the step and what it is, and draw the bar, all in the strip below the wall."""
    draw, (wide, high) = ImageDraw.Draw(picture), picture.size
    length = BAR_M * view.per_unit
    right, y = wide - EDGE_PX - 1, high - EDGE_PX - 8
    draw.line([(right - length, y), (right, y)], WORDS, 3)
    for x in (right - length, right):
        draw.line([(x, y - 7), (x, y + 7)], WORDS, 1)
    # Beside the bar: at low resolution it is shorter than its name.
    draw.text((right - length - 10, y), "100 mm", WORDS, font(18), anchor="rm")
    name = f"{part.step if part else 0} / {len(assembly.parts)}"
    what = (
        part.name.replace("_", " ") if part else
        f"align: the wall's lower left corner is {view.left_px:.0f} px from the left, "
        f"{high - view.ground_px:.0f} px from the lower edge; {view.per_unit:g} px are 1 m"
    )  # fmt: skip
    y = high - EDGE_PX - 16
    draw.text((EDGE_PX, y), name, BRIGHT, font(40, bold=True), anchor="lm")
    end = EDGE_PX + draw.textlength(name, font(40, bold=True))
    draw.text((end + 24, y), what, WORDS, font(20), anchor="lm")


def _grey(level: int) -> str:
    return f"#{level:02x}{level:02x}{level:02x}"
