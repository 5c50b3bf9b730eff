"""Memory of compiled kernels: numbers of arrays by pointer, and rows that grow."""

cdef double *doubles(object array) except? NULL
cdef int *ints(object array) except? NULL
cdef long long *longs(object array) except? NULL
cdef unsigned char *flags(object array) except? NULL

# Of any view: the numbers are a stride apart.
cdef unsigned char *pixels(object array) except? NULL
cdef unsigned int *labels_in(object array) except? NULL
cdef Py_ssize_t stride(object array, int axis) except? -1

cdef double *doubles_out(object array) except? NULL
cdef int *ints_out(object array) except? NULL
cdef long long *longs_out(object array) except? NULL
cdef unsigned char *flags_out(object array) except? NULL

cdef double *new_doubles(Py_ssize_t count) except? NULL nogil
cdef int *new_ints(Py_ssize_t count) except? NULL nogil
cdef long long *new_longs(Py_ssize_t count) except? NULL nogil
cdef double *more_doubles(double *at, Py_ssize_t count) except? NULL nogil
cdef int *more_ints(int *at, Py_ssize_t count) except? NULL nogil
cdef long long *more_longs(long long *at, Py_ssize_t count) except? NULL nogil
cdef double *kept_doubles(list room, Py_ssize_t count)
cdef int *kept_ints(list room, Py_ssize_t count)
cdef long long *kept_longs(list room, Py_ssize_t count)
cdef unsigned char *kept_flags(list room, Py_ssize_t count)
cdef void move_ints(
    int *to, Py_ssize_t at, const int *source, Py_ssize_t start, Py_ssize_t count
) noexcept nogil
cdef void sort_doubles(double *at, Py_ssize_t count) noexcept nogil
cdef void sort_rows(long long *at, Py_ssize_t count) noexcept nogil
cdef void release(void *at) noexcept nogil
