"""Markers in test photographs: paper with black squares, as `drystone markers` prints them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from drystone.kernels.raster import Mask
from drystone.photo.dictionaries import marker_modules
from drystone.photo.layout import ON_A_SHEET, MarkerLayout, page_mm, parse_layout
from drystone_lab.photographs.level import Level
from drystone_lab.photographs.texture import Light

PAPER, INK = 0.82, 0.03
"""Linear light of paper and ink."""

_GAP = 0.3
"""Border of a single marker over its side."""

_TURN_DEG = 12.0
_FINE = 3
"""Samples along a side of a px."""


def layout_of(level: Level) -> MarkerLayout | None:
    """Return the markers of a photograph as its user would name them; None without."""
    names = {"sheet": f"A4:{level.marker_mm:g}mm", "single": f"{level.marker_mm:g}mm"}
    return None if level.markers == "none" else parse_layout(names[level.markers])


def place_markers(level: Level, surface: Light, seen: Mask) -> Mask:
    """Draw markers on the ground; return where no stone may lie."""
    layout = layout_of(level)
    covered = np.zeros(seen.shape, bool)
    if layout is None:
        return covered
    papers = [_sheet(layout)] if layout.page else [_single(layout, k) for k in range(ON_A_SHEET)]
    for place, paper in enumerate(papers):
        wrong = level.wrong_print if place == len(papers) - 1 else 1.0
        half = math.hypot(*paper.size_m) / 2 * level.px_per_m
        room = np.argwhere(ndimage.distance_transform_edt(np.pad(seen, 1))[1:-1, 1:-1] > half + 5)
        signs = ((1, 1), (1, -1), (-1, 1), (-1, -1))[place]
        middle = room[(room * signs).sum(axis=1).argmin()][::-1] + 0.5
        _draw(paper, middle, level.px_per_m * wrong, surface, covered)
    return np.asarray(ndimage.distance_transform_edt(~covered) < level.gap_px)


@dataclass(frozen=True, eq=False)
class _Paper:
    size_m: tuple[float, float]
    squares: tuple[tuple[NDArray[np.float64], NDArray[np.bool_]], ...]
    """Upper left corner and modules of every marker."""
    side_m: float


def _sheet(layout: MarkerLayout) -> _Paper:
    width, height = page_mm(str(layout.page))
    squares = tuple((layout.corners_m(k)[0], marker_modules("aruco", k)) for k in range(ON_A_SHEET))
    return _Paper((width / 1000, height / 1000), squares, layout.size_m)


def _single(layout: MarkerLayout, number: int) -> _Paper:
    border = _GAP * layout.size_m
    whole = layout.size_m + 2 * border
    corner = np.array([border, border])
    return _Paper((whole, whole), ((corner, marker_modules("aruco", number)),), layout.size_m)


def _draw(
    paper: _Paper, middle: NDArray[np.float64], px_per_m: float, surface: Light, covered: Mask
) -> None:
    """Lay a paper down, turned a little, its middle at a place."""
    half = math.ceil(math.hypot(*paper.size_m) / 2 * px_per_m) + 2
    left, top = (int(part) - half for part in middle)
    fine = (np.arange(2 * half * _FINE) + 0.5) / _FINE
    x, y = np.meshgrid(fine + left - middle[0], fine + top - middle[1])
    turn = math.radians(_TURN_DEG)
    across = (x * math.cos(turn) + y * math.sin(turn)) / px_per_m + paper.size_m[0] / 2
    down = (y * math.cos(turn) - x * math.sin(turn)) / px_per_m + paper.size_m[1] / 2
    on = (across >= 0) & (down >= 0) & (across < paper.size_m[0]) & (down < paper.size_m[1])
    light = np.where(on, PAPER, 0.0)
    for corner, modules in paper.squares:
        count = len(modules)
        row = np.floor((down - corner[1]) / paper.side_m * count).astype(int)
        col = np.floor((across - corner[0]) / paper.side_m * count).astype(int)
        inside = (row >= 0) & (col >= 0) & (row < count) & (col < count)
        dark = modules[np.where(inside, row, 0), np.where(inside, col, 0)] & inside
        light[dark] = INK
    share = _coarse(on.astype(float))[..., None]
    # Near the edge of the ground the box is cut; the paper itself is not.
    rows = slice(max(-top, 0), 2 * half - max(top + 2 * half - surface.shape[0], 0))
    cols = slice(max(-left, 0), 2 * half - max(left + 2 * half - surface.shape[1], 0))
    box = (slice(top + rows.start, top + rows.stop), slice(left + cols.start, left + cols.stop))
    mixed = surface[box] * (1 - share[rows, cols]) + _coarse(light)[rows, cols][..., None]
    surface[box] = mixed
    covered[box] |= share[rows, cols, 0] > 0


def _coarse(values: NDArray[np.float64]) -> NDArray[np.float64]:
    side = values.shape[0] // _FINE
    return np.asarray(values.reshape(side, _FINE, side, _FINE).mean(axis=(1, 3)))
