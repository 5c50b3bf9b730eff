from drystone.kernels.memory cimport flags_out, labels_in, longs_out, pixels, stride

cdef int cut_out(object labels, object cells, Py_ssize_t top, Py_ssize_t left) except -1
cdef tuple paint(
    object mask, long long label, Py_ssize_t top, Py_ssize_t left, object cells, object fresh
)
