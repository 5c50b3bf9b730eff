"""See `course_paths.pyx`."""

from libc.stdint cimport int32_t

cdef enum:
    STARTS = 10

cdef int32_t path_starts(int32_t side, int32_t *starts) noexcept nogil
cdef void ways_up(
    const int32_t *joints, Py_ssize_t count, const int32_t *below, Py_ssize_t below_count,
    const int32_t *below_ways, const int32_t *starts, int32_t start_count, int32_t *ways
) noexcept nogil
cdef double crossing_percent(
    const int32_t *joints, Py_ssize_t count, const int32_t *ways, const int32_t *starts,
    int32_t start_count, int32_t top
) noexcept nogil
cdef void nearest_bed(
    int32_t left, int32_t right, int32_t ups, const int32_t *starts, int32_t start_count,
    int32_t top, int32_t *lengths
) noexcept nogil
cdef double mean_percent(int32_t *lengths, int32_t count, int32_t straight) noexcept nogil
