# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.course_paths`."""

from libc.stdint cimport int32_t, int64_t

cdef enum:
    PIXEL_UNITS = 32
    FIRST_PX = 10
    SHORTEST = 5
    PADDING_PX = 3
    DIAGONAL = 424
    # More than any way, and far from what an integer cannot hold.
    FAR = 1 << 29


cdef int32_t path_starts(int32_t side, int32_t *starts) noexcept nogil:
    """Find where paths across a side start; return how many there are."""
    cdef int32_t side_px = (side + PIXEL_UNITS - 1) / PIXEL_UNITS + PADDING_PX
    cdef int32_t between = max(1, side_px / STARTS), px = FIRST_PX, count = 0
    while px < side_px - FIRST_PX and count < STARTS:
        starts[count] = px * PIXEL_UNITS - PIXEL_UNITS / 2
        px += between
        count += 1
    return count


cdef inline int32_t apart(const int32_t *one, int32_t left, int32_t right) noexcept nogil:
    """Return how far two stretches are apart, 0 when they overlap."""
    return max(0, max(one[0] - right, left - one[1]))


cdef inline bint ordered(const int32_t *joints, Py_ssize_t count) noexcept nogil:
    """Return whether both ends of joints go from left to right."""
    cdef Py_ssize_t i
    for i in range(2, 2 * count):
        if joints[i] < joints[i - 2]:
            return False
    return True


cdef inline void shorten(int32_t *way, const int32_t *other, int32_t aside) noexcept nogil:
    """Shorten ways to other ways that go aside somewhat more, where these are shorter."""
    cdef Py_ssize_t s
    cdef int32_t here
    for s in range(STARTS):
        here = other[s] + aside
        way[s] = here if here < way[s] else way[s]


cdef void ways_up(
    const int32_t *joints,
    Py_ssize_t count,
    const int32_t *below,
    Py_ssize_t below_count,
    const int32_t *below_ways,
    const int32_t *starts,
    int32_t start_count,
    int32_t *ways,
) noexcept nogil:
    """Find how far paths from the bottom to joints go aside."""
    cdef Py_ssize_t i, j, s
    cdef int32_t *way
    for j in range(count):
        way = ways + STARTS * j
        for s in range(STARTS):
            way[s] = FAR if s < start_count else 0
        if below_count == 0:
            for s in range(start_count):
                way[s] = apart(joints + 2 * j, starts[s], starts[s])
    if below_count == 0:
        return
    if ordered(joints, count) and ordered(below, below_count):
        sweep(joints, count, below, below_count, below_ways, ways)
        return
    for j in range(count):
        for i in range(below_count):
            shorten(
                ways + STARTS * j, below_ways + STARTS * i,
                apart(joints + 2 * j, below[2 * i], below[2 * i + 1]),
            )


cdef void sweep(
    const int32_t *joints,
    Py_ssize_t count,
    const int32_t *below,
    Py_ssize_t below_count,
    const int32_t *below_ways,
    int32_t *ways,
) noexcept nogil:
    """Shorten ways to those over joints below, all from left to right.

    The best way to some place over joints that end left of it stays the best further right.
    """
    cdef Py_ssize_t i, j, s
    cdef int32_t best[STARTS]
    for s in range(STARTS):
        best[s] = FAR
    i = 0
    for j in range(count):
        while i < below_count and below[2 * i + 1] <= joints[2 * j]:
            shorten(best, below_ways + STARTS * i, -below[2 * i + 1])
            i += 1
        shorten(ways + STARTS * j, best, joints[2 * j])
        # Right above.
        s = i
        while s < below_count and below[2 * s] < joints[2 * j + 1]:
            shorten(ways + STARTS * j, below_ways + STARTS * s, 0)
            s += 1
    for s in range(STARTS):
        best[s] = FAR
    i = below_count - 1
    for j in range(count - 1, -1, -1):
        while i >= 0 and below[2 * i] >= joints[2 * j + 1]:
            shorten(best, below_ways + STARTS * i, below[2 * i])
            i -= 1
        shorten(ways + STARTS * j, best, -joints[2 * j + 1])


cdef double crossing_percent(
    const int32_t *joints,
    Py_ssize_t count,
    const int32_t *ways,
    const int32_t *starts,
    int32_t start_count,
    int32_t top,
) noexcept nogil:
    """Return F_AV of a wall, in percent, as far as head joints tell."""
    cdef int32_t lengths[STARTS]
    cdef int32_t here
    cdef Py_ssize_t j, s
    for s in range(start_count):
        lengths[s] = ways[s] + apart(joints, starts[s], starts[s])
        for j in range(1, count):
            here = ways[STARTS * j + s] + apart(joints + 2 * j, starts[s], starts[s])
            lengths[s] = here if here < lengths[s] else lengths[s]
    return mean_percent(lengths, start_count, top + 2 * PIXEL_UNITS)


cdef void nearest_bed(
    int32_t left,
    int32_t right,
    int32_t ups,
    const int32_t *starts,
    int32_t start_count,
    int32_t top,
    int32_t *lengths,
) noexcept nogil:
    """Shorten paths to those along a bed joint where it is nearer."""
    cdef Py_ssize_t s
    cdef int32_t y, here
    for s in range(start_count):
        y = top - starts[s]
        here = (y - left if y > left else left - y) + (y - right if y > right else right - y)
        here += <int32_t> ((<int64_t> DIAGONAL * ups) >> 10)
        lengths[s] = here if here < lengths[s] else lengths[s]


cdef double mean_percent(int32_t *lengths, int32_t count, int32_t straight) noexcept nogil:
    """Return the mean of the shortest lengths over what is straight, in percent; 0 for none."""
    cdef int32_t i, j, held, few = min(count, <int32_t> SHORTEST)
    cdef int64_t total = 0
    if count == 0:
        return 0.0
    for i in range(1, count):
        held = lengths[i]
        j = i
        while j > 0 and lengths[j - 1] > held:
            lengths[j] = lengths[j - 1]
            j -= 1
        lengths[j] = held
    for i in range(few):
        total += lengths[i]
    return 100.0 * <double> total / (<double> few * <double> straight)
