from drystone.kernels.memory cimport flags, flags_out, ints_out, longs_out

cdef Py_ssize_t put(long long *at, Py_ssize_t count, long long x, long long y) noexcept nogil
