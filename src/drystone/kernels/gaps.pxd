from drystone.kernels.memory cimport (
    doubles, ints, more_doubles, more_longs, new_doubles, new_longs, p_double, p_int, p_long,
    release
)
from libc.math cimport sqrt


cdef class Body:
    cdef list kept
    cdef p_double corners, edges
    cdef Py_ssize_t first, count
    cdef double left, low, right, high


cdef class Heap(Body):
    cdef Py_ssize_t size
    cdef p_int starts
    cdef p_double boxes
    cdef double width, beyond


cdef class MovingStone(Body):
    cdef p_double gaps, spans, rows, scratch
    cdef p_long near
    cdef Py_ssize_t found, room, near_room
    cdef double x, y


cdef Heap heap_of(object around, double width)
cdef MovingStone stone_of(object corners, object edges)
cdef void measure(Body body) noexcept nogil
cdef int find_gaps(MovingStone stone, Heap heap, double reach, double corner) except -1 nogil
cdef int to_line(
    MovingStone stone, double start, double nx, double ny, double beyond, double reach,
    double other
) except -1 nogil
cdef int crosses(MovingStone stone, Heap heap) except -1 nogil
cdef void select(Heap heap, Py_ssize_t i) noexcept nogil
cdef int keep(
    MovingStone stone, double gap, double nx, double ny, double x, double y, double away,
    double other
) except -1 nogil
cdef int room_for(MovingStone stone, Py_ssize_t count) except -1 nogil
cdef int one_way(
    Body a, Body b, MovingStone out, double reach, double corner, double sign, double other
) except -1 nogil
cdef int at_corner(
    Body a, Body b, Py_ssize_t i, Py_ssize_t e, double reach, double corner, double sign,
    double other, MovingStone out
) except -1 nogil
cdef Py_ssize_t edge_before(Body b, Py_ssize_t e) noexcept nogil
cdef bint face_between(Body a, Body b, Py_ssize_t i, Py_ssize_t e, double *face) noexcept nogil
cdef double along(Body a, Py_ssize_t e, double mx, double my) noexcept nogil
cdef bint contains(Body body, double x, double y) noexcept nogil
cdef int over(MovingStone a, Body b) except -1 nogil
cdef bint cut(
    double *one, Py_ssize_t a, Py_ssize_t b, double *two, Py_ssize_t c, Py_ssize_t d
) noexcept nogil
