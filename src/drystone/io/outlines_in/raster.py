"""Outlines of a file to patches of pixels, at the resolution of the file or of the settings."""

import math
from dataclasses import dataclass, replace

import numpy as np

from drystone.errors import InputError, LabelImageError, Notice
from drystone.io.listed import listed, short
from drystone.io.outlines_in.fill import check_reach, trimmed
from drystone.io.outlines_in.model import Area, OutlinedStone, OutlineFile, PlacedMask
from drystone.io.outlines_in.nested import meeting_boxes, overlap, pixels_of
from drystone.io.patches import Patch
from drystone.io.pictures import check_size
from drystone.io.read_settings import ReadSettings
from drystone.kernels.polygons import Points
from drystone.kernels.raster import Mask

USUAL_SIDE_PX = 160.0
"""Longer side of the median stone of a drawing without a resolution."""


@dataclass(frozen=True, eq=False)
class Rastered:
    """Stones of a file as pixels."""

    patches: list[Patch]  # in the order of the file; they may overlap
    width: int  # of the picture that they are in, px
    height: int  # of the picture that they are in, px
    px_per_m: float | None  # its scale; None for a file in px
    notices: list[Notice]  # what was decided on the way


def rastered(file: OutlineFile, settings: ReadSettings, where: str) -> Rastered:
    """Turn outlines into pixels.

    A file in px keeps its own px.  A drawing is drawn in the box around all its stones, whose
    lower left corner becomes that of the picture.
    """
    if not file.stones:
        raise LabelImageError(
            "E104", "there are no stones in it.", where=where,
            cure="; ".join(notice.message for notice in file.notices) or "Draw outlines.",
        )  # fmt: skip
    notices: list[Notice] = []
    px_per_m = None
    if file.unit_m is not None:
        px_per_m = settings.px_per_m
        if px_per_m is None:
            px_per_m, notice = _usual_scale(file, where)
            notices.append(notice)
    stones, (width, height) = _in_picture(file, px_per_m)
    try:
        check_size(width, height, where, int(settings.max_image_mpx * 1e6))
    except InputError as error:
        cure = "Is something drawn far away from the stones, or in another unit? Remove it, give "
        raise InputError(
            error.code, error.what, where=error.where,
            cure=f"{cure}a smaller --px-per-m (px_per_m in Python), or raise max_image_mpx in "
            "Python.",
        ) from None  # fmt: skip
    check_reach(stones, where, int(settings.max_image_mpx * 1e6))
    patches, lost, empty = [], [], []
    for stone in stones:
        placed = pixels_of(stone)
        inside = None if placed is None else _within(placed, width, height)
        name = f"{stone.id} ({short(stone.name)})" if stone.name else str(stone.id)
        outside = 0 if placed is None else int(placed.mask.sum())
        outside -= 0 if inside is None else int(inside.mask.sum())
        if outside:
            lost.append(f"stone {name}: {outside} px")
        if inside is None:
            empty.append(f"stone {name}")
            continue
        patches.append(
            Patch(stone.id or 0, inside.mask, inside.row, inside.col, height, None, stone.name)
        )
    if lost:
        notices.append(Notice("W119", f"outside the image, cut off: {listed(lost, '; ')}."))
    if empty:
        notices.append(Notice("W119", f"without a pixel, left out: {listed(empty, '; ')}."))
    patches, overlaps = _beside_others(patches, where)
    return Rastered(patches, width, height, px_per_m, notices + overlaps)


def _usual_scale(file: OutlineFile, where: str) -> tuple[float, Notice]:
    """Choose a scale of two digits for which the median stone has a usual size."""
    unit = file.unit_m or 1.0
    sides = [float(np.ptp(_corners(stone), axis=0).max()) * unit for stone in file.stones]
    side = float(np.median(sides))
    if not side > 0.0:
        raise LabelImageError(
            "E104", "the stones have no area.", where=where, cure="Draw closed outlines."
        )
    exact = USUAL_SIDE_PX / side
    step = 10.0 ** (math.floor(math.log10(exact)) - 1)
    px_per_m = float(f"{round(exact / step) * step:.2g}")
    text = (
        f"the longer side of the median stone is {side:.3g} m; drawn at {px_per_m:g} px a metre, "
        f"it is {side * px_per_m:.0f} px long."
    )
    return px_per_m, Notice("W119", text, "Choose another with --px-per-m (px_per_m in Python).")


def _corners(stone: OutlinedStone) -> Points:
    rings = [ring for area in stone.areas for ring in area.rings]
    return np.concatenate(rings) if rings else np.zeros((1, 2))


def _in_picture(
    file: OutlineFile, px_per_m: float | None
) -> tuple[tuple[OutlinedStone, ...], tuple[int, int]]:
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

    stones = tuple(
        replace(
            stone,
            areas=tuple(Area(tuple(map(move, area.rings)), area.rule) for area in stone.areas),
        )
        for stone in file.stones
    )
    return stones, (width, height)


def _reach(stones: tuple[OutlinedStone, ...]) -> tuple[int, int]:
    """Return how far an image must reach from its corner to hold all stones."""
    ends = [(1.0, 1.0)]
    for stone in stones:
        ends += [tuple(ring.max(axis=0)) for area in stone.areas for ring in area.rings]
        ends += [(m.col + m.mask.shape[1], m.row + m.mask.shape[0]) for m in stone.masks]
    width, height = np.array(ends).max(axis=0).tolist()
    return math.ceil(width), math.ceil(height)


def _within(placed: PlacedMask, width: int, height: int) -> PlacedMask | None:
    top, left = max(0, -placed.row), max(0, -placed.col)
    inside = placed.mask[top : max(0, height - placed.row), left : max(0, width - placed.col)]
    if inside.shape == placed.mask.shape:
        return placed
    return trimmed(PlacedMask(inside, placed.row + top, placed.col + left))


def _beside_others(patches: list[Patch], where: str) -> tuple[list[Patch], list[Notice]]:
    """Tell every patch which pixels of its box are others', and say which overlap."""
    masks = [PlacedMask(patch.mask, patch.row, patch.col) for patch in patches]
    others: dict[int, Mask] = {}
    overlaps = []
    for i, j in meeting_boxes(masks, where):
        for one, other in ((i, j), (j, i)):
            _mark(others.setdefault(one, np.zeros_like(masks[one].mask)), masks[one], masks[other])
        both = overlap(masks[i], masks[j])
        if both is not None and both.any():
            overlaps.append(f"{patches[i].id} and {patches[j].id} ({int(both.sum())} px)")
    result = [
        replace(patch, others=others[i] & ~patch.mask if i in others else None)
        for i, patch in enumerate(patches)
    ]
    if not overlaps:
        return result, []
    text = f"stones overlap, and each keeps all its pixels: {listed(overlaps, '; ')}."
    return result, [Notice("W119", text, "Check their outlines.")]


def _mark(others: Mask, one: PlacedMask, other: PlacedMask) -> None:
    """Mark, in the box of one mask, the pixels of another."""
    top, left = max(one.row, other.row), max(one.col, other.col)
    bottom = min(m.row + m.mask.shape[0] for m in (one, other))
    right = min(m.col + m.mask.shape[1] for m in (one, other))
    others[top - one.row : bottom - one.row, left - one.col : right - one.col] |= other.mask[
        top - other.row : bottom - other.row, left - other.col : right - other.col
    ]
