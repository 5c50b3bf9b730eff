from drystone.kernels.gaps cimport Body, Heap, MovingStone, heap_of, over, select, stone_of
from drystone.kernels.memory cimport kept_doubles
from drystone.kernels.profiles cimport sweep_all

ctypedef double *p_double


cdef class Work:
    cdef p_double corners, bottoms, tops, low, high


cdef Work work_for(list room, Py_ssize_t count)
cdef double aside(MovingStone one, Body other, double sign, Work work) except -2.0
cdef double depth(
    MovingStone one, Body other, Py_ssize_t axis, double start, double end, double sign, Work work
) noexcept nogil
cdef int ends_of(
    Body body, Py_ssize_t axis, double start, double cell, Work work, double *bottoms, double *tops
) noexcept nogil
