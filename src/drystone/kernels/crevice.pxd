from drystone.kernels.memory cimport (
    doubles, doubles_out, ints, kept_doubles, kept_ints, sort_doubles
)
from libc.math cimport sqrt

ctypedef double *p_double
ctypedef int *p_int


cdef class Segments:
    cdef list room
    cdef p_double at
    cdef Py_ssize_t count


cdef class Slabs:
    cdef list room
    cdef p_double x, middle, ceiling, best
    cdef p_int which
    cdef Py_ssize_t count


cdef class Corners:
    cdef list room
    cdef p_double at
    cdef Py_ssize_t count


cdef tuple _crevice(object stone, object around, double clearance)
cdef object as_array(Corners chain)
cdef void flip(double *at, Py_ssize_t end) noexcept
cdef bint add(Segments out, double x0, double y0, double x1, double y1) noexcept
cdef double line(double *at, Py_ssize_t k, double x) noexcept
cdef tuple boundaries(object stone, object around, double reach)
cdef void put(Segments out, double x0, double y0, double x1, double y1) noexcept
cdef void pick(Segments out, Segments one, Py_ssize_t i) noexcept
cdef Corners raised(Corners chain, double clearance, double left, double right)
cdef object moved(Corners chain, double clearance, Segments out)
cdef void direction(double *at, Py_ssize_t k, double *out) noexcept
cdef void highest(Segments edges, Slabs cuts) noexcept
cdef Corners chained(Segments picked, Slabs cuts)
cdef void slice_up(Slabs cuts, Py_ssize_t count, double left, double right) noexcept
