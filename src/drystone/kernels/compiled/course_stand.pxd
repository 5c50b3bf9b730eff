"""See `course_stand.pyx`."""

from libc.stdint cimport int32_t

from drystone.kernels.compiled.course_scene cimport Course, Scene

cdef bint stand(
    const Scene *scene, const int32_t *stones, const int32_t *turns, int32_t count, int32_t gap,
    const Course *old, Course *out
) noexcept nogil
cdef void meet(
    const Scene *scene, const Course *below, const Course *old, Course *out
) noexcept nogil
