# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_inverse`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t
from libc.string cimport memset

cdef double SINGULAR = 1e-10


cdef void open_inverse(Inverse *inverse) noexcept nogil:
    """Border the inverse of the wall; places of new rows come first, then that of alpha."""
    cdef Py_ssize_t i
    for i in range(inverse.size):
        inverse.slot[i] = -1
    inverse.count = 0
    for i in range(inverse.new):
        open_slot(inverse, inverse.old + i)
    if inverse.old:
        open_slot(inverse, inverse.alpha_place)


cdef void open_slot(Inverse *inverse, Py_ssize_t place) noexcept nogil:
    """Begin to keep a column of the left factor."""
    cdef double *column = inverse.changed + inverse.count * inverse.size
    memset(column, 0, inverse.size * sizeof(double))
    column[place] = 1.0
    inverse.slot[place] = <int32_t>inverse.count
    inverse.places[inverse.count] = <int32_t>place
    inverse.count += 1


cdef void row_of(Inverse *inverse, Py_ssize_t place, double *out) noexcept nogil:
    """Write a row of the inverse."""
    cdef Py_ssize_t i, t, found = 0
    cdef double factor
    cdef double *factors = inverse.factors
    memset(out, 0, inverse.size * sizeof(double))
    for t in range(inverse.count):
        factors[t] = inverse.changed[t * inverse.size + place]
    for i in range(inverse.new):
        out[inverse.old + i] = factors[i]
    if inverse.old == 0:
        return
    for i in range(0, inverse.new, 3):
        factors[inverse.new] -= inverse.live[i] * factors[i]
    for t in range(inverse.new, inverse.count):
        factor = factors[t]
        if factor != 0.0:
            factors[found] = factor
            inverse.lines[found] = inverse.rows + inverse.places[t] * inverse.old
            found += 1
    if inverse.slot[place] < 0:
        factors[found] = 1.0
        inverse.lines[found] = inverse.rows + place * inverse.old
        found += 1
    add_lines(out, inverse.old, factors, inverse.lines, found)


cdef void apply(Inverse *inverse, double *vector) noexcept nogil:
    """Multiply ``(inverse of the wall, new rows)`` by the left factor, in place."""
    cdef Py_ssize_t i, t, found = 0
    cdef double at
    if inverse.old:
        for i in range(0, inverse.new, 3):
            vector[inverse.old + i] -= inverse.live[i] * vector[inverse.alpha_place]
    for t in range(inverse.count):
        at = vector[inverse.places[t]]
        vector[inverse.places[t]] = 0.0
        if at != 0.0:
            inverse.factors[found] = at
            inverse.lines[found] = inverse.changed + t * inverse.size
            found += 1
    add_lines(vector, inverse.size, inverse.factors, inverse.lines, found)


cdef void times(
    Inverse *inverse, const Py_ssize_t *rows, const double *entries, Py_ssize_t count, double *out
) noexcept nogil:
    """Write the inverse times a column with a few entries."""
    cdef Py_ssize_t i, found = 0
    memset(out, 0, inverse.size * sizeof(double))
    for i in range(count):
        if rows[i] >= inverse.old:
            out[rows[i]] = entries[i]
        elif entries[i] != 0.0:
            inverse.factors[found] = entries[i]
            inverse.lines[found] = inverse.cols + rows[i] * inverse.old
            found += 1
    add_lines(out, inverse.old, inverse.factors, inverse.lines, found)
    apply(inverse, out)


cdef void times_all(Inverse *inverse, const double *rest, double *out) noexcept nogil:
    """Write the inverse times any vector."""
    cdef Py_ssize_t i, found = 0
    memset(out, 0, inverse.size * sizeof(double))
    for i in range(inverse.old):
        if rest[i] != 0.0:
            inverse.factors[found] = rest[i]
            inverse.lines[found] = inverse.cols + i * inverse.old
            found += 1
    add_lines(out, inverse.old, inverse.factors, inverse.lines, found)
    for i in range(inverse.old, inverse.size):
        out[i] = rest[i]
    apply(inverse, out)


cdef void exchange_in(Inverse *inverse, Py_ssize_t place, const double *column) noexcept nogil:
    """Put another column into a place; `column` is the inverse times it."""
    cdef Py_ssize_t i, t
    cdef double factor
    cdef double *kept
    if inverse.slot[place] < 0:
        open_slot(inverse, place)
    for t in range(inverse.count):
        kept = inverse.changed + t * inverse.size
        factor = kept[place] / column[place]
        if factor != 0.0:
            for i in range(inverse.size):
                kept[i] -= factor * column[i]
            kept[place] = factor


cdef void add_lines(
    double *out, Py_ssize_t size, const double *factors, const double **lines, Py_ssize_t count
) noexcept nogil:
    """Add multiples of lines, one after the other; four in one pass save memory traffic."""
    cdef Py_ssize_t i, t = 0
    cdef const double *a
    cdef const double *b
    cdef const double *c
    cdef const double *d
    cdef double f, g, h, k
    while t + 4 <= count:
        a, b, c, d = lines[t], lines[t + 1], lines[t + 2], lines[t + 3]
        f, g, h, k = factors[t], factors[t + 1], factors[t + 2], factors[t + 3]
        for i in range(size):
            out[i] = out[i] + f * a[i] + g * b[i] + h * c[i] + k * d[i]
        t += 4
    while t < count:
        a, f = lines[t], factors[t]
        for i in range(size):
            out[i] += f * a[i]
        t += 1


cdef int inverted(double *matrix, Py_ssize_t size, double *row, int32_t *swaps) noexcept nogil:
    """Invert a square matrix in place, Gauss-Jordan; return 0 when it has no inverse."""
    cdef Py_ssize_t step, place, i, j
    cdef double pivot, factor
    cdef double *line
    for step in range(size):
        place = step
        for i in range(step + 1, size):
            if fabs(matrix[i * size + step]) > fabs(matrix[place * size + step]):
                place = i
        pivot = matrix[place * size + step]
        if not fabs(pivot) > SINGULAR:
            return 0
        swaps[step] = <int32_t>place
        for j in range(size):
            row[j] = matrix[place * size + j]
            matrix[place * size + j] = matrix[step * size + j]
        row[step] = 1.0
        for j in range(size):
            row[j] /= pivot
        for i in range(size):
            line = matrix + i * size
            factor = line[step]
            if i != step and factor != 0.0:
                line[step] = 0.0
                for j in range(size):
                    line[j] -= factor * row[j]
        for j in range(size):
            matrix[step * size + j] = row[j]
    for step in range(size - 1, -1, -1):
        place = swaps[step]
        if place != step:
            for i in range(size):
                line = matrix + i * size
                pivot = line[step]
                line[step] = line[place]
                line[place] = pivot
    return 1
