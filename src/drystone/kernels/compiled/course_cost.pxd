"""See `course_cost.pyx`."""

from libc.stdint cimport int32_t

from drystone.kernels.compiled.course_scene cimport Course, Scene

cdef double left_out(
    const Scene *scene, const int32_t *stones, Py_ssize_t count, double *terms
) noexcept nogil
cdef void go_up(const Scene *scene, const Course *below, Course *out) noexcept nogil
cdef int32_t top_of(const Scene *scene, const Course *last) noexcept nogil
cdef double across(
    const Scene *scene, const Course *const *courses, Py_ssize_t count, int32_t top
) noexcept nogil
cdef double down(const Scene *scene, const Course *last, int32_t top) noexcept nogil
