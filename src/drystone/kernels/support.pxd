from drystone.kernels.memory cimport longs, longs_out, p_uchar, pixels, stride


cdef class Pair:
    cdef p_uchar wall, stone
    cdef Py_ssize_t down, across, stone_down, stone_across, rows, columns, height, width


cdef Pair pair_of(object occupied, object mask)
cdef tuple ends_at(Pair pair, Py_ssize_t row, Py_ssize_t col)
cdef bint stands(
    Pair pair, Py_ssize_t i, Py_ssize_t at, Py_ssize_t below, Py_ssize_t col
) noexcept nogil
cdef bint fits(Pair pair, Py_ssize_t row, Py_ssize_t col) noexcept nogil
cdef Py_ssize_t free_height(
    Pair pair, Py_ssize_t row, Py_ssize_t col, Py_ssize_t most
) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) touching_run(
    const long long *gap, Py_ssize_t size, Py_ssize_t smallest, Py_ssize_t largest
) noexcept nogil
