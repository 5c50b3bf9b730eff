# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.raster`: turned masks sampled, counted and cropped."""

from libc.math cimport INFINITY, fabs

import numpy as np

ctypedef unsigned char byte
ctypedef unsigned short quarter  # samples of a quarter of a pixel, wide and high


cdef struct Turn:
    double cos
    double sin
    double x
    double y
    double scale


cdef struct Box:
    Py_ssize_t top
    Py_ssize_t left
    Py_ssize_t bottom
    Py_ssize_t right


def turned_boxes(const double[:, :] points, const double[:, :] turns):
    """Return what `turned_boxes_numpy` returns."""
    cdef double x, y, left, bottom, right, top
    cdef Py_ssize_t at, turn
    boxes = np.empty((turns.shape[0], 4))
    cdef double[:, ::1] out = boxes
    for turn in range(turns.shape[0]):
        left = bottom = INFINITY
        right = top = -INFINITY
        for at in range(points.shape[0]):
            x = points[at, 0] * turns[turn, 0] - points[at, 1] * turns[turn, 1]
            y = points[at, 0] * turns[turn, 1] + points[at, 1] * turns[turn, 0]
            left, right = min(left, x), max(right, x)
            bottom, top = min(bottom, y), max(top, y)
        out[turn, 0], out[turn, 1], out[turn, 2], out[turn, 3] = left, bottom, right, top
    return boxes


def fitted(
    const byte[:, :] mask,
    (double, double) centre,
    (double, double) turn,
    double scale,
    (double, double) corner,
    (Py_ssize_t, Py_ssize_t, Py_ssize_t) grid,
    (double, double) wanted,
):
    """Return what `fitted_numpy` returns."""
    cdef Py_ssize_t width = grid[0], height = grid[1], k = grid[2], number = 0
    cdef Turn way = Turn(turn[0], turn[1], centre[0], centre[1], scale)
    cdef Box box
    cdef quarter[:, ::1] counts = np.zeros((4 * (height + 2), 4 * (width + 2)), np.uint16)
    cdef double[:, ::1] along = np.empty((2, width * k))
    cdef int[:, ::1] covered = np.empty((height + 1, width + 1), np.intc)
    cdef byte[:, ::1] taken = np.empty((height + 1, width + 1), np.uint8)
    cdef Py_ssize_t[:, ::1] runs = np.empty((3, covered.size // 2 + height + 2), np.intp)
    cdef byte[:, ::1] out
    with nogil:
        sample(mask, &way, corner[0], corner[1], k, along, counts)
        number = best_phase(counts, k * k, wanted[0], wanted[1], covered)
        box = in_one_piece(covered, k * k, taken, runs)
    if box.bottom == 0:
        return None
    turned = np.empty((box.bottom - box.top, box.right - box.left), np.bool_)
    out = turned.view(np.uint8)
    out[:, :] = taken[box.top : box.bottom, box.left : box.right]
    return turned, box.left, box.bottom, number


cdef void sample(
    const byte[:, :] mask,
    const Turn *way,
    double left,
    double top,
    Py_ssize_t k,
    double[:, ::1] along,
    quarter[:, ::1] counts,
) noexcept nogil:
    """Count the samples that hit the mask, line by line; a pixel is left free on every side."""
    cdef Py_ssize_t height = mask.shape[0], width = mask.shape[1], side = k // 4
    cdef Py_ssize_t lines = (counts.shape[0] - 8) * side, size = along.shape[1]
    cdef Py_ssize_t line, at, first, stop
    cdef double u, v, col, row
    cdef double *cols = &along[0, 0]
    cdef double *rows = &along[1, 0]
    for at in range(size):
        u = ((at + 0.5) / k + left) / way.scale
        cols[at] = way.cos * u
        rows[at] = way.sin * u
    for line in range(lines):
        v = (top - (line + 0.5) / k) / way.scale
        col = way.sin * v + way.x
        row = height - way.y - way.cos * v
        first, stop = 0, size
        clip(way.cos / (way.scale * k), cols[0] + col, width, &first, &stop)
        clip(way.sin / (way.scale * k), rows[0] + row, height, &first, &stop)
        # Columns and rows grow or fall along the line: what is inside is one stretch.
        while first < stop and not inside(cols[first] + col, rows[first] + row, width, height):
            first += 1
        while first < stop and not inside(cols[stop - 1] + col, rows[stop - 1] + row, width, height):
            stop -= 1
        if first < stop:
            gather(mask, cols, rows, col, row, first, stop, side, &counts[4 + line // side, 4])


cdef inline bint inside(double col, double row, Py_ssize_t width, Py_ssize_t height) noexcept nogil:
    return 0.0 <= col and col < width and 0.0 <= row and row < height


cdef void clip(
    double step, double start, Py_ssize_t size, Py_ssize_t *first, Py_ssize_t *stop
) noexcept nogil:
    """Leave out samples of a line that are more than a pixel, so surely, outside of the mask."""
    cdef double low, high
    if step == 0.0:
        return
    low, high = (-1.0 - start) / step, (size + 1.0 - start) / step
    if low > high:
        low, high = high, low
    if low > first[0]:
        first[0] = <Py_ssize_t> min(low, <double> stop[0])
    if high < stop[0] - 1:
        stop[0] = <Py_ssize_t> max(high, -1.0) + 1


cdef void gather(
    const byte[:, :] mask,
    const double *cols,
    const double *rows,
    double col,
    double row,
    Py_ssize_t first,
    Py_ssize_t stop,
    Py_ssize_t side,
    quarter *counts,
) noexcept nogil:
    cdef const byte *source = &mask[0, 0]
    cdef Py_ssize_t down = mask.strides[0], right = mask.strides[1], at
    # Nothing is negative: cutting off the fraction is floor().
    if side == 1:
        for at in range(first, stop):
            counts[at] = source[<int> (rows[at] + row) * down + <int> (cols[at] + col) * right]
    else:
        for at in range(first, stop):
            counts[at // side] += source[
                <int> (rows[at] + row) * down + <int> (cols[at] + col) * right
            ]


cdef Py_ssize_t best_phase(
    quarter[:, ::1] counts, int full, double wanted, double tolerance, int[:, ::1] covered
) noexcept nogil:
    """Fill in the counts of the first sub-pixel position of the right area, or of the nearest."""
    cdef Py_ssize_t number, best = 0
    cdef double error, least = INFINITY
    for number in range(16):
        error = fabs(cover(counts, number, full, covered) - wanted)
        if error < least:
            best, least = number, error
        if error <= tolerance:
            break
    if number != best:
        cover(counts, best, full, covered)
    return best


cdef Py_ssize_t cover(
    quarter[:, ::1] counts, Py_ssize_t number, int full, int[:, ::1] covered
) noexcept nogil:
    """Count the samples of each pixel at a sub-pixel position; return how many are half covered."""
    cdef Py_ssize_t up = number // 4, right = number % 4, across = counts.shape[1]
    cdef Py_ssize_t row, col, area = 0
    cdef int count
    cdef const quarter *a
    cdef const quarter *b
    cdef const quarter *c
    cdef const quarter *d
    for row in range(covered.shape[0]):
        a = &counts[up + 4 * row, 4 - right]
        b, c, d = a + across, a + 2 * across, a + 3 * across
        for col in range(covered.shape[1]):
            count = a[0] + a[1] + a[2] + a[3] + b[0] + b[1] + b[2] + b[3]
            count += c[0] + c[1] + c[2] + c[3] + d[0] + d[1] + d[2] + d[3]
            covered[row, col] = count
            area += 2 * count >= full
            a, b, c, d = a + 4, b + 4, c + 4, d + 4
    return area


cdef Box in_one_piece(
    int[:, ::1] covered, int full, byte[:, ::1] taken, Py_ssize_t[:, ::1] runs
) noexcept nogil:
    """Take the pixels covered to a half, or to less where a thin neck would break otherwise.

    Returns the bounding box of what is taken; its bottom is 0 when there is nothing.
    """
    cdef Py_ssize_t row, col, attempt
    cdef int least = full // 2
    for attempt in range(3):
        for row in range(covered.shape[0]):
            for col in range(covered.shape[1]):
                taken[row, col] = covered[row, col] >= least
        if pieces(taken, runs) == 1:
            break
        least = full // 4 if attempt == 0 else 1
    return bounds(taken)


cdef Py_ssize_t pieces(byte[:, ::1] taken, Py_ssize_t[:, ::1] runs) noexcept nogil:
    """Count the pieces, joined at edges or corners, by the runs of the rows."""
    cdef Py_ssize_t *start = &runs[0, 0]
    cdef Py_ssize_t *stop = &runs[1, 0]
    cdef Py_ssize_t *parent = &runs[2, 0]
    cdef Py_ssize_t row, col, above, count = 0, last = 0, this = 0, found = 0, one, other
    for row in range(taken.shape[0]):
        above, last, this = last, this, count
        col = 0
        while col < taken.shape[1]:
            if not taken[row, col]:
                col += 1
                continue
            start[count] = col
            while col < taken.shape[1] and taken[row, col]:
                col += 1
            stop[count], parent[count] = col, count
            found += 1
            above = last
            while above < this and start[above] <= col:
                if stop[above] >= start[count]:
                    one, other = root(parent, above), root(parent, count)
                    if one != other:
                        parent[other] = one
                        found -= 1
                above += 1
            count += 1
    return found


cdef inline Py_ssize_t root(Py_ssize_t *parent, Py_ssize_t at) noexcept nogil:
    while parent[at] != at:
        parent[at] = parent[parent[at]]
        at = parent[at]
    return at


cdef Box bounds(byte[:, ::1] taken) noexcept nogil:
    cdef Box box = Box(taken.shape[0], taken.shape[1], 0, 0)
    cdef Py_ssize_t row, col
    for row in range(taken.shape[0]):
        for col in range(taken.shape[1]):
            if taken[row, col]:
                box.top, box.bottom = min(box.top, row), row + 1
                box.left, box.right = min(box.left, col), max(box.right, col + 1)
    return box
