from drystone.kernels.memory cimport doubles_out, kept_ints, longs, longs_out
from libc.math cimport sqrt

cdef int split_chain(
    const long long *nodes, int begin, int end, int chain, int *runs, int count, int *pieces,
    int *is_cut
) noexcept nogil
cdef int corner_between(const long long *nodes, int first, int last) noexcept nogil
cdef long long integer_root(long long square) noexcept nogil
cdef bint is_hook(const long long *nodes, int end, int inwards) noexcept nogil
cdef void write_normal(
    const long long *nodes, int first, int last, double *normals, Py_ssize_t at
) noexcept nogil
cdef void write_normal_at_point(
    const long long *cells, Py_ssize_t height, Py_ssize_t width, const long long *corners,
    Py_ssize_t corner, double *normals, Py_ssize_t at
) noexcept nogil
