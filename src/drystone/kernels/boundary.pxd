from drystone.kernels.memory cimport (
    flags, kept_flags, kept_ints, longs, longs_out, p_int
)


cdef class BoundaryWork:
    cdef list room
    cdef long long *cells
    cdef long long *chains
    cdef unsigned char *fresh
    cdef unsigned char *nodes
    cdef p_int around, steps, edges, corners, path
    cdef int height, width, stride, edge_count, corner_count, chain_count, path_count
    cdef bint all_fresh


cdef object told(BoundaryWork w, object rows)
cdef void mark_nodes(BoundaryWork w) noexcept nogil
cdef bint is_fresh(BoundaryWork w, Py_ssize_t one, Py_ssize_t other) noexcept nogil
cdef void list_edges(BoundaryWork w) noexcept nogil
cdef int put_starts_first(BoundaryWork w) noexcept nogil
cdef bint is_followed(BoundaryWork w, int edge) noexcept nogil
cdef int following(BoundaryWork w, int edge) noexcept nogil
cdef int lowest_of_leftmost(BoundaryWork w, int start) noexcept nogil
cdef void follow_chain(BoundaryWork w, int start) noexcept nogil
