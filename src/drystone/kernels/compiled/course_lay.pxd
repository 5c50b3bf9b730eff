"""See `course_lay.pyx`."""

from libc.stdint cimport int32_t

from drystone.kernels.compiled.course_scene cimport Course, Scene

# Columns from the first to below the last; none when they are equal.
cdef struct Span:
    int32_t first
    int32_t last

cdef void lay(
    const Scene *scene, const Course *below, const Course *old, bint last, Span *changed,
    Course *out
) noexcept nogil
