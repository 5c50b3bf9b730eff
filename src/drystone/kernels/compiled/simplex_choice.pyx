# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_choice`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t, uint64_t

cdef double INFEASIBLE = 1e-10
cdef double LARGE_PIVOT = 1e-6
cdef double SMALL_PIVOT = 1e-9
cdef double SLACK = 1e-10
cdef double TIE_SLACK = 1e-1


cdef void scattered(uint64_t seed, Py_ssize_t count, double *out) noexcept nogil:
    """Write fixed numbers in [0, 1) without pattern."""
    cdef Py_ssize_t i
    cdef uint64_t bits
    for i in range(count):
        bits = (seed + 1 + <uint64_t>i) * <uint64_t>0x9E3779B97F4A7C15ULL
        bits = (bits ^ (bits >> 30)) * <uint64_t>0xBF58476D1CE4E5B9ULL
        bits = (bits ^ (bits >> 27)) * <uint64_t>0x94D049BB133111EBULL
        bits ^= bits >> 31
        out[i] = <double>(bits >> 11) * (1.0 / 9007199254740992.0)


cdef Py_ssize_t leaving(
    const double *levels, const double *steps, const char *fixed, Py_ssize_t size,
    Py_ssize_t alpha_place
) noexcept nogil:
    """Return the place that stays out of bounds longest as the stone is let down; -1 if none."""
    cdef Py_ssize_t i, place = -1
    cdef double excess, towards, reach, furthest = -1.0
    for i in range(size):
        excess = fabs(levels[i]) if fixed[i] else -levels[i]
        if not excess > INFEASIBLE or i == alpha_place:
            continue
        towards = -steps[i] if fixed[i] and levels[i] > 0.0 else steps[i]
        reach = excess / towards if towards > 1e-14 else 1e30
        if reach > furthest:
            furthest = reach
            place = i
    return place


cdef Py_ssize_t within(
    const double *slopes, double flip, const double *costs, double slack, int32_t *listed,
    Py_ssize_t count
) noexcept nogil:
    """Keep of a list what has the least ratio of costs to slope, with slack; return how many."""
    cdef Py_ssize_t i, first = 0, kept = 0
    cdef double cost, ratio, slope, least = 0.0
    for i in range(count):
        cost = costs[listed[i]]
        cost = cost if cost > 0.0 else 0.0
        ratio = (cost + slack) / (flip * slopes[listed[i]])
        if i == 0 or ratio < least:
            least = ratio
            first = i
    for i in range(count):
        cost = costs[listed[i]]
        cost = cost if cost > 0.0 else 0.0
        slope = flip * slopes[listed[i]]
        if cost <= least * slope or i == first:
            listed[kept] = listed[i]
            kept += 1
    return kept


cdef Py_ssize_t steepest(
    const double *slopes, double flip, const int32_t *listed, Py_ssize_t count
) noexcept nogil:
    cdef Py_ssize_t i, best = 0
    for i in range(1, count):
        if flip * slopes[listed[i]] > flip * slopes[listed[best]]:
            best = i
    return listed[best]


cdef Py_ssize_t entering(
    const double *slopes, double flip, const double *rates, const double *ties, Py_ssize_t count,
    double pivot, int32_t *listed
) noexcept nogil:
    """Return the column with the smallest ratio of rate to slope, then of tie cost; -1 if none."""
    cdef Py_ssize_t j, found = 0
    for j in range(count):
        listed[found] = <int32_t>j
        found += flip * slopes[j] > pivot
    if found == 0:
        return -1
    found = within(slopes, flip, rates, SLACK, listed, found)
    found = within(slopes, flip, ties, TIE_SLACK, listed, found)
    return steepest(slopes, flip, listed, found)


cdef Py_ssize_t blocking(
    const double *column, const double *levels, const double *ties, const char *fixed,
    Py_ssize_t size, Py_ssize_t alpha_place, double pivot, int32_t *listed
) noexcept nogil:
    """Return the place that a growing column empties first; -1 if it can grow for ever."""
    cdef Py_ssize_t i, place = -1, found = 0
    for i in range(size):
        if fixed[i] and fabs(column[i]) > pivot:
            if place < 0 or fabs(column[i]) > fabs(column[place]):
                place = i
    if place >= 0:
        return place
    for i in range(size):
        listed[found] = <int32_t>i
        found += column[i] > pivot and not fixed[i] and i != alpha_place
    if found == 0:
        return -1
    found = within(column, 1.0, levels, SLACK, listed, found)
    found = within(column, 1.0, ties, TIE_SLACK, listed, found)
    return steepest(column, 1.0, listed, found)
