"""See `simplex_start.pyx`."""

from drystone.kernels.compiled.simplex_state cimport State

cdef int start(State *state) noexcept nogil
