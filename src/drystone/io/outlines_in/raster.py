"""Outlines of a file to patches of pixels, at the resolution of the file or of the settings."""

import math
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.files import file_bytes, listed, naming, short
from drystone.io.images import ORIENTATION, check_size, format_of, opened
from drystone.io.outlines_in import model
from drystone.io.outlines_in.model import OutlinedStone, OutlineFile
from drystone.io.outlines_in.nested import meeting_boxes, not_stones, of_one_picture, said_of
from drystone.io.outlines_in.silhouettes import outer_edge
from drystone.io.patches import PlacedMask, StonePatch
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points

_TOO_FAR = (
    "Is something drawn far away from the stones, or in another unit? Remove it, give a smaller "
    "--px-per-m (px_per_m in Python), or raise max_image_mpx in Python."
)

_BEYOND = 0.5
"""How far an outline of shares may reach over the picture, as a share of it."""
USUAL_SIDE_PX = 160.0
_MOST_EMPTY, _FAR_PX = 32.0, 2e8
"""Squares of that side in the picture for each stone; a picture beyond so many pixels is refused,
for something was drawn far away."""


def in_px(file: OutlineFile, settings: ReadSettings) -> OutlineFile:
    """Return a file whose shares of the picture (as of YOLO) are px; all others as they are.

    They are told by the whole file: in px, no stone of it would have a pixel.  Its proportions are
    those of the picture; where the file does not say its size (E116), `image` names the picture.
    """
    rings = [ring for stone in file.stones for ring in stone.rings]
    is_of_px = file.unit_m is None and file.seen_by != "none" and max(file.size_px or (3,)) >= 3
    if not (rings and is_of_px) or any(stone.masks for stone in file.stones):
        return file
    points = np.concatenate(rings)
    if not (points.min() >= -_BEYOND and points.max() <= 1.0 + _BEYOND):
        return file
    size = file.size_px or _size_of(settings.image)
    if size is None:
        what = "its coordinates are shares of a picture (0 ... 1), and it does not say its size."
        cure = "Name the picture with --image PHOTO.jpg (ReadSettings.image), or export in px."
        raise InputError("E116", what, cure=cure)
    stones = [stone.moved(lambda ring: np.asarray(ring * size)) for stone in file.stones]
    text = f"its coordinates are shares of the picture: taken times {size[0]} x {size[1]} px."
    return replace(file, stones=stones, size_px=size, notices=[*file.notices, Notice("W119", text)])


def _size_of(image: str) -> tuple[int, int] | None:
    """Return width and height of a picture as it is seen; None when no file is named."""
    path = Path(image)
    if not image or not path.is_file():
        return None
    data = file_bytes(path)
    if not format_of(data):
        return None
    with naming(path.name), opened(data, lambda *_: None) as picture:
        width, height = picture.size
        turned = picture.getexif().get(ORIENTATION, 1) in {5, 6, 7, 8}
    return (height, width) if turned else (width, height)


def rastered(
    file: OutlineFile, settings: ReadSettings
) -> tuple[list[StonePatch], tuple[int, int], float | None, list[Notice]]:
    """Turn outlines of stones that have ids into patches, which may overlap.

    Beside them stand the width and height of their picture, px, and its scale, px a metre, which
    is None for a file in px.

    A file in px keeps its own px.  A drawing is drawn in the box around all its stones, whose
    lower left corner becomes that of the picture; without a resolution in the settings the longer
    side of the median stone has about `USUAL_SIDE_PX`.
    """
    if not file.stones:
        cure = "; ".join(notice.message for notice in file.notices) or "Draw outlines."
        raise LabelImageError("E104", "there are no stones in it.", cure=cure)
    notices: list[Notice] = []
    px_per_m = None if file.unit_m is None else settings.px_per_m
    if file.unit_m is not None and px_per_m is None:
        px_per_m, notice = _usual_scale(file, file.unit_m)
        notices.append(notice)
    stones, (width, height) = _in_picture(file, px_per_m)
    check_size(width, height, settings.max_px, _TOO_FAR)
    if file.unit_m is None and file.size_px is None:
        text = f"it does not say how large its picture is: taken as {width} x {height} px."
        cure = "y of a plan counts up from the lower end of the lowest stone."
        notices.append(Notice("W119", text, cure))
    model.check_reach(stones, settings.max_px)
    places = [model.pixels_of(stone) for stone in stones]
    left = {} if file.seen_by == "none" else _not_stones(file, places, (width, height), settings)
    if left:
        said = said_of(left, len(stones), {stone.id or 0: stone.name for stone in stones})
        kept = [stone for stone in file.stones if stone.id not in left]
        rest = replace(file, stones=kept, seen_by="none")
        patches, size_px, px_per_m, others = rastered(rest, settings)
        return patches, size_px, px_per_m, [said, *others]
    patches, lost, empty = [], [], []
    picture = PlacedMask(np.broadcast_to(np.True_, (height, width)), 0, 0)
    for stone, inside in zip(stones, places, strict=True):
        name = f"stone {stone.id} ({short(stone.name)})" if stone.name else f"stone {stone.id}"
        placed = inside
        if inside is not None and (within := inside.shared(picture)[0]).shape != inside.mask.shape:
            placed = model.trimmed(PlacedMask(within, max(0, inside.row), max(0, inside.col)))
            outside = int(inside.mask.sum()) - int(within.sum())
            if outside and stone.id not in settings.skip:
                lost.append(f"{name}: {outside} px")
        if placed is None:
            empty.append(name)
            continue
        place = placed.mask, placed.row, placed.col
        drawn = _drawn(stone, width, height)
        patches.append(StonePatch(*place, stone.id or 0, height, None, stone.name, drawn))
    if lost:
        notices.append(Notice("W119", f"outside the image, cut off: {listed(lost, '; ')}."))
    if empty:
        notices.append(Notice("W119", f"without a pixel, left out: {listed(empty, '; ')}."))
    patches, overlaps = _beside_others(patches, settings.skip)
    return patches, (width, height), px_per_m, notices + overlaps


def _not_stones(
    file: OutlineFile,
    places: Sequence[PlacedMask | None],
    size_px: tuple[int, int],
    settings: ReadSettings,
) -> dict[int, str]:
    """Return what is not a stone of its own, by its id; what is skipped does not count."""
    masks = {
        stone.id or 0: mask
        for stone, mask in zip(file.stones, places, strict=True)
        if mask is not None and stone.id not in settings.skip
    }
    if file.seen_by == "either" and not (masks and of_one_picture(list(masks.values()))):
        return {}
    return not_stones(masks, size_px, settings.keep, by_program=file.seen_by != "people")


def _usual_scale(file: OutlineFile, unit: float) -> tuple[float, Notice]:
    """Choose a scale of two digits for which the median stone has a usual size.

    It is less where they lie so far apart that almost all of their picture would be empty.
    """
    corners = [_corners(stone) for stone in file.stones]
    side = float(np.median([np.ptp(one, axis=0).max() * unit for one in corners]))
    if not side > 0.0:
        raise LabelImageError("E104", "the stones have no area.", cure="Draw closed outlines.")
    exact = USUAL_SIDE_PX / side
    whole_px = float(np.ptp(np.concatenate(corners), axis=0).prod()) * (unit * exact) ** 2
    if whole_px < _FAR_PX:
        exact *= min(
            1.0, USUAL_SIDE_PX * math.sqrt(_MOST_EMPTY * len(corners) / max(whole_px, 1.0))
        )
    step = 10.0 ** (math.floor(math.log10(exact)) - 1)
    px_per_m = float(f"{round(exact / step) * step:.2g}")
    text = (
        f"the longer side of the median stone is {side:.3g} m; drawn at {px_per_m:g} px a metre, "
        f"it is {side * px_per_m:.0f} px long."
    )
    return px_per_m, Notice("W119", text, "Choose another with --px-per-m (px_per_m in Python).")


def _corners(stone: OutlinedStone) -> Points:
    return np.concatenate(stone.rings) if stone.areas else np.zeros((1, 2))


def _in_picture(
    file: OutlineFile, px_per_m: float | None
) -> tuple[Sequence[OutlinedStone], tuple[int, int]]:
    """Return stones in px with y down, and the size of the picture."""
    scale = 1.0 if px_per_m is None else px_per_m * (file.unit_m or 1.0)
    if px_per_m is None and not file.y_up:
        return file.stones, file.size_px or _reach(file.stones)
    points = np.concatenate([_corners(stone) for stone in file.stones])
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = (max(1, math.ceil(side - 1e-6)) for side in ((high - low) * scale).tolist())
    # The lower edge of the box is that of the picture, whichever way y runs.
    edge = low[1] if file.y_up else high[1]
    sign = -1.0 if file.y_up else 1.0
    shift = np.array([low[0] * scale, sign * edge * scale - height])

    def move(ring: Points) -> Points:
        return np.asarray(ring * (scale, sign * scale) - shift)

    return [stone.moved(move) for stone in file.stones], (width, height)


def _drawn(stone: OutlinedStone, width: int, height: int) -> Points | None:
    """Return the outer edge, (n, 2), of a stone in px of its picture, clockwise as y is down.

    None when it is known by its pixels only.
    """
    if stone.masks or any(map(_is_of_pixels, stone.rings)):
        return None
    with suppress(ValueError):  # crossings without end
        edge = outer_edge(stone.rings, shapely.box(0.0, 0.0, width, height))
        return None if edge is None else edge[::-1]
    return None


def _is_of_pixels(ring: Points) -> bool:
    """Tell a line along pixels, whose steps are not those of a stone: all eight ways, no other."""
    across, down = np.abs(np.roll(ring, -1, axis=0) - ring).T
    least = np.minimum(np.minimum(across, down), np.abs(across - down))
    return len(ring) > 12 and bool((least < 1e-6).all())  # a dressed stone may have 12


def _reach(stones: Sequence[OutlinedStone]) -> tuple[int, int]:
    """Return how far an image must reach from its corner to hold all stones."""
    ends = [(1.0, 1.0)]
    for stone in stones:
        ends += [tuple(ring.max(axis=0)) for ring in stone.rings]
        ends += [mask.sides[:1:-1] for mask in stone.masks]
    width, height = np.array(ends).max(axis=0).tolist()
    return math.ceil(width), math.ceil(height)


def _beside_others(
    patches: list[StonePatch], skip: Collection[int]
) -> tuple[list[StonePatch], list[Notice]]:
    """Tell every patch which pixels of its box are others', and say which overlap.

    What is skipped is no other.
    """
    beside: list[list[StonePatch]] = [[] for _ in patches]
    overlaps = []
    for i, j in meeting_boxes(patches):
        if patches[i].id in skip or patches[j].id in skip:
            continue
        beside[i].append(patches[j])
        beside[j].append(patches[i])
        if px := patches[i].common_px(patches[j]):
            overlaps.append(f"{patches[i].id} and {patches[j].id} ({px} px)")
    result = [
        replace(patch, others=model.covered(patch, others).mask & ~patch.mask if others else None)
        for patch, others in zip(patches, beside, strict=True)
    ]
    if not overlaps:
        return result, []
    text = f"stones overlap, and each keeps all its pixels: {listed(overlaps, '; ')}."
    return result, [Notice("W119", text, "Check their outlines.")]
