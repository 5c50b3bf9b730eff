from drystone.kernels.asides cimport Work, aside, work_for
from drystone.kernels.gaps cimport Heap, MovingStone, heap_of, measure, select
from drystone.kernels.memory cimport doubles, kept_doubles
from drystone.kernels.settling cimport Way, let_go, settling_of, way_of

ctypedef double *p_double


cdef class Press:
    cdef list room
    cdef Way block
    cdef MovingStone one
    cdef Heap heap
    cdef Work work
    cdef p_double corners, boxes
    cdef double bottom, top, most, gap


cdef Press press_of(Way way, object around, object lying)
cdef int lie(Press press, dict before, dict now) except -1
cdef void move(Press press, Py_ssize_t i, double shift) noexcept
cdef tuple squeezed_in(Press press, double x, double y)
cdef void stand(Press press, double x, double y, double shift) noexcept
cdef void take(Press press, Py_ssize_t i) noexcept
cdef list neighbours(Press press, double sign)
cdef double deepest(Press press, double sign) except -1.0
cdef double overlap(Press press, Py_ssize_t i, double sign) except -1.0
