"""Gaps between polygons, for other compiled kernels."""

from libc.stdint cimport int32_t

ctypedef struct Body:
    Py_ssize_t count
    const double *corners
    const double *edges
    double box[4]

ctypedef struct Heap:
    Py_ssize_t count
    const double *corners
    const int32_t *first
    const double *boxes
    const double *edges
    double width
    double beyond

ctypedef struct Gap:
    double gap
    double normal[2]
    double point[2]
    double away
    int32_t other

ctypedef struct Gaps:
    Gap *items
    Py_ssize_t count
    Py_ssize_t room
    int32_t *near
    Py_ssize_t near_room
    bint lost

cdef Heap heap_of(
    const double[:, ::1] corners,
    const int32_t[::1] first,
    const double[:, ::1] boxes,
    const double[:, ::1] edges,
    double width,
)
cdef void measure(Body *body) noexcept nogil
cdef void init_gaps(Gaps *gaps) noexcept nogil
cdef void free_gaps(Gaps *gaps) noexcept nogil
cdef Body body_of(const Heap *heap, Py_ssize_t index) noexcept nogil
cdef void find_gaps(
    const Body *body, const Heap *heap, double reach, double corner, Gaps *out
) noexcept nogil
cdef bint crosses(const Body *body, const Heap *heap, Gaps *scratch) noexcept nogil
