# cython: language_level=3
"""Memory of compiled kernels; :mod:`drystone.kernels.lists` is what it is without a compiler.

A pointer is valid as long as its array: whoever asks for one keeps the array.
"""

from cpython.buffer cimport (
    PyBUF_C_CONTIGUOUS,
    PyBUF_FORMAT,
    PyBUF_STRIDES,
    PyBUF_WRITABLE,
    PyBuffer_Release,
    PyObject_GetBuffer,
)
from cpython.bytearray cimport PyByteArray_AS_STRING
from libc.stdlib cimport free, qsort, realloc
from libc.string cimport memmove


cdef void *start(object array, const char *kinds, Py_ssize_t size, int access) except? NULL:
    """Return where the numbers of an array begin; TypeError when they are of another kind."""
    cdef Py_buffer view
    cdef void *at
    cdef Py_ssize_t i = 0
    PyObject_GetBuffer(array, &view, PyBUF_FORMAT | access)
    at = view.buf
    while kinds[i] != 0 and kinds[i] != view.format[0]:
        i += 1
    if kinds[i] == 0 or view.itemsize != size:
        found = (<bytes>view.format).decode()
        PyBuffer_Release(&view)
        raise TypeError(f"a kernel got numbers of kind {found!r}, not {kinds.decode()!r}")
    PyBuffer_Release(&view)
    return at


cdef double *doubles(object array) except? NULL:
    return <double *>start(array, b"d", 8, PyBUF_C_CONTIGUOUS)


cdef int *ints(object array) except? NULL:
    return <int *>start(array, b"il", 4, PyBUF_C_CONTIGUOUS)


cdef long long *longs(object array) except? NULL:
    return <long long *>start(array, b"lq", 8, PyBUF_C_CONTIGUOUS)


cdef unsigned char *flags(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_C_CONTIGUOUS)


cdef unsigned char *pixels(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_STRIDES)


cdef unsigned int *labels_in(object array) except? NULL:
    return <unsigned int *>start(array, b"IL", 4, PyBUF_STRIDES)


cdef Py_ssize_t stride(object array, int axis) except? -1:
    return array.strides[axis] // array.itemsize


cdef double *doubles_out(object array) except? NULL:
    return <double *>start(array, b"d", 8, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)


cdef int *ints_out(object array) except? NULL:
    return <int *>start(array, b"il", 4, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)


cdef long long *longs_out(object array) except? NULL:
    return <long long *>start(array, b"lq", 8, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)


cdef unsigned char *flags_out(object array) except? NULL:
    return <unsigned char *>start(array, b"?B", 1, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE)


cdef double *new_doubles(Py_ssize_t count) except? NULL nogil:
    return <double *>resized(NULL, count * sizeof(double))


cdef int *new_ints(Py_ssize_t count) except? NULL nogil:
    return <int *>resized(NULL, count * sizeof(int))


cdef long long *new_longs(Py_ssize_t count) except? NULL nogil:
    return <long long *>resized(NULL, count * sizeof(long long))


cdef double *more_doubles(double *at, Py_ssize_t count) except? NULL nogil:
    return <double *>resized(at, count * sizeof(double))


cdef int *more_ints(int *at, Py_ssize_t count) except? NULL nogil:
    return <int *>resized(at, count * sizeof(int))


cdef long long *more_longs(long long *at, Py_ssize_t count) except? NULL nogil:
    return <long long *>resized(at, count * sizeof(long long))


cdef void *resized(void *at, Py_ssize_t size) except? NULL nogil:
    cdef void *more = realloc(at, size)
    if more == NULL:
        with gil:
            raise MemoryError
    return more


cdef double *kept_doubles(list room, Py_ssize_t count):
    return <double *>kept(room, count * sizeof(double))


cdef int *kept_ints(list room, Py_ssize_t count):
    return <int *>kept(room, count * sizeof(int))


cdef long long *kept_longs(list room, Py_ssize_t count):
    return <long long *>kept(room, count * sizeof(long long))


cdef unsigned char *kept_flags(list room, Py_ssize_t count):
    return <unsigned char *>kept(room, count)


cdef char *kept(list room, Py_ssize_t size):
    zeros = bytearray(size)
    room.append(zeros)
    return PyByteArray_AS_STRING(zeros)


cdef void move_ints(
    int *to, Py_ssize_t at, const int *source, Py_ssize_t start, Py_ssize_t count
) noexcept nogil:
    memmove(to + at, source + start, count * sizeof(int))


cdef void sort_doubles(double *at, Py_ssize_t count) noexcept nogil:
    qsort(at, count, sizeof(double), compared)


cdef int compared(const void *one, const void *two) noexcept nogil:
    cdef double a = (<const double *>one)[0], b = (<const double *>two)[0]
    return (a > b) - (a < b)


cdef void sort_rows(long long *at, Py_ssize_t count) noexcept nogil:
    """Sort rows of six numbers by the first one, then by the next one, ..."""
    qsort(at, count, 6 * sizeof(long long), compared_rows)


cdef int compared_rows(const void *one, const void *two) noexcept nogil:
    cdef const long long *a = <const long long *>one
    cdef const long long *b = <const long long *>two
    cdef int i
    for i in range(6):
        if a[i] != b[i]:
            return 1 if a[i] > b[i] else -1
    return 0


cdef void release(void *at) noexcept nogil:
    free(at)
