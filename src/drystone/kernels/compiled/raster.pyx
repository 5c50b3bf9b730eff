# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Compiled twin of :mod:`drystone.kernels.raster`: turned masks sampled, counted and cropped."""

from libc.math cimport INFINITY, fabs

from drystone.kernels.memory cimport doubles, doubles_out, flags_out, ints_out, pixels, stride

import numpy as np

ctypedef unsigned char byte


cdef struct Source:
    # The pixels of a mask, and how far they are apart.
    const byte *pixels
    Py_ssize_t height
    Py_ssize_t width
    Py_ssize_t down
    Py_ssize_t right


cdef struct Sheet:
    # Pixels of the result: one row and one column more than it is high and wide.
    Py_ssize_t height
    Py_ssize_t width
    int *counts  # samples that hit, a quarter of a pixel wide and high, a free pixel all around
    int *covered
    byte *taken
    int *runs
    Py_ssize_t room


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


def turned_boxes(points, turns):
    """Return what `turned_boxes_numpy` returns."""
    points, turns = np.ascontiguousarray(points), np.ascontiguousarray(turns)
    boxes = np.empty((len(turns), 4))
    cdef double x, y, left, bottom, right, top
    cdef Py_ssize_t i, k, count = 2 * len(points), end = 2 * len(turns)
    cdef const double *at = doubles(points)
    cdef const double *way = doubles(turns)
    cdef double *out = doubles_out(boxes)
    for k in range(0, end, 2):
        left = bottom = INFINITY
        right = top = -INFINITY
        for i in range(0, count, 2):
            x = at[i] * way[k] - at[i + 1] * way[k + 1]
            y = at[i] * way[k + 1] + at[i + 1] * way[k]
            left, right = min(left, x), max(right, x)
            bottom, top = min(bottom, y), max(top, y)
        out[2 * k], out[2 * k + 1], out[2 * k + 2], out[2 * k + 3] = left, bottom, right, top
    return boxes


def fitted(
    mask,
    (double, double) centre,
    (double, double) turn,
    double scale,
    (double, double) corner,
    (Py_ssize_t, Py_ssize_t, Py_ssize_t) grid,
    (double, double) wanted,
):
    """Return what `fitted_numpy` returns."""
    cdef Py_ssize_t width = grid[0] + 1, height = grid[1] + 1, k = grid[2], number = 0
    cdef Turn way = Turn(turn[0], turn[1], centre[0], centre[1], scale)
    cdef Source source = Source(
        pixels(mask), mask.shape[0], mask.shape[1], stride(mask, 0), stride(mask, 1)
    )
    cdef Box box
    counts = np.zeros((4 * (height + 1), 4 * (width + 1)), np.int32)
    along, covered = np.empty((2, grid[0] * k)), np.empty((height, width), np.int32)
    taken = np.empty((height, width), np.bool_)
    runs = np.empty((3, width * height // 2 + height + 1), np.int32)
    cdef double *steps = doubles_out(along)
    cdef Sheet sheet = Sheet(
        height, width, ints_out(counts), ints_out(covered), flags_out(taken), ints_out(runs),
        runs.shape[1],
    )
    with nogil:
        sample(&source, &way, corner[0], corner[1], k, steps, &sheet)
        number = best_phase(&sheet, k * k, wanted[0], wanted[1])
        box = in_one_piece(&sheet, k * k)
    if box.bottom == 0:
        return None
    turned = taken[box.top : box.bottom, box.left : box.right].copy()
    return turned, box.left, box.bottom, number


cdef void sample(
    const Source *mask,
    const Turn *way,
    double left,
    double top,
    Py_ssize_t k,
    double *along,
    Sheet *sheet,
) noexcept nogil:
    """Count the samples that hit the mask, line by line; a pixel is left free on every side."""
    cdef Py_ssize_t height = mask.height, width = mask.width, side = k // 4
    cdef Py_ssize_t lines = (sheet.height - 1) * k, size = (sheet.width - 1) * k
    cdef Py_ssize_t across = 4 * (sheet.width + 1)
    cdef Py_ssize_t line, at, first, stop
    cdef double u, v, col, row
    cdef double *cols = along
    cdef double *rows = along + size
    cdef int *counts
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
            counts = sheet.counts + (4 + line // side) * across + 4
            gather(mask, cols, rows, col, row, first, stop, side, counts)


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
    const Source *mask,
    const double *cols,
    const double *rows,
    double col,
    double row,
    Py_ssize_t first,
    Py_ssize_t stop,
    Py_ssize_t side,
    int *counts,
) noexcept nogil:
    cdef const byte *source = mask.pixels
    cdef Py_ssize_t down = mask.down, right = mask.right, at
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
    Sheet *sheet, int full, double wanted, double tolerance
) noexcept nogil:
    """Fill in the counts of the first sub-pixel position of the right area, or of the nearest."""
    cdef Py_ssize_t number, best = 0
    cdef double error, least = INFINITY
    for number in range(16):
        error = fabs(cover(sheet, number, full) - wanted)
        if error < least:
            best, least = number, error
        if error <= tolerance:
            break
    if number != best:
        cover(sheet, best, full)
    return best


cdef Py_ssize_t cover(Sheet *sheet, Py_ssize_t number, int full) noexcept nogil:
    """Count the samples of each pixel at a sub-pixel position; return how many are half covered."""
    cdef Py_ssize_t up = number // 4, right = number % 4, across = 4 * (sheet.width + 1)
    cdef Py_ssize_t row, col, area = 0
    cdef int count
    cdef const int *a
    cdef const int *b
    cdef const int *c
    cdef const int *d
    cdef int *covered = sheet.covered
    for row in range(sheet.height):
        a = sheet.counts + (up + 4 * row) * across + 4 - right
        b, c, d = a + across, a + 2 * across, a + 3 * across
        for col in range(sheet.width):
            count = a[0] + a[1] + a[2] + a[3] + b[0] + b[1] + b[2] + b[3]
            count += c[0] + c[1] + c[2] + c[3] + d[0] + d[1] + d[2] + d[3]
            covered[row * sheet.width + col] = count
            area += 2 * count >= full
            a, b, c, d = a + 4, b + 4, c + 4, d + 4
    return area


cdef Box in_one_piece(Sheet *sheet, int full) noexcept nogil:
    """Take the pixels covered to a half, or to less where a thin neck would break otherwise.

    Returns the bounding box of what is taken; its bottom is 0 when there is nothing.
    """
    cdef Py_ssize_t at, attempt
    cdef int least = full // 2
    for attempt in range(3):
        for at in range(sheet.height * sheet.width):
            sheet.taken[at] = sheet.covered[at] >= least
        if pieces(sheet) == 1:
            break
        least = full // 4 if attempt == 0 else 1
    return bounds(sheet)


cdef Py_ssize_t pieces(Sheet *sheet) noexcept nogil:
    """Count the pieces, joined at edges or corners, by the runs of the rows."""
    cdef int *start = sheet.runs
    cdef int *stop = start + sheet.room
    cdef int *parent = stop + sheet.room
    cdef const byte *taken
    cdef Py_ssize_t row, col, above, count = 0, last = 0, this = 0, found = 0, one, other
    for row in range(sheet.height):
        taken = sheet.taken + row * sheet.width
        above, last, this = last, this, count
        col = 0
        while col < sheet.width:
            if not taken[col]:
                col += 1
                continue
            start[count] = <int> col
            while col < sheet.width and taken[col]:
                col += 1
            stop[count], parent[count] = <int> col, <int> count
            found += 1
            above = last
            while above < this and start[above] <= col:
                if stop[above] >= start[count]:
                    one, other = root(parent, above), root(parent, count)
                    if one != other:
                        parent[other] = <int> one
                        found -= 1
                above += 1
            count += 1
    return found


cdef inline Py_ssize_t root(int *parent, Py_ssize_t at) noexcept nogil:
    while parent[at] != at:
        parent[at] = parent[parent[at]]
        at = parent[at]
    return at


cdef Box bounds(Sheet *sheet) noexcept nogil:
    cdef Box box = Box(sheet.height, sheet.width, 0, 0)
    cdef Py_ssize_t row, col
    for row in range(sheet.height):
        for col in range(sheet.width):
            if sheet.taken[row * sheet.width + col]:
                box.top, box.bottom = min(box.top, row), row + 1
                box.left, box.right = min(box.left, col), max(box.right, col + 1)
    return box
