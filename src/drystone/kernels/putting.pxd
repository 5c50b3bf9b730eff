from drystone.kernels.gaps cimport Body, Heap, MovingStone, measure, over, select
from drystone.kernels.memory cimport kept_doubles, move_doubles, p_double
from drystone.kernels.profiles cimport sweep_all
from drystone.kernels.settling cimport State, Way, let_go


cdef class Press:
    cdef list room
    cdef dict pushed  # by how much which others were pushed along x
    cdef Way block
    cdef MovingStone one
    cdef Heap heap
    cdef p_double corners, boxes, turned, bottoms, tops, low, high
    cdef double bottom, top, most, gap


cdef int put_down(Press press, double x, double start_y, list lifts, list last) except -1
cdef bint leans(Way way) noexcept
cdef int go_down(Way way, Heap heap) except -1
cdef Press press_of(Way way, Heap heap, double most, double gap)
cdef int lie(Press press, dict before, dict now) except -1
cdef void move(Press press, Py_ssize_t i, double shift) noexcept
cdef tuple squeezed_in(Press press, double x, double y)
cdef void stand(Press press, double x, double y, double shift) noexcept
cdef void take(Press press, Py_ssize_t i) noexcept
cdef list neighbours(Press press, double sign)
cdef double deepest(Press press, double sign) except -1.0
cdef double overlap(Press press, Py_ssize_t i, double sign) except -1.0
cdef double aside(Press press, double sign) except -2.0
cdef double depth(Press press, Py_ssize_t axis, double start, double end, double sign) noexcept
cdef int ends_of(
    Press press, Body body, Py_ssize_t axis, double start, double cell, double *bottoms,
    double *tops
) noexcept
