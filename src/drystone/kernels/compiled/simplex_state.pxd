"""See `simplex_state.pyx`."""

from libc.stdint cimport int32_t

from drystone.kernels.compiled.simplex_inverse cimport Inverse

cdef enum:
    ALPHA = -1
    ARTIFICIAL = -2
    OPTIMAL = 0
    UNSTABLE = 1
    FAILED = 2
    GOING_ON = -1
    LOST = -2

cdef double INADMISSIBLE

# Columns: their two bodies as the first of three places in a table of velocities, which begins
# with the ground, and six entries, those of all columns in turn.
cdef struct Columns:
    Py_ssize_t count
    const int32_t *first
    const int32_t *second
    const double *entries

# The basis that the wall ended with.
cdef struct Start:
    Py_ssize_t size
    Py_ssize_t alpha_place
    const int32_t *heads
    const double *levels
    const double *rows
    const double *cols
    const double *rates
    const double *ties

cdef struct State:
    Start wall
    Columns old
    Columns new
    Py_ssize_t columns
    Py_ssize_t size
    Py_ssize_t alpha_place
    const int32_t *closed
    Py_ssize_t closed_count
    Inverse inverse
    double speed
    double pivot
    int pivots
    int restarts
    bint renewed
    # One number a row or place.
    double *rhs
    double *live
    double *levels
    double *steps
    double *reference
    double *velocity
    double *fall
    double *row
    double *column
    double *rest
    double *second
    int32_t *heads
    char *fixed
    # Three more than that.
    double *moving
    double *total
    # One number a column.
    double *rates
    double *ties
    double *slopes
    double *opened
    char *open
    # One number a new column.
    int32_t *new_first
    int32_t *new_second
    # One number a row or a column, whichever are more.
    int32_t *listed
    # The tableau of the small program, and what goes with it.
    double *tableau
    double *small_fall
    int32_t *small_heads
    # A new inverse, when the old one has lost its digits.
    double *anew

cdef Py_ssize_t lay_out(State *state, char *memory) noexcept nogil
cdef void reopen(State *state) noexcept nogil
cdef void opening(
    State *state, const double *velocity, double *out, Py_ssize_t first
) noexcept nogil
cdef void slopes_of(State *state, const double *row) noexcept nogil
cdef Py_ssize_t entries_of(
    State *state, Py_ssize_t head, Py_ssize_t *rows, double *entries
) noexcept nogil
cdef void column_of(State *state, Py_ssize_t number, double *out) noexcept nogil
cdef void exchange(
    State *state, Py_ssize_t place, const double *column, Py_ssize_t head
) noexcept nogil
cdef void dual_step(
    State *state, Py_ssize_t place, const double *slopes, Py_ssize_t number, const double *column
) noexcept nogil
cdef void set_steps(State *state) noexcept nogil
cdef bint take_rates(State *state) noexcept nogil
cdef bint take_levels(State *state) noexcept nogil
cdef bint within_bounds(State *state) noexcept nogil
cdef bint admissible(State *state) noexcept nogil
cdef bint falls(State *state) noexcept nogil
cdef bint renewed_inverse(State *state) noexcept nogil
cdef void write_basis(State *state, double *matrix) noexcept nogil
