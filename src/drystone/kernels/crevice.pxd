from drystone.kernels.memory cimport (
    doubles, doubles_out, ints, kept_doubles, kept_ints, p_double, p_int
)
from libc.math cimport sqrt


cdef class Rows:
    cdef list room
    cdef p_double at
    cdef Py_ssize_t count


cdef class Slabs:
    cdef list room
    cdef object begins
    cdef p_double x, middle, ceiling, best
    cdef p_int which
    cdef Py_ssize_t count


cdef object as_array(Rows chain)
cdef void flip(double *at, Py_ssize_t end) noexcept
cdef void add(Rows out, double x0, double y0, double x1, double y1) noexcept
cdef double line(double *at, Py_ssize_t k, double x) noexcept
cdef tuple boundaries(object stone, object around, double left, double right, double reach)
cdef void put(Rows out, double x0, double y0, double x1, double y1) noexcept
cdef void pick(Rows out, Rows one, Py_ssize_t i) noexcept
cdef Rows raised(Rows chain, double clearance, double left, double right)
cdef object moved(Rows chain, double clearance, Rows out)
cdef void direction(double *at, Py_ssize_t k, double *out) noexcept
cdef void highest(Rows edges, Slabs cuts) noexcept
cdef Rows chained(Rows picked, Slabs cuts)
cdef object slice_up(Slabs cuts, Py_ssize_t count, double left, double right)
