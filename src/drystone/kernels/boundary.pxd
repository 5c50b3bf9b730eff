from drystone.kernels.memory cimport (
    flags, kept_flags, kept_ints, kept_longs, longs, longs_out, sort_rows
)

ctypedef int *p_int


cdef class Work:
    cdef list room
    cdef long long *cells
    cdef long long *chains
    cdef unsigned char *fresh
    cdef unsigned char *nodes
    cdef p_int around, steps, edges, corners, path
    cdef int height, width, stride, edge_count, corner_count, chain_count, path_count
    cdef bint all_fresh


cdef object told(Work w)
cdef void mark_nodes(Work w) noexcept nogil
cdef bint is_fresh(Work w, Py_ssize_t one, Py_ssize_t other) noexcept nogil
cdef void list_edges(Work w) noexcept nogil
cdef int put_starts_first(Work w) noexcept nogil
cdef bint is_followed(Work w, int edge) noexcept nogil
cdef int following(Work w, int edge) noexcept nogil
cdef int lowest_of_leftmost(Work w, int start) noexcept nogil
cdef void follow_chain(Work w, int start) noexcept nogil
