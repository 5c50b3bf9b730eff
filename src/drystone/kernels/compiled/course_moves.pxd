"""See `course_moves.pyx`."""

from libc.stdint cimport int32_t, uint64_t

cdef enum:
    NOTHING = -1

cdef struct Draft:
    int32_t *order
    int32_t *turns
    int32_t *sizes
    int32_t *gaps
    int32_t *spare
    int32_t stones
    int32_t courses

cdef int32_t below(uint64_t *state, int32_t count) noexcept nogil
cdef int32_t start_of(const Draft *draft, int32_t course) noexcept nogil
cdef int32_t change(Draft *draft, uint64_t *state, int32_t most) noexcept nogil
