# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Twin of :mod:`drystone.kernels.simplex_growth`."""

from libc.math cimport fabs
from libc.stdint cimport int32_t
from libc.stdlib cimport free, malloc
from libc.string cimport memcpy, memset

from drystone.kernels.compiled.simplex_choice cimport scattered
from drystone.kernels.compiled.simplex_inverse cimport inverted, row_of
from drystone.kernels.compiled.simplex_state cimport (
    ALPHA, State, entries_of, opening, write_basis,
)

cdef double ERROR = 1e-11


cdef void write_forces(State *state, double unit, double[::1] forces) noexcept nogil:
    """Write what the open columns carry."""
    cdef Py_ssize_t i, j, kept = 0
    memset(state.slopes, 0, state.columns * sizeof(double))
    for i in range(state.size):
        if state.heads[i] >= 0:
            state.slopes[state.heads[i]] = state.levels[i] * unit
    for j in range(state.columns):
        if state.open[j]:
            forces[kept] = state.slopes[j]
            kept += 1


cdef void write_velocity(
    State *state, double unit, bint falls, double[::1] velocity
) noexcept nogil:
    """Write the mechanism, or the fall."""
    cdef Py_ssize_t i
    for i in range(state.size):
        velocity[i] = state.fall[i] if falls else state.velocity[i] / unit


cdef void write_inverse(State *state, double[:, ::1] rows, double[:, ::1] cols) noexcept nogil:
    """Write the inverse and its transpose."""
    cdef Py_ssize_t i, j, size = state.size
    cdef double *matrix
    for i in range(size):
        row_of(&state.inverse, i, &rows[i, 0])
    transpose(rows, cols)
    if error_of(state, cols) <= ERROR:
        return
    matrix = <double *>malloc(size * size * sizeof(double))
    if matrix == NULL:
        return
    write_basis(state, matrix)
    if inverted(matrix, size, state.column, state.listed):
        memcpy(&rows[0, 0], matrix, size * size * sizeof(double))
        transpose(rows, cols)
    free(matrix)


cdef void transpose(const double[:, ::1] rows, double[:, ::1] cols) noexcept nogil:
    """Copy a square matrix, transposed, in tiles that fit into the cache."""
    cdef Py_ssize_t i, j, top, left, size = rows.shape[0]
    for top in range(0, size, 16):
        for left in range(0, size, 16):
            for i in range(top, min(top + 16, size)):
                for j in range(left, min(left + 16, size)):
                    cols[j, i] = rows[i, j]


cdef double error_of(State *state, const double[:, ::1] cols) noexcept nogil:
    """Return how far the inverse times the basis is from 1."""
    cdef Py_ssize_t[6] rows
    cdef double[6] entries
    cdef Py_ssize_t i, place, count, size = state.size
    cdef double *product = state.column
    cdef double largest = 0.0
    for place in range(size):
        memset(product, 0, size * sizeof(double))
        if state.heads[place] == ALPHA:
            for i in range(0, size, 3):
                add_line(product, size, state.live[i], &cols[i, 0])
        else:
            count = entries_of(state, state.heads[place], rows, entries)
            for i in range(count):
                add_line(product, size, entries[i], &cols[rows[i], 0])
        product[place] -= 1.0
        for i in range(size):
            largest = max(largest, fabs(product[i]))
    return largest


cdef void add_line(
    double *out, Py_ssize_t size, double factor, const double *line
) noexcept nogil:
    cdef Py_ssize_t i
    for i in range(size):
        out[i] += factor * line[i]


cdef void write_rest(
    State *state, const double[:, ::1] rows, const double[:, ::1] cols, int32_t[::1] heads,
    double[::1] levels, double[::1] rates, double[::1] ties
) noexcept nogil:
    """Write what is basic, its levels, the rates, and second costs that begin anew."""
    cdef Py_ssize_t i, j, size = state.size, kept = 0
    opening(state, &rows[state.alpha_place, 0], state.slopes, 0)
    for i in range(size):
        if state.heads[i] >= 0:
            state.slopes[state.heads[i]] = 0.0
        levels[i] = 0.0
    for i in range(size):
        if state.rhs[i] != 0.0:
            for j in range(size):
                levels[j] += state.rhs[i] * cols[i, j]
    scattered(0, ties.shape[0], &ties[0])
    for j in range(state.columns):
        if state.open[j]:
            rates[kept] = max(state.slopes[j], 0.0)
            ties[kept] = 1.0 + ties[kept]
            state.rates[j] = <double>kept
            kept += 1
    for i in range(size):
        heads[i] = state.heads[i]
        if state.heads[i] >= 0:
            heads[i] = <int32_t>state.rates[state.heads[i]]
            ties[heads[i]] = 0.0
