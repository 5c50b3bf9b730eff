"""Where labelled regions of an image touch: straight runs of boundary, single corners (§4.2).

All that decides is exact in integers, and a normal is a handful of float operations that are
rounded correctly everywhere: results do not depend on the machine.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drystone.kernels import patches
from drystone.kernels.boundary import boundary_of
from drystone.kernels.patches import Patch

try:
    import cython
except ImportError:
    from drystone.kernels import shim as cython

if not cython.compiled:
    from math import sqrt

    from drystone.kernels.lists import doubles_out, kept_ints, longs, longs_out

# A run may leave its chord by the square root of this before it is split.  The pixel corners of a
# straight joint lie in a strip narrower than |cos| + |sin| <= sqrt 2, so a straight joint is never
# split, and a leg of two pixels at the end of a long run is.
TOLERANCE = cython.declare(cython.longlong, 2)

# An end edge square to a straight piece of at least this length is a hook of the grid.
HOOK_NEEDS = cython.declare(cython.int, 3)

MARGIN = cython.declare(cython.Py_ssize_t, patches.MARGIN_PX)


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts between regions: first straight runs, then single points."""

    high: NDArray[np.int64]  # (k,) the two labels, the larger first
    low: NDArray[np.int64]
    # (k, 2, 2) (x, y) of both ends, in the sense in which `high` lies to the left; twice the
    # same for a point
    ends: NDArray[np.float64]
    normals: NDArray[np.float64]  # (k, 2) unit vectors into `high`
    run_count: int  # the first so many are runs


def contacts_in(patch: Patch) -> Contacts:
    """Find the contacts in a patch of which at least one side is fresh.

    A run is a connected chain of pixel edges, split where it bends (Douglas and Peucker 1973).
    Regions that touch only at a pixel corner, across two empty cells, have a contact at that point.
    Runs are sorted by labels and place, points from the top down.
    """
    boundary = boundary_of(patch.cells, patch.fresh)
    x0: cython.longlong = patch.origin[0]
    y0: cython.longlong = patch.origin[1]
    height: cython.Py_ssize_t = patch.cells.shape[0]
    width: cython.Py_ssize_t = patch.cells.shape[1]
    cells: cython.p_longlong = longs(patch.cells)
    labels: cython.p_longlong = longs(boundary.labels)
    begins: cython.p_longlong = longs(boundary.begins)
    nodes: cython.p_longlong = longs(boundary.nodes)
    corners: cython.p_longlong = longs(boundary.corners)
    chain_count: cython.int = len(boundary.labels)
    corner_count: cython.int = len(boundary.corners)
    size: cython.Py_ssize_t = len(boundary.nodes)
    # A chain has fewer runs than nodes, and fewer pieces wait than it has nodes.
    room: list = []
    runs: cython.p_int = kept_ints(room, 3 * size)
    pieces: cython.p_int = kept_ints(room, 2 * size + 2)
    is_cut: cython.p_int = kept_ints(room, size)
    found: cython.int = 0
    with cython.nogil:
        for k in range(chain_count):
            found = split_chain(nodes, begins[k], begins[k + 1], k, runs, found, pieces, is_cut)
    count: cython.Py_ssize_t = found + corner_count
    high, low = np.empty(count, np.int64), np.empty(count, np.int64)
    ends, normals = np.empty((count, 2, 2)), np.empty((count, 2))
    highs: cython.p_longlong = longs_out(high)
    lows: cython.p_longlong = longs_out(low)
    points: cython.p_double = doubles_out(ends)
    vectors: cython.p_double = doubles_out(normals)
    with cython.nogil:
        for k in range(found):
            first, last = runs[3 * k + 1], runs[3 * k + 2]
            highs[k], lows[k] = labels[2 * runs[3 * k]], labels[2 * runs[3 * k] + 1]
            points[4 * k] = x0 + nodes[2 * first + 1]
            points[4 * k + 1] = y0 - nodes[2 * first]
            points[4 * k + 2] = x0 + nodes[2 * last + 1]
            points[4 * k + 3] = y0 - nodes[2 * last]
            write_normal(nodes, first, last, vectors, 2 * k)
        for c in range(0, 4 * corner_count, 4):
            k = found + c // 4
            highs[k] = max(corners[c], corners[c + 1])
            lows[k] = min(corners[c], corners[c + 1])
            points[4 * k] = points[4 * k + 2] = x0 + corners[c + 3]
            points[4 * k + 1] = points[4 * k + 3] = y0 - corners[c + 2]
            write_normal_at_point(cells, height, width, corners, c, vectors, 2 * k)
    return Contacts(high, low, ends, normals, found)


def split_chain(nodes, begin, end, chain, runs, count, pieces, is_cut):
    """Add chain, first and last node of the straight runs of a chain to so many; return how many.

    The ledge of one pixel at either end is the grid's, not the stone's; it must not tilt the
    normal, and is left out.
    """
    waiting: cython.int = 1
    before: cython.int = begin
    is_cut[end - 1] = 1
    pieces[0], pieces[1] = begin, end - 1
    while waiting:
        waiting -= 1
        first, last = pieces[2 * waiting], pieces[2 * waiting + 1]
        middle = corner_between(nodes, first, last)
        if middle < 0:
            continue
        is_cut[middle] = 1
        pieces[2 * waiting + 1] = pieces[2 * waiting + 2] = middle
        pieces[2 * waiting + 3] = last
        waiting += 2
    for cut in range(begin + 1, end):
        if not is_cut[cut]:
            continue
        first, last = before, cut
        before = cut
        if last - first > HOOK_NEEDS and is_hook(nodes, last, -1):
            last -= 1
        if last - first > HOOK_NEEDS and is_hook(nodes, first, 1):
            first += 1
        runs[3 * count], runs[3 * count + 1], runs[3 * count + 2] = chain, first, last
        count += 1
    return count


def corner_between(nodes, first, last):
    """Return the node furthest from the chord, the first of several; -1 if that is near."""
    middle: cython.int = -1
    furthest: cython.longlong = 0
    if last - first < 2:
        return -1
    row, col = nodes[2 * first], nodes[2 * first + 1]
    rows, cols = nodes[2 * last] - row, nodes[2 * last + 1] - col
    closed: cython.bint = rows == 0 and cols == 0
    if not closed:  # times the length of the chord
        furthest = integer_root(TOLERANCE * (rows * rows + cols * cols))
    for k in range(first + 1, last):
        r, c = nodes[2 * k] - row, nodes[2 * k + 1] - col
        # A closed piece has no chord; it is bent however small it is.
        away = r * r + c * c if closed else abs(cols * r - rows * c)
        if away > furthest:
            furthest, middle = away, k
    return middle


def integer_root(square):
    """Return the largest integer whose square is no larger."""
    root = cython.cast(cython.longlong, sqrt(square))
    while root * root > square:
        root -= 1
    while (root + 1) * (root + 1) <= square:
        root += 1
    return root


def is_hook(nodes, end, inwards):
    """Say whether the edge at the end of a run turns off from a straight piece."""
    bend: cython.Py_ssize_t = 2 * (end + inwards)
    far: cython.Py_ssize_t = bend + 2 * HOOK_NEEDS * inwards
    rows, cols = nodes[bend] - nodes[far], nodes[bend + 1] - nodes[far + 1]
    if max(abs(rows), abs(cols)) != HOOK_NEEDS:
        return False
    return (
        rows * (nodes[2 * end] - nodes[bend]) + cols * (nodes[2 * end + 1] - nodes[bend + 1]) == 0
    )


def write_normal(nodes, first, last, normals, at):
    """Write the unit normal to the left of a run.

    Its line is fitted to the midpoints of its edges by total least squares: on a regular staircase
    they lie along its slope, and one odd edge hardly turns it.  The scatter of twice the midpoints
    is found from sums of integers, exact up to some thousand edges.
    """
    sum_x: cython.longlong = 0
    sum_y: cython.longlong = 0
    sum_xx: cython.longlong = 0
    sum_xy: cython.longlong = 0
    sum_yy: cython.longlong = 0
    row, col = nodes[2 * first], nodes[2 * first + 1]
    chord_x = 1.0 * (nodes[2 * last + 1] - col)
    chord_y = 1.0 * (row - nodes[2 * last])
    for k in range(2 * first, 2 * last, 2):
        x = nodes[k + 1] + nodes[k + 3] - 2 * col
        y = 2 * row - nodes[k] - nodes[k + 2]
        sum_x += x
        sum_y += y
        sum_xx += x * x
        sum_xy += x * y
        sum_yy += y * y
    count, sx, sy = 1.0 * (last - first), 1.0 * sum_x, 1.0 * sum_y
    xx = count * sum_xx - sx * sx
    xy = count * sum_xy - sx * sy
    yy = count * sum_yy - sy * sy
    difference, mixed = xx - yy, 2.0 * xy
    if mixed == 0.0:
        along_x, along_y = chord_x, chord_y
        if difference != 0.0:
            along_x = 1.0 if difference > 0.0 else 0.0
            along_y = 1.0 - along_x
    else:
        size = sqrt(difference * difference + mixed * mixed)
        if difference >= 0.0:  # of two expressions the one that does not cancel
            along_x, along_y = size + difference, mixed
        else:
            along_x = abs(mixed)
            along_y = size - difference if mixed > 0.0 else difference - size
    length = sqrt(along_x * along_x + along_y * along_y)
    if along_x * chord_x + along_y * chord_y < 0.0:
        length = -length
    normals[at], normals[at + 1] = -along_y / length + 0.0, along_x / length + 0.0


def write_normal_at_point(cells, height, width, corners, corner, normals, at):
    """Write the normal of two regions that touch at a node across two empty cells.

    The normal is that of the region whose boundary passes the node rather than ends in it: the
    first moment of its pixels around the node points away from its boundary.  Each region counts
    by how many of its pixels lie outside the quadrant of its corner pixel.  A square corner on a
    square corner has no tangent: there the upper stone stands on the lower one, so that it slides
    off freely as it would on a flat bed.
    """
    row: cython.Py_ssize_t = corners[corner + 2]
    col: cython.Py_ssize_t = corners[corner + 3]
    toward = 1 if cells[(row - 1) * width + col] == corners[corner] else -1
    normal_x: cython.longlong = 0
    normal_y: cython.longlong = 0
    for sign in range(1, -2, -2):  # the region above, then the one below; arms are doubled
        label = corners[corner] if sign > 0 else corners[corner + 1]
        outside: cython.longlong = 0
        moment_x: cython.longlong = 0
        moment_y: cython.longlong = 0
        for r in range(max(row - MARGIN, 0), min(row + MARGIN, height)):
            up = 2 * (row - r) - 1
            for c in range(max(col - MARGIN, 0), min(col + MARGIN, width)):
                if cells[r * width + c] == label:
                    right = 2 * (c - col) + 1
                    moment_x += right
                    moment_y += up
                    if sign * up < 0 or sign * toward * right < 0:
                        outside += 1
        normal_x += sign * outside * moment_x
        normal_y += sign * outside * moment_y
    if normal_x == 0 and normal_y == 0:
        normal_y = 1
    length = sqrt(normal_x * normal_x + normal_y * normal_y)
    if corners[corner] < corners[corner + 1]:
        length = -length
    normals[at], normals[at + 1] = normal_x / length + 0.0, normal_y / length + 0.0
