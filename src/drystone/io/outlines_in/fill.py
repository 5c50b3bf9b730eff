"""Areas to pixels: a pixel belongs to an area when its centre does."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from drystone.io.files import short, too_large
from drystone.io.outlines_in.model import Area, OutlinedStone
from drystone.io.patches import PlacedMask
from drystone.kernels.polygons import Points

_AT_ONCE_PX = 2**22
"""Pixels that are filled at once."""

_FREE_ROWS = 10_000
"""Rows that any outline may cross; more than its pixels of a larger one are no outline."""

_MOST_STONES = 10_000


def box_of(area: Area) -> tuple[int, int, int, int]:
    """Return the first row and column that an area can fill, and those after the last."""
    points = np.concatenate(area.rings)
    left, top = np.floor(points.min(axis=0)).astype(int).tolist()
    right, bottom = np.ceil(points.max(axis=0)).astype(int).tolist()
    return top, left, bottom, right


class Room:
    """Pixels that the stones of a file may fill, boxes around them included, asked for before.

    All stones together may have twice as many as a picture.
    """

    def __init__(self, max_px: int) -> None:
        self.max_px = max_px
        self.left = 2 * max_px

    def take(self, px: int) -> None:
        """Take some for one more mask; E110 when there is no room."""
        self.left -= px
        if self.left < 0:
            raise too_large(
                f"its stones fill more than {2 * self.max_px / 1e6:g} million px together.",
                "Reduce or crop its image, or give it a smaller resolution; only in Python can "
                "the limit be raised (max_image_mpx).",
            )


def check_reach(stones: Iterable[OutlinedStone], max_px: int) -> None:
    """Refuse outlines, in px, that would fill the memory (E110), naming the stone."""
    room = Room(max_px)
    for number, stone in enumerate(stones, start=1):
        if number > _MOST_STONES:
            what = f"there are more than {_MOST_STONES} stones in it."
            raise too_large(what, "Export those of one wall.")
        boxes = [box_of(area) for area in stone.areas] + [placed.sides for placed in stone.masks]
        if not boxes:
            continue
        height, width = (np.max(boxes, axis=0)[2:] - np.min(boxes, axis=0)[:2]).tolist()
        # A mask of pixels may be that of the ground; an outline is drawn.
        most = max_px if stone.masks else max_px // 4
        name = short(stone.name or stone.id)
        if width * height > most:
            raise too_large(
                f"stone {name} reaches over {width} x {height} px; the limit is {most / 1e6:g} "
                "million.",
                "Is a corner of it far away from the picture? Correct it; only in Python can the "
                "limit be raised (max_image_mpx).",
            )
        room.take(width * height)
        heights = (np.ceil(ring[:, 1] - 0.5) for ring in stone.rings)
        crossed = sum(int(np.abs(np.diff(rows, append=rows[:1])).sum()) for rows in heights)
        if crossed > width * height + _FREE_ROWS:
            raise too_large(
                f"the outline of stone {name} goes up and down over {crossed} rows of pixels, and "
                f"it has {width} x {height} px.",
                "Draw it with fewer corners.",
            )


def filled_area(area: Area) -> PlacedMask | None:
    """Return the pixels whose centres lie in an area in px, y down; None when there are none.

    Pixel (row, col) is the unit square from (x, y) = (col, row).  A centre on a left or upper edge
    is inside, on a right or lower edge outside, so areas that meet share no pixel.
    """
    top, left, bottom, right = box_of(area)
    height, width = bottom - top, right - left
    if height < 1 or width < 1:
        return None
    mask = np.zeros((height, width), bool)
    rows_at_once = max(1, _AT_ONCE_PX // width)
    for begin in range(0, height, rows_at_once):
        band = mask[begin : begin + rows_at_once]
        turns = np.zeros((len(band), width + 1), np.int32)
        for ring in area.rings:
            _add_crossings(turns, ring, top + begin, left)
        winding = np.cumsum(turns, axis=1, dtype=np.int32, out=turns)[:, :-1]
        band[:] = winding % 2 == 1 if area.rule == "evenodd" else winding != 0
    return trimmed(PlacedMask(mask, top, left))


def trimmed(placed: PlacedMask) -> PlacedMask | None:
    """Cut a mask to its bounding box; None when it has no pixel."""
    rows = np.flatnonzero(placed.mask.any(axis=1))
    if not len(rows):
        return None
    cols = np.flatnonzero(placed.mask.any(axis=0))
    inside = placed.mask[rows[0] : rows[-1] + 1, cols[0] : cols[-1] + 1]
    row, col = placed.row + int(rows[0]), placed.col + int(cols[0])
    return PlacedMask(np.ascontiguousarray(inside), row, col)


def united(masks: list[PlacedMask]) -> PlacedMask | None:
    """Return the union of masks; None without any."""
    if len(masks) < 2:
        return masks[0] if masks else None
    sides = [mask.sides for mask in masks]
    top, left = np.min(sides, axis=0)[:2].tolist()
    bottom, right = np.max(sides, axis=0)[2:].tolist()
    room = np.broadcast_to(np.False_, (bottom - top, right - left))
    return covered(PlacedMask(room, top, left), masks)


def covered(place: PlacedMask, masks: Iterable[PlacedMask]) -> PlacedMask:
    """Return which pixels within the box of one mask others have."""
    whole = PlacedMask(np.zeros(place.mask.shape, bool), place.row, place.col)
    for one in masks:
        within, mask = whole.shared(one)
        within |= mask
    return whole


def pixels_of(stone: OutlinedStone) -> PlacedMask | None:
    """Return the pixels of a stone whose outlines are in px, y down; None when it has none."""
    filled = (filled_area(area) for area in stone.areas)
    return united([*(mask for mask in filled if mask is not None), *stone.masks])


def _add_crossings(turns: NDArray[np.int32], ring: Points, top: int, left: int) -> None:
    """Add, row by row, where edges cross the line of pixel centres, and in which sense."""
    height, width = turns.shape[0], turns.shape[1] - 1
    ends = np.roll(ring, -1, axis=0)
    sense = np.where(ends[:, 1] > ring[:, 1], 1, -1)
    # From the upper end whichever way it runs, and not from the box: an edge that two areas have
    # in common is crossed at the same number in both.
    down = (sense > 0)[:, None]
    (x0, y0), (x1, y1) = np.where(down, ring, ends).T, np.where(down, ends, ring).T
    first, last = (np.clip(np.ceil(y - 0.5), top, top + height).astype(int) for y in (y0, y1))
    number = last - first
    edge = np.repeat(np.arange(len(ring)), number)
    row = first[edge] + np.arange(len(edge)) - (np.cumsum(number) - number)[edge]
    x = x0[edge] + (row + 0.5 - y0[edge]) / (y1 - y0)[edge] * (x1 - x0)[edge]
    col = np.clip(np.ceil(x - 0.5) - left, 0, width).astype(int)
    place = (row - top) * (width + 1) + col
    turns += np.bincount(place, sense[edge], turns.size).reshape(turns.shape).astype(np.int32)
