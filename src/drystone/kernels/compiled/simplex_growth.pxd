"""See `simplex_growth.pyx`."""

from libc.stdint cimport int32_t

from drystone.kernels.compiled.simplex_state cimport State

cdef void write_forces(State *state, double unit, double[::1] forces) noexcept nogil
cdef void write_velocity(
    State *state, double unit, bint falls, double[::1] velocity
) noexcept nogil
cdef void write_inverse(State *state, double[:, ::1] rows, double[:, ::1] cols) noexcept nogil
cdef void write_rest(
    State *state, const double[:, ::1] rows, const double[:, ::1] cols, int32_t[::1] heads,
    double[::1] levels, double[::1] rates, double[::1] ties
) noexcept nogil
