"""Slow, obvious twins of the support polyline, of seating and of wedges (§3.7, Fig. 9)."""

import math

import numpy as np

from tests.naive.overlap import overlaps
from tests.naive.raster import pieces


def support_ends(occupied, mask, row, col):
    """x of A and B, and the rows of their edges; None when nothing supports."""
    columns = {}  # in which some pixel of the stone stands on something: rows of those edges
    for i, j in zip(*np.nonzero(mask), strict=True):
        r, c = int(row + i + 1), int(col + j)
        if r == occupied.shape[0] or occupied[r, c]:
            columns.setdefault(c, []).append(r)
    if not columns:
        return None
    first, last = min(columns), max(columns)
    return first, last + 1, max(columns[first]), max(columns[last])


def rests_stably(occupied, mask, row, col, x_c, margin_px):
    """Whether the centre of mass projects inside the support, by a margin."""
    ends = support_ends(occupied, mask, row, col)
    return ends is not None and ends[0] + margin_px <= x_c <= ends[1] - margin_px


def resting_row(occupied, mask, row, col, reach):
    """The nearest row, the lower of two, where the mask is free and one row lower is not."""
    found = [
        (abs(at - row), -at)
        for at in range(row - reach, row + reach + 1)
        if not overlaps(occupied, mask, at, col) and overlaps(occupied, mask, at + 1, col)
    ]
    return -min(found)[1] if found else None


def gap_pixels(occupied, mask, at, columns, sizes):
    """Pixels (row, column of the wall) of the gap that fills what touches first, if it can."""
    smallest, largest = sizes
    under = {at[1] + j: _gap_rows(occupied, mask, at, j) for j in range(*columns)}
    gaps = {x: rows for x, rows in under.items() if smallest <= len(rows) <= largest}
    least = min(map(len, gaps.values()), default=0)
    for slack in range(1, largest + 1):
        for start in sorted(gaps):
            if len(gaps[start]) == least:
                run = _run(gaps, start, least + slack)
                if len(run) >= smallest:
                    pixels = {(row, x) for x in run for row in gaps[x]}
                    return pixels if pieces(pixels, joined=None) == 1 else None
    return None


def _gap_rows(occupied, mask, at, column):
    """Free rows of the wall under a column of the stone."""
    below = at[0] + int(max(np.flatnonzero(mask[:, column]))) + 1
    rows = []
    while below < len(occupied) and not occupied[below, at[1] + column]:
        rows.append(below)
        below += 1
    return rows


def _run(gaps, start, highest):
    """Columns side by side, from one on, whose gaps are no higher than that."""
    run = {start}
    for step in (-1, 1):
        x = start + step
        while x in gaps and len(gaps[x]) <= highest:
            run.add(x)
            x += step
    return run


def rotated(occupied, trial, book, settings):
    """Turn a stone about the nearer end of its support until it rests: pose, and points used."""
    pose = trial
    for pivots in range(settings.max_pivots + 1):
        side = fall(occupied, pose, settings)
        if side == 0:
            return pose, pivots
        if side is None or pivots == settings.max_pivots:
            return None
        start, step = pose, 0
        ends, near = support_ends(occupied, start[0].mask, *start[1:]), settings.new_pivot_px
        pivot = ends[0::2] if side < 0 else ends[1::2]
        while pose == start or (
            fall(occupied, pose, settings) == side
            and abs(support_ends(occupied, pose[0].mask, *pose[1:])[side > 0] - pivot[0]) <= near
        ):
            step += 1
            angle = start[0].angle_deg - side * step * settings.step_deg
            if abs(angle - trial[0].angle_deg) > settings.max_turn_deg + 1e-9:
                return None
            posed = book.pose(trial[0].stone, angle)
            row, col = _about(pivot, start, posed, -side * step * settings.step_deg)
            inside = 0 <= col <= occupied.shape[1] - posed.width_px
            seated = resting_row(occupied, posed.mask, row, col, settings.max_shift_px)
            if not inside or seated is None:
                return None
            pose = posed, seated, col
    return None


def _about(pivot, start, posed, turn_deg):
    """Row and column of a turned stone that keeps a point where it is, to the nearest pixel."""
    before, row, col = start
    x = col + before.anchor[0] - pivot[0]
    y = pivot[1] - (row + before.height_px - before.anchor[1])
    moved = complex(x, y) * complex(
        math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    )
    left = pivot[0] + moved.real - posed.anchor[0]
    top = pivot[1] - moved.imag + posed.anchor[1] - posed.height_px
    return math.floor(top + 0.5), math.floor(left + 0.5)


def fall(occupied, pose, settings):
    """Side to which a stone falls, 0 when it is stable, None when it stands on nothing."""
    posed, row, col = pose
    ends = support_ends(occupied, posed.mask, row, col)
    if ends is None:
        return None
    x_c, margin = col + posed.anchor[0], settings.margin * posed.width_px
    if rests_stably(occupied, posed.mask, row, col, x_c, margin):
        return 0
    return -1 if x_c - ends[0] < ends[1] - x_c else 1
