"""See `course_scene.pyx`."""

from libc.stdint cimport int32_t, int64_t

from drystone.kernels.compiled.course_paths cimport STARTS

cdef enum:
    COLUMN_BITS = 4
    COLUMN_UNITS = 16
    PARTS = 4
    TERMS = 16

cdef struct Scene:
    const int64_t *first
    const int32_t *bottoms
    const int32_t *tops
    const int64_t *first_row
    const int32_t *lefts
    const int32_t *rights
    const int32_t *width
    const int32_t *middle
    const int32_t *peaks
    const int32_t *part_at
    const int32_t *faces
    const int64_t *area
    const double *weights
    Py_ssize_t stones
    int32_t columns
    int32_t wall_width
    int32_t wall_height
    int32_t reach
    double margin
    int32_t steepest
    int32_t joint
    double target
    const int32_t *beds
    Py_ssize_t bed_count
    int32_t starts[STARTS]
    int32_t start_count
    int32_t *lift

# A stone where it lies.
cdef struct Lain:
    int32_t pose
    int32_t x
    int32_t column
    int32_t y
    int32_t slope
    int32_t rock
    int32_t peaks[PARTS]
    int64_t void
    double short_

# A laid course, and what is there for the next one.
cdef struct Course:
    int32_t *tops
    int32_t *joints
    int32_t *ways
    Lain *lain
    int32_t stones
    int32_t gap
    Py_ssize_t joint_count
    int32_t bed[3]
    double terms[TERMS]
    double sure
    double cost

cdef int fill_scene(Scene *scene, poses, ground, rules, const double[::1] weights) except -1
cdef void free_scene(Scene *scene) noexcept nogil
cdef double weighted(const Scene *scene, const double *terms) noexcept nogil


cdef class Layers:
    cdef Course *courses
    cdef const Course **seen
    cdef Lain *lain
    cdef int32_t[:, ::1] tops
    cdef int32_t[:, :, ::1] joints
    cdef int32_t[:, :, ::1] ways
    cpdef tuple last(self, Py_ssize_t course)
