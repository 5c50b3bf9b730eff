"""Numbers of arrays by pointer, and room that grows or goes with a list.

A pointer is valid as long as its array: whoever asks for one keeps the array.
:mod:`drystone.kernels.lists` is what all this is without a compiler.
"""

from cpython.buffer cimport PyBUF_C_CONTIGUOUS, PyBUF_STRIDES, PyBUF_WRITABLE
from libc.stdlib cimport free
from libc.string cimport memmove

ctypedef double *p_double
ctypedef int *p_int
ctypedef long long *p_long
ctypedef unsigned char *p_uchar

cdef void *start(object array, const char *kinds, Py_ssize_t size, int access) except? NULL
cdef void *resized(void *at, Py_ssize_t size) except? NULL nogil
cdef char *kept(list room, Py_ssize_t size)

cdef inline double *doubles(object array) except? NULL:
    return <double *>start(array, b"d", 8, PyBUF_C_CONTIGUOUS)

cdef inline int *ints(object array) except? NULL:
    return <int *>start(array, b"il", 4, PyBUF_C_CONTIGUOUS)

cdef inline long long *longs(object array) except? NULL:
    return <long long *>start(array, b"lq", 8, PyBUF_C_CONTIGUOUS)

cdef inline unsigned char *flags(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_C_CONTIGUOUS)

# Of any view: the numbers are a stride apart.
cdef inline unsigned char *pixels(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_STRIDES)

cdef inline unsigned int *labels_in(object array) except? NULL:
    return <unsigned int *>start(array, b"IL", 4, PyBUF_STRIDES)

cdef inline Py_ssize_t stride(object array, int axis) except? -1:
    return array.strides[axis] // array.itemsize

cdef inline double *doubles_out(object array) except? NULL:
    return <double *>start(array, b"d", 8, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)

cdef inline int *ints_out(object array) except? NULL:
    return <int *>start(array, b"il", 4, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)

cdef inline long long *longs_out(object array) except? NULL:
    return <long long *>start(array, b"lq", 8, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)

cdef inline unsigned char *flags_out(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)

cdef inline double *more_doubles(double *at, Py_ssize_t count) except? NULL nogil:
    return <double *>resized(at, count * sizeof(double))

cdef inline long long *more_longs(long long *at, Py_ssize_t count) except? NULL nogil:
    return <long long *>resized(at, count * sizeof(long long))

cdef inline double *new_doubles(Py_ssize_t count) except? NULL nogil:
    return more_doubles(NULL, count)

cdef inline long long *new_longs(Py_ssize_t count) except? NULL nogil:
    return more_longs(NULL, count)

cdef inline void release(void *at) noexcept nogil:
    free(at)

cdef inline double *kept_doubles(list room, Py_ssize_t count):
    return <double *>kept(room, count * sizeof(double))

cdef inline int *kept_ints(list room, Py_ssize_t count):
    return <int *>kept(room, count * sizeof(int))

cdef inline long long *kept_longs(list room, Py_ssize_t count):
    return <long long *>kept(room, count * sizeof(long long))

cdef inline unsigned char *kept_flags(list room, Py_ssize_t count):
    return <unsigned char *>kept(room, count)

cdef inline void move_ints(
    int *to, Py_ssize_t at, const int *source, Py_ssize_t start, Py_ssize_t count
) noexcept nogil:
    memmove(to + at, source + start, count * sizeof(int))

cdef inline void move_doubles(
    double *to, Py_ssize_t at, const double *source, Py_ssize_t start, Py_ssize_t count
) noexcept nogil:
    memmove(to + at, source + start, count * sizeof(double))
