"""See `simplex_inverse.pyx`."""

from libc.stdint cimport int32_t

cdef struct Inverse:
    # Of the wall.
    const double *rows
    const double *cols
    const double *levels
    Py_ssize_t old
    Py_ssize_t alpha_place
    # The new bodies.
    const double *live
    Py_ssize_t new
    Py_ssize_t size
    # Columns of the left factor: `changed[t * size : ...]` is that of `places[t]`.
    Py_ssize_t count
    int32_t *places
    int32_t *slot
    double *changed
    # Scratch, as long as a column of the basis.
    double *factors
    const double **lines

cdef void open_inverse(Inverse *inverse) noexcept nogil
cdef void row_of(Inverse *inverse, Py_ssize_t place, double *out) noexcept nogil
cdef void apply(Inverse *inverse, double *vector) noexcept nogil
cdef void times(
    Inverse *inverse, const Py_ssize_t *rows, const double *entries, Py_ssize_t count, double *out
) noexcept nogil
cdef void times_all(Inverse *inverse, const double *rest, double *out) noexcept nogil
cdef void exchange_in(Inverse *inverse, Py_ssize_t place, const double *column) noexcept nogil
cdef int inverted(double *matrix, Py_ssize_t size, double *row, int32_t *swaps) noexcept nogil
cdef void add_lines(
    double *out, Py_ssize_t size, const double *factors, const double **lines, Py_ssize_t count
) noexcept nogil
