# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_small`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t

from drystone.kernels.compiled.simplex_choice cimport START_SEED, scattered

cdef double ENTERS = -1e-11
cdef double PIVOT = 1e-9
cdef double ARTIFICIAL_PIVOT = 1e-7
cdef double HELD_UP = 1e-9
cdef double LIFT = 1e-6


cdef Py_ssize_t tableau_size(Py_ssize_t rows, Py_ssize_t count) noexcept nogil:
    """Return how many numbers a tableau has."""
    return (rows + 2) * (count + rows + 1)


cdef int solve_small(
    double *tableau, Py_ssize_t rows, Py_ssize_t count, int32_t *heads, double *fall, double *lift
) noexcept nogil:
    """Solve a small linear program by the primal simplex method on a whole tableau.

    The tableau has one line a row, which is columns, room for the artificial forces, and the
    right-hand side; then a line for the artificial forces, and one of costs.  Lines are `count +
    rows + 1` long.  What is to be filled in are columns, right-hand side and costs; the last line
    ends as the reduced costs.  `lift` is scratch for `count` numbers; `fall` may be the same.
    """
    cdef Py_ssize_t i, j, width = count + rows + 1
    cdef double *line
    cdef double *missing = tableau + rows * width
    cdef double flip
    cdef int status
    scattered(START_SEED, count, lift)
    for j in range(width):
        missing[j] = 0.0
    for j in range(count):
        lift[j] = LIFT * (0.5 + lift[j])
    for i in range(rows):
        line = tableau + i * width
        for j in range(count):
            line[width - 1] += lift[j] * line[j]
        flip = -1.0 if line[width - 1] < 0.0 else 1.0
        for j in range(count, width - 1):
            line[j] = 0.0
        for j in range(width):
            line[j] *= flip
        line[count + i] = 1.0
        heads[i] = <int32_t>(count if flip > 0.0 else -1)
    for i in range(rows):
        line = tableau + i * width
        for j in range(count):
            missing[j] -= line[j]
        missing[width - 1] -= line[width - 1]
    for i in range(rows):
        fall[i] = 1.0 if heads[i] >= 0 else -1.0
        heads[i] = <int32_t>count
    for j in range(count, width):
        missing[width + j] = 0.0
    status = improve(tableau, rows, count, heads)
    if status == FOUND and -missing[width - 1] > HELD_UP:
        status = NO_FORCES
    for i in range(rows):
        fall[i] = (missing[count + i] - 1.0) * fall[i]
    return status


cdef int improve(
    double *tableau, Py_ssize_t rows, Py_ssize_t count, int32_t *heads
) noexcept nogil:
    """Pivot until no column improves the artificial forces or, as they are gone, the costs."""
    cdef Py_ssize_t step, row, column, patience = 20 + 10 * rows, width = count + rows + 1
    for step in range(6 * patience):
        column = next_column(tableau + rows * width, width, count, step > patience)
        if column < 0:
            return FOUND
        row = next_row(tableau, rows, count, column, heads)
        if row < 0:
            return NO_BOUND
        pivot_at(tableau, rows + 2, width, row, column)
        heads[row] = <int32_t>column
    return SMALL_LOST


cdef Py_ssize_t next_column(
    const double *missing, Py_ssize_t width, Py_ssize_t count, bint first
) noexcept nogil:
    """Return the column of the steepest descent, or the first one that descends; -1 if none."""
    cdef Py_ssize_t j, best = -1
    cdef const double *costs = missing + width
    for j in range(count):
        if missing[j] < ENTERS and (best < 0 or (not first and missing[j] < missing[best])):
            best = j
    if best >= 0 or -missing[width - 1] > HELD_UP:
        return best
    for j in range(count):
        if missing[j] <= -ENTERS and costs[j] < ENTERS:
            if best < 0 or (not first and costs[j] < costs[best]):
                best = j
    return best


cdef Py_ssize_t next_row(
    const double *tableau, Py_ssize_t rows, Py_ssize_t count, Py_ssize_t column,
    const int32_t *heads
) noexcept nogil:
    """Return the row that is emptied first, the largest pivot among equals; -1 if none is."""
    cdef Py_ssize_t i, best = -1, width = count + rows + 1
    cdef double slope, level, ratio, most = 0.0, least = 0.0
    cdef bint any_falls = False
    for i in range(rows):
        slope = fabs(tableau[i * width + column])
        if heads[i] == count and tableau[i * width + width - 1] <= HELD_UP:
            if slope > ARTIFICIAL_PIVOT and slope > most:
                most = slope
                best = i
    if best >= 0:
        return best
    for i in range(rows):
        slope = tableau[i * width + column]
        if slope > PIVOT:
            level = tableau[i * width + width - 1]
            ratio = ((level if level > 0.0 else 0.0) + 1e-12) / slope
            if not any_falls or ratio < least:
                any_falls = True
                least = ratio
    for i in range(rows):
        slope = tableau[i * width + column]
        if slope > PIVOT:
            level = tableau[i * width + width - 1]
            if not (level if level > 0.0 else 0.0) <= least * slope:
                slope = 0.0
            if best < 0 or slope > most:
                best = i
                most = slope
    return best


cdef void pivot_at(
    double *tableau, Py_ssize_t rows, Py_ssize_t width, Py_ssize_t row, Py_ssize_t column
) noexcept nogil:
    cdef Py_ssize_t i, j
    cdef double factor
    cdef double *line = tableau + row * width
    cdef double *other
    factor = line[column]
    for j in range(width):
        line[j] /= factor
    for i in range(rows):
        other = tableau + i * width
        factor = other[column]
        if i != row and factor != 0.0:
            for j in range(width):
                other[j] -= factor * line[j]
