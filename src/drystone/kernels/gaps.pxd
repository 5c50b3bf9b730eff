cdef class Body:
    cdef double *corners
    cdef double *edges
    cdef Py_ssize_t first
    cdef Py_ssize_t count
    cdef double left
    cdef double low
    cdef double right
    cdef double high


cdef class Heap(Body):
    cdef Py_ssize_t size
    cdef int *starts
    cdef double *boxes
    cdef double width
    cdef double beyond


cdef class Stone(Body):
    cdef double *gaps
    cdef int *near
    cdef Py_ssize_t found
    cdef Py_ssize_t room
    cdef Py_ssize_t near_room


cdef Heap heap_of(object around, double width)
cdef Stone stone_of(object corners, object edges)
cdef void measure(Body body) noexcept nogil
cdef int find_gaps(Stone stone, Heap heap, double reach, double corner) except -1 nogil
cdef int crosses(Stone stone, Heap heap) except -1 nogil
