from drystone.kernels.memory cimport longs, longs_out, more_longs, new_longs, release


cdef class Queue:
    cdef long long *entries
    cdef long long *heads
    cdef Py_ssize_t room, used, free


cdef int _search_rows(
    object cells, object rows, object firsts, object steps, object found
) except -1
cdef int _search_row(
    Queue queue, long long *cells, Py_ssize_t row_start, Py_ssize_t row_end, long long first,
    const long long *steps, const long long *detours
) except -1 nogil
cdef int _put(Queue queue, Py_ssize_t cell, long long key) except -1 nogil
