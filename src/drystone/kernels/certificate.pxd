from drystone.kernels.memory cimport doubles, ints, new_doubles, release

ctypedef double *p_double


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
