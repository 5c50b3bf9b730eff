# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.certificate`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t
from libc.stdlib cimport calloc, free

cdef struct Checked:
    # Of all columns so far.
    double violation
    double total
    double inadmissible


def figures(
    const int32_t[::1] first,
    const int32_t[::1] second,
    const double[:, ::1] entries,
    const double[::1] weights,
    const int32_t[::1] new_first,
    const int32_t[::1] new_second,
    const double[:, ::1] new_entries,
    const double[::1] new_weights,
    const int32_t[::1] closed,
    double alpha,
    const double[::1] forces,
    const double[::1] velocity,
):
    """Return the seven figures.

    The lock of the interpreter is kept: all of it takes less time than getting that back.
    """
    cdef Py_ssize_t n = weights.shape[0], rows = velocity.shape[0], i, column, stop, gone
    cdef Py_ssize_t force = 0
    cdef double residual = 0.0, largest = 0.0, live = 0.0, rhs = 0.0, weight
    cdef bint loaded = forces.shape[0] > 0
    cdef Checked checked = Checked(0.0, 0.0, 0.0)
    cdef double* left = <double*> calloc(rows + 1, sizeof(double))
    if left == NULL:
        raise MemoryError
    column = 0
    for gone in range(closed.shape[0] + 1):
        stop = closed[gone] if gone < closed.shape[0] else first.shape[0]
        _check(first, second, entries, column, stop, forces, force, velocity, left, &checked)
        force += stop - column
        column = stop + 1
    _check(
        new_first, new_second, new_entries, 0, new_first.shape[0], forces, force, velocity, left,
        &checked,
    )
    for i in range(rows // 3):
        weight = weights[i] if i < n else new_weights[i - n]
        live += weight * velocity[3 * i]
        rhs += weight * velocity[3 * i + 1]
        if loaded:
            residual = _larger(residual, fabs(left[3 * i] + alpha * weight))
            residual = _larger(residual, fabs(left[3 * i + 1] - weight))
            residual = _larger(residual, fabs(left[3 * i + 2]))
    for i in range(rows):
        largest = _larger(largest, fabs(velocity[i]))
    free(left)
    return (
        residual, checked.violation, checked.total, largest, checked.inadmissible, live, rhs
    )


cdef void _check(
    const int32_t[::1] first,
    const int32_t[::1] second,
    const double[:, ::1] entries,
    Py_ssize_t start,
    Py_ssize_t stop,
    const double[::1] forces,
    Py_ssize_t force,
    const double[::1] velocity,
    double* left,
    Checked* checked,
) noexcept nogil:
    """Go through some columns; `force` is the place of the first one's force, if there are any."""
    cdef Py_ssize_t column, one, two
    cdef double x, power
    cdef bint loaded = forces.shape[0] > 0
    for column in range(start, stop):
        one, two = 3 * first[column], 3 * second[column]
        power = (
            entries[0, column] * velocity[one]
            + entries[1, column] * velocity[one + 1]
            + entries[2, column] * velocity[one + 2]
        )
        if two >= 0:
            power = power + (
                entries[3, column] * velocity[two]
                + entries[4, column] * velocity[two + 1]
                + entries[5, column] * velocity[two + 2]
            )
        checked.inadmissible = _larger(checked.inadmissible, -power)
        if not loaded:
            continue
        x = forces[force + column - start]
        if x == 0.0:
            continue
        checked.total += fabs(x)
        checked.violation = _larger(checked.violation, -x)
        left[one] += x * entries[0, column]
        left[one + 1] += x * entries[1, column]
        left[one + 2] += x * entries[2, column]
        if two >= 0:
            left[two] += x * entries[3, column]
            left[two + 1] += x * entries[4, column]
            left[two + 2] += x * entries[5, column]


cdef inline double _larger(double one, double two) noexcept nogil:
    """Return the larger one; what is no number counts as the largest."""
    return two if two > one or two != two else one
