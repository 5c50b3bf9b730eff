from drystone.kernels.memory cimport doubles, doubles_out, ints, ints_out, kept_doubles, p_double


cdef class Check:
    cdef p_double forces, velocity, left
    cdef bint loaded
    cdef Py_ssize_t force
    cdef double violation, total, inadmissible


cdef void check_columns(
    Check check, int *first, int *second, double *entries, Py_ssize_t size, Py_ssize_t start,
    Py_ssize_t stop
) noexcept nogil
cdef double larger(double one, double two) noexcept nogil
cdef double moment(double x, double y, double length, double force_x, double force_y) noexcept nogil
